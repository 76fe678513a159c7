/* SPDX-License-Identifier: MIT */
/* normals.h: in which space the normals of a frame are. */
#ifndef CREVICE_IO_PASSES_NORMALS_H
#define CREVICE_IO_PASSES_NORMALS_H

#include "passes.h"

/*
 * Settles has_normals, normal_space and the camera's rotation of a frame that has its
 * depth, camera and normals. has_rotation: the camera's world_to_view came with the file.
 * Normals stored in [0, 1] or with a mirrored axis are put right in the frame's own copy.
 * Never fails: normals that make no sense are dropped with a warning.
 */
void io__settle_normals(const char *path, io_normal_space space, bool has_rotation,
                        io_frame *frame, const crv_logger *log);

#endif
