/* SPDX-License-Identifier: MIT */
/* What the filters share: which neighbours belong to the same surface. The papers tell by
 * depth alone; here the normals have a say as well (filter_normal), because accessibility
 * changes with the normal at every edge between faces that touch. */
#ifndef CRV_FILTERS_TAP_H
#define CRV_FILTERS_TAP_H

#include "core/frame.h"

/* The centre of a filter window: its depth, and the depth's change from pixel to pixel.
 */
typedef struct crv__centre {
    int32_t x, y;
    float depth, slope_x, slope_y;
    crv__vec3 normal;
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
    return fabsf(slope) < CRV_STEEPEST_SLOPE ? slope : 0;
}

static inline crv__centre crv__centre_at(const crv__frame *f, int32_t x, int32_t y)
{
    crv__centre c = {.x = x,
                     .y = y,
                     .depth = *crv__plane_at(&f->depth[0], x, y),
                     .normal = crv__normal_at(f, x, y)};
    if (f->params->filter_slope) {
        c.slope_x = crv__slope(&f->depth[0], x, y, 1, 0, c.depth);
        c.slope_y = crv__slope(&f->depth[0], x, y, 0, 1, c.depth);
    }
    return c;
}

/* A pixel of a pass's input. */
static inline crv__estimate crv__estimate_at(const crv__picture *input, int32_t x,
                                             int32_t y)
{
    crv__estimate e = {.accessibility = *crv__plane_at(&input->accessibility, x, y)};
    if (input->bent[0].data)
        e.bent = crv__vec3_at(input->bent, x, y);
    return e;
}

/* The weighted sum of taps. */
typedef struct crv__tap_sum {
    crv__estimate values;
    float weights;
} crv__tap_sum;

static inline void crv__tap_add(crv__tap_sum *sum, const crv__estimate *value,
                                float weight)
{
    sum->values.accessibility += weight * value->accessibility;
    sum->values.bent = crv__add_scaled(sum->values.bent, value->bent, weight);
    sum->weights += weight;
}

static inline crv__estimate crv__tap_mean(const crv__tap_sum *sum)
{
    const crv__vec3 b = sum->values.bent;
    const float weights = sum->weights;
    return (crv__estimate){sum->values.accessibility / weights,
                           {b.x / weights, b.y / weights, b.z / weights}};
}

typedef struct crv__tap {
    crv__estimate value;
    float deviation; /* of its depth from what the centre leads one to expect, in units of
                        filter_depth */
    float likeness;  /* of its normal to the centre's, 0 to 1 */
} crv__tap;

/*
 * The tap at (x + dx, y + dy). Returns 0 where there is no such tap: outside the picture,
 * background, a surface turned by filter_normal or more, or one so far off that the
 * deviation overflows.
 */
static inline int crv__tap_at(const crv__frame *f, const crv__picture *input,
                              const crv__centre *c, int32_t dx, int32_t dy, crv__tap *tap)
{
    const int32_t u = c->x + dx, v = c->y + dy;
    if (!crv__plane_holds(&input->accessibility, u, v))
        return 0;
    const float d = *crv__plane_at(&f->depth[0], u, v);
    tap->value = crv__estimate_at(input, u, v);
    if (!(d < INFINITY) || isnan(tap->value.accessibility))
        return 0;
    const float expected = c->depth + (float)dx * c->slope_x + (float)dy * c->slope_y;
    tap->deviation = fabsf(d - expected) / f->params->filter_depth;
    const float turned = 1 - crv__dot(crv__normal_at(f, u, v), c->normal);
    tap->likeness = fminf(1, 1 - turned * f->params->filter_normal);
    return tap->likeness > 0 && tap->deviation < INFINITY;
}

#endif
