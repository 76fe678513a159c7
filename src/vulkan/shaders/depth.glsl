/* SPDX-License-Identifier: MIT */
/*
 * Depth encodings to planar depth with background +inf: src/core/depth.c, which computes
 * in double precision. In single precision a depth v between planes must be counted from
 * the end at which its map is smaller, by u = v or u = 1 - v (exact for v from 1/2 to 1):
 * 1/d = 1/far + (1/near - 1/far) u with perspective, d = near + (far - near) u without.
 * Both then add numbers of one sign and cancel nothing. In [-1, 1] the factor is half.
 */
#ifndef DEPTH_GLSL
#define DEPTH_GLSL

#include "common.glsl"

/* crv_depth_encoding */
const int DEPTH_PLANAR = 0, DEPTH_RADIAL = 1, DEPTH_HARDWARE = 2, DEPTH_REVERSED = 3,
          DEPTH_DISPARITY = 4, DEPTH_NORMALISED = 5, DEPTH_NORMALISED_REVERSED = 6,
          DEPTH_GL = 7, DEPTH_LOGARITHMIC = 8;

bool is_reversed(int encoding)
{
    return encoding == DEPTH_REVERSED || encoding == DEPTH_NORMALISED_REVERSED;
}

bool is_normalised(int encoding)
{
    return encoding == DEPTH_NORMALISED || encoding == DEPTH_NORMALISED_REVERSED;
}

float planar_between_planes(float v)
{
    const int encoding = push.depth_encoding;
    const float low = encoding == DEPTH_GL ? -1 : 0;
    if (!(v >= low && v <= 1) || v == (is_reversed(encoding) ? 0 : 1))
        return INFINITY;
    const float u = push.depth_b < 0 ? 1 - v : v;
    precise float affine = push.depth_a + abs(push.depth_b) * u;
    if (is_orthographic() || is_normalised(encoding))
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
    if (encoding == DEPTH_HARDWARE || encoding == DEPTH_GL || is_reversed(encoding)
        || is_normalised(encoding))
        return planar_between_planes(v);
    if (encoding == DEPTH_LOGARITHMIC)
        return v < 1 ? exp2(push.depth_b * v) - 1 : INFINITY;
    if (encoding == DEPTH_DISPARITY)
        return 1 / v;
    if (!(v < push.depth_background))
        return INFINITY;
    return encoding == DEPTH_RADIAL ? planar_of_radial(at, v) : v;
}

/* Of the host's image. */
float planar_depth(ivec2 at)
{
    const float v = texelFetch(host_depth, at + ivec2(push.host_x, push.host_y), 0).r;
    if (is_nan(v))
        return INFINITY;
    const float d = decoded_depth(at, v);
    return is_surface(d) && d > 0 ? d : INFINITY; /* negative and NaN: no surface */
}

#endif
