/* SPDX-License-Identifier: MIT */
/* mixed.h: pixels that a filter mixed from two surfaces. */
#ifndef CREVICE_IO_PASSES_MIXED_H
#define CREVICE_IO_PASSES_MIXED_H

#include "passes.h"

/*
 * Gives pixels of layer 0 that lie between two surfaces, as antialiasing leaves them at
 * silhouettes, to one of the two: its depth and its normal, so that they neither occlude
 * nor get a normal of nothing. The frame's depth is planar. Normals that are averages are
 * replaced at creases, too. Returns how many pixels changed, or -1 if memory is missing.
 */
int64_t io__settle_mixed(io_frame *frame);

#endif
