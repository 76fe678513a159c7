/* SPDX-License-Identifier: MIT */
/*
 * params.h: the numbers that an estimator or filter reads, the same for every pixel of a
 * frame. C and GLSL both include this file. Only 4-byte members, so that both lay it out
 * alike (std140 and std430).
 */
#ifndef CRV_SHARED_PARAMS_H
#define CRV_SHARED_PARAMS_H

#ifdef VULKAN /* defined by GLSL compilers */
#define int32_t int
#else
#include <stddef.h>
#include <stdint.h>
#endif

/* The steepest slope of depth from pixel to pixel that filters follow: a window's steps
 * along both axes cannot overflow. */
#define CRV_STEEPEST_SLOPE 1e37f

struct crv__params {
    int32_t width, height; /* of the buffers, guard band included */
    int32_t layers;
    int32_t orthographic; /* 0 or 1 */

    float fx, fy, cx, cy; /* as in camera.h */

    float inv_fx, inv_fy;
    float radius; /* scene units */
    float inv_radius;

    int32_t falloff; /* crv_falloff */
    float tau, u;
    float max_radius_px; /* INFINITY: no cap */

    int32_t directions, steps;
    float sin_bias, cos_bias;

    int32_t attenuation; /* crv_attenuation */
    int32_t noise_size;
    int32_t noise_x, noise_y; /* tile coordinates of buffer pixel (0, 0) */

    float intensity, contrast;
    float filter_depth;   /* scene units */
    int32_t filter_slope; /* 0 or 1 */

    int32_t layers_solid; /* 0 or 1 */
    int32_t normal_rays, growing_sphere;
    int32_t samples;

    int32_t bands;
    float band_px;
    float alchemy_bias, alchemy_eps;

    int32_t normaliser; /* crv_normaliser */
    int32_t rescale;
    int32_t use_depth, use_field; /* characteristic functions */

    int32_t spacing;     /* crv_spacing */
    float thickness;     /* scene units; INFINITY: no limit */
    float filter_normal; /* 1 / (1 - cos of the angle); 0: no limit */
    int32_t weighting;   /* crv_weighting */

    int32_t border;         /* crv_border */
    int32_t thickness_rule; /* crv_thickness */
    float unused_0, unused_1;
};

/* One texel of the noise tile. */
struct crv__noise_texel {
    float cos_alpha, sin_alpha; /* rotation, alpha in [0, 2 pi / directions) */
    float beta;                 /* step jitter in (-1, 1) */
    float sector_offset;        /* in [0, 1): of bitmask's sectors */
};

#ifndef VULKAN
typedef struct crv__params crv__params;
typedef struct crv__noise_texel crv__noise_texel;

_Static_assert(sizeof(crv__params) == 48 * 4, "no padding, a multiple of 16 bytes");
_Static_assert(offsetof(crv__params, falloff) == 12 * 4, "layout shared with GLSL");
_Static_assert(offsetof(crv__params, use_field) == 39 * 4, "layout shared with GLSL");
_Static_assert(sizeof(crv__noise_texel) == 16, "layout shared with GLSL");
#endif

#endif
