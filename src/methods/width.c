/* SPDX-License-Identifier: MIT */
#include "methods/width.h"

static const float FARTHEST_PX = 32, JUMP = 0.2f; /* JUMP: in radii */

/* The depth that the surface through `own` and the pixel before it, at depth `before`, is
 * expected to have one pixel on. */
static float expected(const crv__params *p, float own, float before)
{
    if (!(before < own && 2 * before > own))
        return own;
    const float on = p->orthographic ? 2 * own - before
                                     : own * before / (2 * before - own); /* linear 1/d */
    return on - own < JUMP * p->radius ? on : own;
}

static float depth_at(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__plane *depth = &f->depth[0];
    return crv__plane_holds(depth, x, y) ? *crv__plane_at(depth, x, y) : 0;
}

/* Pixels from (x, y) to the nearest silhouette in the direction (dx, dy), counted in
 * steps; INFINITY: none. */
static float to_silhouette(const crv__frame *f, int32_t x, int32_t y, int32_t dx,
                           int32_t dy)
{
    const crv__params *p = f->params;
    const float jump = JUMP * p->radius;
    const float step_px = dx && dy ? 1.41421356f : 1;
    float before = depth_at(f, x - dx, y - dy), own = depth_at(f, x, y);
    for (float steps = 0.5f; steps * step_px <= FARTHEST_PX; steps++) {
        x += dx;
        y += dy;
        if (!crv__plane_holds(&f->depth[0], x, y))
            return INFINITY;
        const float next = depth_at(f, x, y);
        if (next - expected(p, own, before) > jump)
            return steps;
        if (own - next > jump)
            return INFINITY;
        before = own;
        own = next;
    }
    return INFINITY;
}

static float width(const crv__frame *f, int32_t x, int32_t y)
{
    static const int32_t AXES[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    const crv__params *p = f->params;
    const float d = depth_at(f, x, y), unit = p->orthographic ? 1 : d;
    float least = INFINITY;
    for (int i = 0; i < 4 && d < INFINITY; i++) {
        const int32_t dx = AXES[i][0], dy = AXES[i][1];
        const float ahead = to_silhouette(f, x, y, dx, dy);
        if (!(ahead < INFINITY))
            continue;
        const float steps = ahead + to_silhouette(f, x, y, -dx, -dy);
        const float step_x = (float)dx * p->inv_fx, step_y = (float)dy * p->inv_fy;
        const float step = unit * sqrtf(step_x * step_x + step_y * step_y);
        least = fminf(least, steps * step);
    }
    return least;
}

const crv__map crv__map_width = {
    .name = "width", .option = "thickness_rule", .value = width};
