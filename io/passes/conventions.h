/* SPDX-License-Identifier: MIT */
/* conventions.h: how renderers name and write their passes, one row each. */
#ifndef CREVICE_IO_PASSES_CONVENTIONS_H
#define CREVICE_IO_PASSES_CONVENTIONS_H

#include <stdbool.h>
#include <stddef.h>

typedef enum io_pass_kind {
    IO_PASS_DEPTH,
    IO_PASS_NORMAL,
    IO_PASS_POSITION,
    IO_PASS_AO,
    IO_PASS_BENT_NORMAL,
    IO_PASS_BEAUTY /* the picture itself: linear red, green, blue */
} io_pass_kind;

/* A text that is NULL is not fixed by the renderer: the frame's numbers tell. */
typedef struct io_convention {
    io_pass_kind kind;
    const char *renderer;
    const char *name;       /* of the layer, as in NAME.Z, PREFIX.NAME.R or NAMEX */
    const char *encoding;   /* what the numbers mean */
    const char *unit;       /* of depth */
    const char *background; /* what stands where nothing is seen */
    const char *axes;       /* space and handedness of vectors */
} io_convention;

/* All rows, names of one kind in order of preference. */
extern const io_convention io_conventions[];
extern const size_t io_convention_count;

#endif
