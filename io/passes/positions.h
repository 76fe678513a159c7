/* SPDX-License-Identifier: MIT */
/* positions.h: a pass of positions stands for depth, and tells the camera. */
#ifndef CREVICE_IO_PASSES_POSITIONS_H
#define CREVICE_IO_PASSES_POSITIONS_H

#include "camera.h"

/*
 * Turns positions, in world or camera space, into planar depth. They are the first three
 * channels of the frame's image; depth replaces the first. known: the cameras that the
 * caller or the file tell, `count` of them, 0 if they tell none. Returns 0 with the
 * camera that the positions agree with, or -1 after an error line.
 */
int io__settle_positions(const char *path, const io_passes_request *request,
                         io_frame *frame, const io__camera_guess *known, int count,
                         io__camera_guess *out, const crv_logger *log);

#endif
