/* SPDX-License-Identifier: MIT */
/* exr_copy.h: what a copy of an EXR file will hold; append.c decides it. */
#ifndef CREVICE_IO_EXR_COPY_H
#define CREVICE_IO_EXR_COPY_H

#include "exr.h"

/* A picture in the coordinates of the file: (x, y) is its first pixel. */
typedef struct io__exr_layer {
    const io_image *picture;
    int64_t x, y;
} io__exr_layer;

/* A channel of a part that is written anew. */
typedef struct io__exr_plane {
    const char *name;
    exr_pixel_type_t type;
    exr_perceptual_treatment_t treatment;
    int32_t x_sampling, y_sampling;
    int32_t source; /* channel of the input's part; -1: the picture itself */
    const io__exr_layer
        *layer;      /* the picture, or what multiplies the source; NULL: none */
    int32_t channel; /* of the picture; -1: the mean of its three */
    float outside;   /* stands for pixels that the picture does not cover */
    float tint;
} io__exr_plane;

/* A part of the copy. */
typedef struct io__exr_copy_part {
    int source;                    /* part of the input; -1: a new one, of one plane */
    const char *name;              /* of a new part */
    int beside;                    /* part of the input that a new one resembles */
    bool is_changed;               /* written anew; otherwise copied as it is packed */
    exr_compression_t compression; /* of a changed part */
    int32_t plane_count;
    io__exr_plane *planes; /* of a changed part, sorted by name; owned */
} io__exr_copy_part;

/* A string attribute. */
typedef struct io__exr_note {
    int part; /* of the copy */
    const char *name, *text;
} io__exr_note;

typedef struct io__exr_copy {
    io__exr in;
    int part_count;
    io__exr_copy_part *parts; /* owned */
    int32_t note_count;
    io__exr_note *notes; /* owned */
} io__exr_copy;

/* Writes the copy. Returns 0, or -1 after an error line. */
int io__exr_copy_write(io__exr_copy *copy, io__output *output);

/* Writes the pixels of a changed part. */
exr_result_t io__exr_merge_part(io__exr_copy *copy, int part, const io__exr_sink *sink);

/* Whether a compression gives back the bits that it was given. */
bool io__exr_is_lossless(exr_compression_t compression);

#endif
