/* SPDX-License-Identifier: MIT */
/*
 * explain.h: what lies around a pixel within the radius, for the picture to show: where
 * the horizon is in each direction. Every texel on the way is looked at; which of them
 * methods take is in samples.h.
 */
#ifndef VIEW_EXPLAIN_H
#define VIEW_EXPLAIN_H

#include "buffers.h"

enum { EXPLAIN_DIRECTIONS = 32 };

typedef struct explain_horizon {
    bool found;      /* something rises over the surface */
    int32_t x, y;    /* the texel, from the pixel (0, 0) inside the guard band */
    double sine;     /* of its elevation over the surface */
    double distance; /* from the pixel's point, scene units */
} explain_horizon;

typedef struct explanation {
    int32_t x, y;                                /* the pixel */
    double radius_px;                            /* the radius at the pixel's depth */
    explain_horizon horizon[EXPLAIN_DIRECTIONS]; /* counterclockwise from the right */
} explanation;

/* False if the pixel shows no surface. */
bool explain_pixel(const buffers *b, int32_t x, int32_t y, double radius,
                   explanation *out);

#endif
