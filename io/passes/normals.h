/* SPDX-License-Identifier: MIT */
/* normals.h: what is done to given normals. */
#ifndef CREVICE_IO_PASSES_NORMALS_H
#define CREVICE_IO_PASSES_NORMALS_H

#include "passes.h"
#include "readings.h"

/* Puts normals that are stored in [0, 1] right in the frame's own copy, and flips the
 * axes that the caller says. */
void io__decode_normals(const char *path, const io_passes_request *request,
                        io_frame *frame, const crv_logger *log);

/* Takes the normals in that reading: sets has_normals, normal_space and the camera's
 * rotation, and mirrors the frame's copy if the reading is no rotation. */
void io__apply_reading(const io__reading *reading, io_frame *frame);

/* Whether an orthogonal matrix is no reflection. */
bool io__is_rotation(const double m[9]);

#endif
