/* SPDX-License-Identifier: MIT */
/* What the G-buffer does to every pixel on the way in, row by row, so that kernels can
 * stand in for the specification in depth.c and normals.c: they give the same numbers to
 * the bit. */
#ifndef CRV_CORE_CONVERSIONS_H
#define CRV_CORE_CONVERSIONS_H

#include "core/image.h"
#include "crevice/camera.h"
#include "crevice/gbuffer.h"
#include "shared/params.h"

#include <stdbool.h>

/*
 * What turns the numbers of a depth image into planar depth (depth.c). A depth v between
 * planes is affine in 1/d (buffers, perspective) or in d (is_linear): d = 1 / (a + b v)
 * or d = a + b v for v in [low, 1] without the value at the far plane, `end`.
 * Logarithmic: d = exp2(b v) - 1.
 */
typedef struct crv__depth_map {
    const crv_camera *camera;
    crv_depth_format format;
    double a, b;
    float low, end;
    bool is_linear;
} crv__depth_map;

/* A row of the host's pixels. A number v stands for v * scale + offset, computed in
 * floats; v itself if scale is 1 and offset 0. */
typedef struct crv__texel_row {
    const void *at; /* the first pixel */
    crv_texel type;
    ptrdiff_t stride, channel; /* bytes from a pixel, or a component, to the next */
    float scale, offset;
} crv__texel_row;

typedef struct crv__conversions {
    /* Planar depth of the pixels from (0, y) on, to out[0 .. count). */
    void (*depth_row)(const crv__depth_map *map, const crv__texel_row *from, int32_t y,
                      int32_t count, float *out);
    /* rotation (row by row) * v for the row's pixels, to out[3][0 .. count). */
    void (*rotated_row)(const float rotation[9], const crv__texel_row *from,
                        int32_t count, float *const out[3]);
    /* Turns row y of normal[3] into unit normals that face the camera, reconstructed from
     * depth where there are none; has_normals 0: there are none at all. */
    void (*normals_row)(const crv__params *params, const crv__plane *depth,
                        const crv__plane *normal, int32_t has_normals, int32_t y);
} crv__conversions;

/* The specification: crv__depth_row(), crv__rotated_row(), crv__normals_row(). */
extern const crv__conversions crv__conversions_specified;

#endif
