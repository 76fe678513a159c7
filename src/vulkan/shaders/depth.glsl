/* SPDX-License-Identifier: MIT */
/*
 * Depth encodings to planar depth with background +inf: src/core/depth.c, which reckons
 * in double precision. In single precision a hardware depth v must be counted from the
 * end where what it maps to is smaller, by u = v or u = 1 - v (exact for v from 1/2 to
 * 1): 1/d = 1/far + (1/near - 1/far) u with perspective, d = near + (far - near) u
 * without. Both then add numbers of one sign and cancel nothing.
 */
#ifndef DEPTH_GLSL
#define DEPTH_GLSL

#include "common.glsl"

/* crv_depth_encoding */
const int DEPTH_PLANAR = 0, DEPTH_RADIAL = 1, DEPTH_HARDWARE = 2, DEPTH_REVERSED = 3,
          DEPTH_DISPARITY = 4;

float planar_of_hardware(float v)
{
    const bool reversed = push.depth_encoding == DEPTH_REVERSED;
    if (!(v >= 0 && v <= 1) || v == (reversed ? 0 : 1))
        return INFINITY;
    const float u = reversed == is_orthographic() ? 1 - v : v;
    precise float affine = push.depth_a + push.depth_b * u;
    if (is_orthographic())
        return affine;
    return affine > 0 ? 1 / affine : INFINITY;
}

float planar_of_radial(ivec2 at, float v)
{
    if (is_orthographic())
        return v;
    const vec2 slope = (vec2(at) + 0.5 - vec2(params.cx, params.cy))
                       * vec2(params.inv_fx, params.inv_fy);
    return v / sqrt(1 + dot(slope, slope));
}

float decoded_depth(ivec2 at, float v)
{
    const int encoding = push.depth_encoding;
    if (encoding == DEPTH_HARDWARE || encoding == DEPTH_REVERSED)
        return planar_of_hardware(v);
    if (encoding == DEPTH_DISPARITY)
        return 1 / v;
    if (!(v < push.depth_background))
        return INFINITY;
    return encoding == DEPTH_RADIAL ? planar_of_radial(at, v) : v;
}

/* Of the host's image. */
float planar_depth(ivec2 at)
{
    const float v = texelFetch(host_depth, at, 0).r;
    if (is_nan(v))
        return INFINITY;
    const float d = decoded_depth(at, v);
    return is_surface(d) && d > 0 ? d : INFINITY; /* negative and NaN: no surface */
}

#endif
