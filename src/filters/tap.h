/* SPDX-License-Identifier: MIT */
/* What the filters share: which neighbours belong to the same surface. */
#ifndef CRV_FILTERS_TAP_H
#define CRV_FILTERS_TAP_H

#include "core/frame.h"

/* The centre of a filter window: its depth, and the depth's change from pixel to pixel.
 */
typedef struct crv__centre {
    int32_t x, y;
    float depth, slope_x, slope_y;
} crv__centre;

/* The smaller of the two one-sided differences: the one that does not cross an edge. 0 at
 * pixels without neighbours. */
static inline float crv__slope(const crv__plane *depth, int32_t x, int32_t y,
                               int32_t step_x, int32_t step_y, float d)
{
    float slope = INFINITY;
    for (int32_t sign = -1; sign <= 1; sign += 2) {
        const int32_t u = x + sign * step_x, v = y + sign * step_y;
        if (!crv__plane_holds(depth, u, v))
            continue;
        const float difference = (*crv__plane_at(depth, u, v) - d) * (float)sign;
        if (fabsf(difference) < fabsf(slope))
            slope = difference;
    }
    return slope > -INFINITY && slope < INFINITY ? slope : 0;
}

static inline crv__centre crv__centre_at(const crv__frame *f, int32_t x, int32_t y)
{
    crv__centre c = {x, y, *crv__plane_at(&f->depth[0], x, y), 0, 0};
    if (f->params->filter_slope) {
        c.slope_x = crv__slope(&f->depth[0], x, y, 1, 0, c.depth);
        c.slope_y = crv__slope(&f->depth[0], x, y, 0, 1, c.depth);
    }
    return c;
}

/*
 * The tap at (x + dx, y + dy): its value, and how far its depth is from what the centre
 * leads one to expect, in units of filter_depth. Returns 0 where there is no such tap:
 * outside the picture, or background.
 */
static inline int crv__tap(const crv__frame *f, const crv__plane *input,
                           const crv__centre *c, int32_t dx, int32_t dy, float *value,
                           float *deviation)
{
    const int32_t u = c->x + dx, v = c->y + dy;
    if (!crv__plane_holds(input, u, v))
        return 0;
    const float d = *crv__plane_at(&f->depth[0], u, v);
    *value = *crv__plane_at(input, u, v);
    if (!(d < INFINITY) || isnan(*value))
        return 0;
    const float expected = c->depth + (float)dx * c->slope_x + (float)dy * c->slope_y;
    *deviation = fabsf(d - expected) / f->params->filter_depth;
    return 1;
}

#endif
