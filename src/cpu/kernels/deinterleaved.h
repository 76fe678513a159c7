/* SPDX-License-Identifier: MIT */
/*
 * The deinterleaved structure: what its kernels share with the backend.
 *
 * Pixels are deinterleaved by the 4x4 phases of the noise tile. All pixels of a phase
 * share rotation and jitter, so once their projected radius is quantised, to buckets of a
 * small part of an octave, they share every sample's offset as well: offsets are scalars
 * that stand in a table for each bucket and phase, and reading 16 samples is one load.
 *
 * Depth is stored by phases, too: 16 planes, the one of phase (px, py) holding the rows
 * py, py + 4, ... and of these the columns px, px + 4, ... A group is 16 pixels of one
 * phase in one row, that is, of 64 columns. Columns count from a multiple of 64 of the
 * whole picture's, so that a crop is deinterleaved as the picture is.
 *
 * Distant samples are at multiples of 4 pixels in x and y, so that a pixel finds them in
 * its own phase's plane: a tile whose pixels are computed phase after phase reads a
 * sixteenth of its surroundings at a time, which stays in the cache however large the
 * radius is.
 */
#ifndef CRV_CPU_KERNELS_DEINTERLEAVED_H
#define CRV_CPU_KERNELS_DEINTERLEAVED_H

#include "core/frame.h"

#include <stdbool.h>

enum {
    CRV__PHASES = 4, /* along each axis */
    CRV__GROUP_PIXELS = 16,
    CRV__GROUP_SPAN = CRV__PHASES * CRV__GROUP_PIXELS, /* columns of a group */
    CRV__ROW_PADDING = 16,      /* floats of background at each end of a row */
    CRV__SHIFT_OFF = INT16_MAX, /* a sample's shift: it is off every picture */
    CRV__MOST_SAMPLES = 1024,   /* in a list */
    CRV__TILE_GROUPS = 4,       /* that a kernel computes at once, and rows of each */
    CRV__TILE_ROWS = 16
};

/* The direction to a sample, o = (x, y) the step on the image plane at unit depth
 * (perspective) or in scene units (orthographic). */
typedef struct crv__sample {
    float x2, y2;         /* 2 o */
    float squared;        /* o.o */
    float minus_squared2; /* -2 o.o */
    union {
        struct {
            float cosine, sine;   /* o / |o|; 0 where o is 0 */
            float cosine2, sine2; /* of twice the angle */
        };
        struct {
            /* jittered: the body's front and the end of the sample's cell, over the
             * sample's distance */
            float front, far;
        };
    };
} crv__sample;

/* Where a sample and the one opposite to it are, from a pixel on. */
typedef struct crv__sample_place {
    int32_t offset[2]; /* floats from the pixel's place in its plane */
    int16_t shift[2];  /* of which along the row */
    int16_t dv;        /* rows down; the opposite one as many up */
    union {
        int16_t index; /* of the point in its pattern */
        int16_t du;    /* jittered: columns to the right */
    };
} crv__sample_place;

/* Over all samples of a list, opposite ones included. */
typedef struct crv__list_footprint {
    int16_t shift_min, shift_max, rows, unused;
    float radius; /* projected, vertically, that the samples are spread over; pixels */
} crv__list_footprint;

/* What stands for no surface is finite, or it would spread as NaN, but farther from every
 * surface with a bucket than the radius: 1024 times the depth at which the radius is a
 * pixel; 1e18 where the camera is orthographic. Surfaces from there on count as
 * background: their radius is a thousandth of a pixel, or of the rounding of their depth.
 */
typedef struct crv__deinterleaved {
    /* depth by phases: layer, a row of background, plane, row; behind the layers the
     * method's map likewise */
    float *depth;
    ptrdiff_t layer_pitch; /* floats */
    int32_t plane, pitch;  /* floats of a plane; of a row in it */
    int32_t rows, columns; /* of a plane; of the latter those that hold pixels */
    int32_t left, top;     /* column and row of the buffers' first pixel */
    float background;      /* what stands for no surface: finite */

    /* a list of samples for each bucket and phase: `slices` times at most `steps` */
    int32_t buckets, slices, steps;
    int32_t shift; /* of a radius' bits to its bucket */
    float cap;     /* of the radius, vertically, pixels */
    float largest; /* projected radius that has a bucket in every phase, pixels */
    bool extends;  /* samples off the picture are not all background */
    float *border; /* what they are found from: crv__border_row(), crv__border_column() */
    int32_t paired; /* 0 or 1: every slice has one opposite to it */
    crv__sample *samples;
    crv__sample_place *places;
    uint16_t *counts; /* samples in each slice */
    crv__list_footprint *footprints;
    float scale[CRV__PHASES * CRV__PHASES]; /* of a phase's radius */
} crv__deinterleaved;

/* The bucket of a projected radius in pixels (vertically, times the phase's scale) is its
 * float's exponent and upper bits of the mantissa, from this radius on. */
#define CRV__SMALLEST_RADIUS_PX 0.5f
enum { CRV__SMALLEST_RADIUS_BITS = 0x3f000000, CRV__MANTISSA_BITS = 23 };

/* Groups `first` to last - 1 of a row, in rows y0, y0 + 4, ... below y1, so of the same
 * phases; at most CRV__TILE_GROUPS and CRV__TILE_ROWS. */
typedef struct crv__group_tile {
    int32_t first, last, y0, y1;
} crv__group_tile;

/* What a crv__estimate_kernel or crv__bent_kernel computes, of a tile, all four phases of
 * x; nothing is written beside `out`. Returns whether some pixel's radius is beyond the
 * table: the values of such pixels are undefined. */
typedef int (*crv__deinterleaved_kernel)(const crv__frame *frame,
                                         const crv__deinterleaved *di,
                                         const crv__group_tile *tile,
                                         const crv__picture *out);

/* Fills what di->depth holds of row y from all layers. */
typedef void (*crv__deinterleave_kernel)(const crv__frame *frame,
                                         const crv__deinterleaved *di, int32_t y);

/* Floats from a layer's first on to column m of a picture's row y, which belongs to a
 * plane of phase px. */
static inline ptrdiff_t crv__deinterleaved_index(const crv__deinterleaved *di, int32_t y,
                                                 int32_t px, int32_t m)
{
    const int32_t row = y + di->top, py = row & (CRV__PHASES - 1);
    return di->pitch + (ptrdiff_t)(py * CRV__PHASES + px) * di->plane
           + (ptrdiff_t)(row / CRV__PHASES) * di->pitch + CRV__ROW_PADDING + m;
}

/*
 * What is linear over the image of a plane (methods/slice.h), of the first layer, and its
 * change over a texel from the border outwards: 0 and 1 of `which`. Floats from
 * di->border on to column m of a phase px of the top or bottom row; beside what holds
 * pixels there are CRV__ROW_PADDING of the corner's.
 */
static inline ptrdiff_t crv__border_row(const crv__deinterleaved *di, int32_t is_bottom,
                                        int32_t which, int32_t px, int32_t m)
{
    const int32_t row = (2 * is_bottom + which) * CRV__PHASES + px;
    return (ptrdiff_t)row * di->pitch + CRV__ROW_PADDING + m;
}

/* The same to row y of the left or right column. */
static inline ptrdiff_t crv__border_column(const crv__deinterleaved *di, int32_t is_right,
                                           int32_t which, int32_t y)
{
    return (ptrdiff_t)4 * CRV__PHASES * di->pitch
           + (ptrdiff_t)(2 * is_right + which) * (CRV__PHASES * di->rows) + y;
}

#endif
