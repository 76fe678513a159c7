/* SPDX-License-Identifier: MIT */
/*
 * The width of the surface at a pixel, in scene units: the smallest sum of the distances
 * to the nearest silhouettes on both sides, on four axes of the image.
 * src/methods/width.h says what a silhouette is.
 */
#ifndef WIDTH_GLSL
#define WIDTH_GLSL

#include "frame.glsl"

const float WIDTH_FARTHEST_PX = 32, WIDTH_JUMP = 0.2; /* the latter in radii */
const ivec2 WIDTH_AXES[4] = ivec2[4](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1));

/* The depth that the surface through `own` and the pixel before it, at depth `before`, is
 * expected to have one pixel on. */
float width_expected(float own, float before)
{
    if (!(before < own && 2 * before > own))
        return own;
    precise float on = is_orthographic() ? 2 * own - before
                                         : own * before / (2 * before - own);
    return on - own < WIDTH_JUMP * params.radius ? on : own;
}

/* Steps from a pixel to the nearest silhouette in a direction; below 0: none. */
float width_steps(ivec2 at, ivec2 way)
{
    const float jump = WIDTH_JUMP * params.radius;
    const float step_px = way.x != 0 && way.y != 0 ? 1.41421356 : 1;
    float before = in_buffers(at - way) ? depth_at(at - way, 0) : 0;
    float own = depth_at(at, 0);
    for (float steps = 0.5; steps * step_px <= WIDTH_FARTHEST_PX; steps++) {
        at += way;
        if (!in_buffers(at))
            return -1;
        const float next = depth_at(at, 0);
        if (!is_surface(next) || next - width_expected(own, before) > jump)
            return steps;
        if (own - next > jump)
            return -1;
        before = own;
        own = next;
    }
    return -1;
}

/* INFINITY: no axis has silhouettes on both sides, or the pixel is background. */
float width_at(ivec2 at)
{
    const float d = depth_at(at, 0);
    float least = INFINITY;
    for (int i = 0; i < 4 && is_surface(d); i++) {
        const ivec2 way = WIDTH_AXES[i];
        const float ahead = width_steps(at, way);
        const float behind = ahead < 0 ? -1 : width_steps(at, -way);
        const vec2 one = vec2(way) * vec2(params.inv_fx, params.inv_fy) * view_unit(d);
        if (behind >= 0)
            least = min(least, (ahead + behind) * sqrt(dot(one, one)));
    }
    return least;
}

#endif
