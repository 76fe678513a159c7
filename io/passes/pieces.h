/* SPDX-License-Identifier: MIT */
/* pieces.h: the pieces of a channel's name, and what they say. */
#ifndef CREVICE_IO_PASSES_PIECES_H
#define CREVICE_IO_PASSES_PIECES_H

#include "conventions.h"
#include "io.h"

/* A channel's name in its pieces; lengths in bytes. */
typedef struct io__pieces {
    const char *layer; /* the last piece but component and view */
    size_t prefix;     /* length of what stands before the layer, its dot included */
    size_t layer_length;
    const char *view; /* "left" of a stereo frame, not terminated */
    size_t view_length;
    const char *component; /* "" for a name without dots */
} io__pieces;

/* Ranks: lower is better. Names of the table come first, then names that look like it. */
enum {
    IO__LOOKS_LIKE = 1 << 16,
    IO__ANY_Z = 1 << 18,
    IO__FOR_DENOISER, /* sees through mirrors */
    IO__ONLY_CHANNEL,
    IO__NO_MATCH = 1 << 20
};

/* The component is the last piece, or empty if the layer is itself a channel. */
io__pieces io__split_channel(const char *name, bool with_component);
/* A layer's name from `name` to `end`, without its component. */
io__pieces io__split_layer(const char *name, const char *end);

bool io__same_text(const char *a, size_t length, const char *b);
bool io__contains(const char *text, size_t length, const char *word);

/* The rank of a layer in the rows of its kind, or -1. */
int io__row_of(const io__pieces *s, io_pass_kind kind);

/* The channel of that name in any case, or NULL. */
const char *io__find_name(const io_image *image, const char *name);

/* Finds BASE.X .Y .Z, BASE.R .G .B, or BASEX BASEY BASEZ. */
bool io__find_components(const io_image *probed, const char *base, size_t length,
                         const char *found[3]);

/* The length of a vector layer's name if `name` is its X (or R) component, else 0. */
size_t io__vector_base_length(const char *name);

#endif
