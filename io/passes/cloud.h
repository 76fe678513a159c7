/* SPDX-License-Identifier: MIT */
/* cloud.h: positions of a frame, and the pixels that see them. */
#ifndef CREVICE_IO_PASSES_CLOUD_H
#define CREVICE_IO_PASSES_CLOUD_H

#include "io.h"

/* No renderer puts a surface that far away. */
#define IO__NOWHERE 1e10f

typedef struct io__cloud {
    double (*position)[3]; /* owned */
    double (*pixel)[2];    /* owned */
    size_t count;
} io__cloud;

/* The i-th pixel's position: the first three channels. */
void io__load_position(const io_image *image, size_t i, float p[3]);

/* Whether it is one: renderers write 0, 0, 0 where there is nothing. */
bool io__is_position(const float p[3]);
bool io__is_position_at(const io_image *image, int32_t x, int32_t y);

/* Positions at every `step`-th pixel that has neighbours. Returns 0, or -1 if memory is
 * missing; both arrays must be freed in either case. */
int io__collect_positions(const io_image *image, int32_t step, io__cloud *out);

#endif
