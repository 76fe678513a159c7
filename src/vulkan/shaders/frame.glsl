/* SPDX-License-Identifier: MIT */
/*
 * Camera, noise tile and directions: src/core/frame.h. Where a number decides which texel
 * is read it is `precise`: the same operations in the same order as there, so that both
 * read the same texel.
 */
#ifndef FRAME_GLSL
#define FRAME_GLSL

#include "common.glsl"
#include "part.glsl"

/* The depth by which an offset on the image plane at depth 1 grows; 1 if rays are
 * parallel. */
float view_unit(float depth)
{
    return is_orthographic() ? 1 : depth;
}

/* The view-space point at the centre of a pixel with planar depth d. */
vec3 unproject(ivec2 at, float d)
{
    const float scale = view_unit(d);
    precise vec3 point =
        vec3((float(at.x) + 0.5 - params.cx) * params.inv_fx * scale,
             -(float(at.y) + 0.5 - params.cy) * params.inv_fy * scale, -d);
    return point;
}

/* The place in the buffers, in pixels from their corner, that is nearest to `place` and
 * falls on a texel: the same where `place` does. Fetching there and throwing away what
 * does not count keeps samples free of branches, so that many fetches are under way at
 * once. */
vec2 clamped_place(vec2 place)
{
    const vec2 size = vec2(params.width, params.height);
    const vec2 last = uintBitsToFloat(floatBitsToUint(size) - 1u); /* just below */
    return clamp(place, vec2(0), last);
}

/* The view ray of a point at planar depth d, z = -1. */
vec3 view_ray(vec3 point, float d)
{
    return is_orthographic() ? vec3(0, 0, -1) : vec3(point.xy / d, -1);
}

/*
 * S - P, where P lies at depth d on the view ray `ray` and S at depth z on the ray of a
 * texel that is `offset` away on the image plane at depth 1: less work than two points
 * and their difference, and nothing cancels.
 */
vec3 between(vec3 ray, float d, vec2 offset, float z)
{
    const float farther = z - d;
    return vec3(ray.xy * farther + offset * view_unit(z), -farther);
}

/* The offset on the image plane at depth 1 from one texel to another. */
vec2 image_offset(ivec2 from, ivec2 to)
{
    return vec2(float(to.x - from.x) * params.inv_fx,
                float(from.y - to.y) * params.inv_fy);
}

/* v turned by the texel's rotation. */
vec2 turned(crv__noise_texel noise, vec2 v)
{
    precise vec2 result = vec2(v.x * noise.cos_alpha - v.y * noise.sin_alpha,
                               v.x * noise.sin_alpha + v.y * noise.cos_alpha);
    return result;
}

/* The k-th of the equally spaced directions, turned by the texel's rotation. */
vec2 direction_at(crv__noise_texel noise, int k)
{
    return turned(noise, direction_of(k));
}

/* A jitter in [0, 1) for the k-th of several strata of one pixel: the texel's own,
 * moved on by the golden ratio, so that all k of all texels cover the interval evenly. */
float stratum_at(crv__noise_texel noise, int k)
{
    precise float x = 0.5 + 0.5 * noise.beta + 0.618034 * float(k);
    return x - floor(x);
}

/* The radius of influence in pixels at this depth, along x and y. */
vec2 projected_radius(float depth)
{
    const float unit = view_unit(depth);
    precise vec2 radius_px =
        vec2(params.radius * params.fx / unit, params.radius * params.fy / unit);
    return radius_px;
}

#endif
