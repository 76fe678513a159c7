/* SPDX-License-Identifier: MIT */
/* shrink.h: results of frames that were rendered larger. */
#ifndef TOOL_SHRINK_H
#define TOOL_SHRINK_H

#include "common/report.h"
#include "passes/passes.h"

/* Whether the frame can be shrunk to 1/n: its display window must be a multiple of n.
 * Returns an exit code. */
int shrink_check(const io_frame *frame, int32_t n, const char *path, report *r);

/* Shrinks the result of a frame, whose windows are set, to 1/n: each pixel is the mean of
 * those of its n x n that show a surface, 1 if none does, and of bent normals no
 * direction. Returns an exit code. */
int shrink(const io_frame *frame, int32_t n, io_image *ao, report *r);

#endif
