/* SPDX-License-Identifier: MIT */
/* readings.h: the spaces that given normals may be in, judged by those that depth
 * implies. */
#ifndef CREVICE_IO_PASSES_READINGS_H
#define CREVICE_IO_PASSES_READINGS_H

#include "pairs.h"

/* Which readings are tried: numbers of io_frame.reading. */
enum {
    IO__READ_METADATA = 1, /* world space, turned by the file's camera */
    IO__READ_VIEW = 2,
    IO__READ_VIEW_FLIPPED = 3, /* to 9: view space, axes negated */
    IO__READ_AXES = 10,    /* to 57: world space by metadata, axes swapped or negated */
    IO__READ_FITTED = 60,  /* world space, rotation found from depth */
    IO__READ_MIRRORED = 61 /* the same after z is negated */
};

typedef struct io__reading {
    int id;           /* 0: none */
    char text[96];    /* "view space, y flipped" */
    double turn[9];   /* view = turn * given; orthogonal, a reflection perhaps */
    double deviation; /* degrees: mean over the pairs, each angle clamped at 30 */
    double contrary;  /* share of the pairs that differ by more than 20 degrees */
    bool decided;     /* no other reading that differs is about as good */
} io__reading;

typedef struct io__reading_request {
    bool try_view, try_world;
    const double *to_view; /* the file's camera, 9 numbers; NULL if it does not say */
    int usual;             /* the shot's reading, which decides if this frame cannot; 0 */
} io__reading_request;

/* The likeliest of the readings that fit about as well as the best. id is 0 if there is
 * no pair, or nothing to try. */
io__reading io__choose_reading(const io__pair_list *pairs,
                               const io__reading_request *request);

#endif
