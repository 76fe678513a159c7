/* SPDX-License-Identifier: MIT */
/*
 * push.h: the push constants of every shader, what one dispatch differs in from the next.
 * C and GLSL both include this file. Rectangles are in pixels of the buffers.
 */
#ifndef CRV_SHARED_PUSH_H
#define CRV_SHARED_PUSH_H

#ifdef VULKAN /* defined by GLSL compilers */
#define int32_t int
#else
#include <stddef.h>
#include <stdint.h>
#endif

struct crv__push {
    /* What the input image of filters covers, from its first texel. */
    int32_t in_x, in_y, in_width, in_height;
    /* What is written, and the way from a pixel to its texel in the output image. */
    int32_t out_x, out_y, out_width, out_height;
    int32_t store_x, store_y;
    /* The way from a pixel to its texel in the host's depth and normals. */
    int32_t host_x, host_y;

    int32_t pass;            /* of a filter; level of a prefilter */
    int32_t layer;           /* of a depth conversion or prefilter */
    int32_t depth_encoding;  /* crv_depth_encoding */
    int32_t normal_encoding; /* crv_vulkan_normals */

    /* Depth between planes: 1 / (a + |b| u), or a + |b| u if it is linear; depth.glsl
     * says what u is. Logarithmic: 2^(b v) - 1. */
    float depth_a, depth_b;
    float depth_background; /* planar and radial: this and all beyond; may be INFINITY */

    /* A rotation of normals: 3x3, row by row. An array of floats would lie otherwise in
     * HLSL, into which the shaders translate. */
    float to_view_xx, to_view_xy, to_view_xz;
    float to_view_yx, to_view_yy, to_view_yz;
    float to_view_zx, to_view_zy, to_view_zz;

    /* An estimate's directions or points, where it is computed in parts. */
    int32_t part_begin, part_end;
    int32_t is_last_part; /* 0 or 1 */
};

#ifndef VULKAN
typedef struct crv__push crv__push;

_Static_assert(sizeof(crv__push) == 124, "at most 128 bytes; layout shared with GLSL");
_Static_assert(offsetof(crv__push, to_view_xx) == 76, "layout shared with GLSL");
#endif

#endif
