/* SPDX-License-Identifier: MIT */
/* What the kernels of one instruction set are to the backend. */
#ifndef CRV_CPU_KERNELS_KERNEL_H
#define CRV_CPU_KERNELS_KERNEL_H

#include "core/conversions.h"
#include "core/ids.h"
#include "cpu/kernels/deinterleaved.h"

#include <stdbool.h>

/* Accessibility of the pixels x0 to x1 - 1 of row y, intensity applied, in [0, 1],
 * background 1, to out[0 .. x1 - x0). */
typedef void (*crv__estimate_kernel)(const crv__frame *frame, int32_t x0, int32_t x1,
                                     int32_t y, float *out);

/* The same, and the components of the bent normals, unit length, background 0. */
typedef void (*crv__bent_kernel)(const crv__frame *frame, int32_t x0, int32_t x1,
                                 int32_t y, float *out, float *const bent[3]);

/* The pixels of x0 to x1 - 1 and y0 to y1 - 1. */
typedef struct crv__tile {
    int32_t x0, x1, y0, y1;
} crv__tile;

/* What a filter's kernel does at once: rows long enough to stream, and so few of them
 * that what a pass leaves for the next (on the stack) stays in the cache. */
enum { CRV__FILTER_TILE_WIDTH = 128, CRV__FILTER_TILE_HEIGHT = 84 };

/* All passes of a filter over a rectangle no larger than a tile; as crv__filter.filter
 * for each pixel that is not background. Accessibility is kept in [0, 1], and with bent
 * normals in both pictures their components are filtered with the same weights. */
typedef void (*crv__filter_kernel)(const crv__frame *frame, const crv__picture *input,
                                   const crv__picture *out, crv__tile tile);

/* A method's map over a rectangle no larger than a tile; as crv__map.value. */
enum { CRV__MAP_TILE_WIDTH = 128, CRV__MAP_TILE_HEIGHT = 64 };
typedef void (*crv__map_kernel)(const crv__frame *frame, const crv__plane *out,
                                crv__tile tile);

/* A method's kernel in the di structure, and its samples. 0 or 1 each: slices of steps
 * in directions, not the points of a pattern; an even number of directions or points
 * comes in opposite pairs; steps are rounded to even, not half up; those to the pixel
 * itself are kept; those of 32 pixels or more are rounded to multiples of the tile's 4;
 * every slice has a jitter of its own, and steps of a pixel at least; it knows one layer.
 * Projected radii are quantised to 2^fineness buckets an octave. */
typedef struct crv__deinterleaved_method {
    crv__deinterleaved_kernel run;
    crv__deinterleaved_kernel run_bent; /* with bent normals; NULL: there is none */
    bool in_slices, in_pairs, is_rounded, keeps_centre, far_on_grid, jittered, one_layer;
    int32_t fineness;
} crv__deinterleaved_method;

/* NULL: there is none. */
typedef struct crv__kernels {
    crv__estimate_kernel estimates[CRV__METHOD_COUNT];
    crv__bent_kernel bents[CRV__METHOD_COUNT];
    const crv__deinterleaved_method *deinterleaved[CRV__METHOD_COUNT];
    crv__map_kernel maps[CRV__METHOD_COUNT];
    crv__filter_kernel filters[CRV__FILTER_COUNT];
    crv__deinterleave_kernel deinterleave;
    crv__conversions conversions;
} crv__kernels;

#endif
