/* SPDX-License-Identifier: MIT */
/* depth.h: a file's depth to planar depth. */
#ifndef CREVICE_IO_PASSES_DEPTH_H
#define CREVICE_IO_PASSES_DEPTH_H

#include "passes.h"

/*
 * Converts the depth of all layers in the frame's own pixels from `format` to planar
 * depth, background INFINITY. The frame's camera and depth views must be set. Returns 0,
 * or -1 after an error line.
 */
int io__convert_depth(const crv_depth_format *format, io_frame *frame,
                      const crv_logger *log);

#endif
