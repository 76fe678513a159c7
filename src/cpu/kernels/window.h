/* SPDX-License-Identifier: MIT */
/* What the filters share, as filters/tap.h has it, for the lanes of a vector. */
#ifndef CRV_CPU_KERNELS_WINDOW_H
#define CRV_CPU_KERNELS_WINDOW_H

#include "cpu/kernels/lanes.h"

/* Planes of a picture: accessibility, then the components of bent normals, how they
 * deviate from the surface's normals, if there are any. They have the same rectangle and
 * pitch. */
enum { CRV__PLANES = 4 };

CRV__INLINE const crv__plane *crv__plane_of(const crv__picture *picture, int32_t plane)
{
    return plane == 0 ? &picture->accessibility : &picture->bent[plane - 1];
}

/* A result of a filter: accessibility in [0, 1], background 1; of deviations 0 if there
 * is no mean. */
CRV__INLINE vf crv__filter_result(vf depth, vf result, int32_t plane)
{
    const vm surface = vf_lt(depth, vf_set(INFINITY));
    return plane == 0 ? vf_select(surface, vf_clamp01(result), vf_set(1))
                      : vf_where(vm_and(surface, vf_le(result, result)), result);
}

/* The lanes' centres, adjacent pixels of a row from x on. */
typedef struct crv__window {
    const crv__frame *frame;
    const crv__plane *input;
    int32_t x, y;
    vf depth, slope_x, slope_y;
    crv__v3 normal;
} crv__window;

/* CRV__LANES pixels of a row from x on, which may leave the plane; *inside: those that do
 * not. Lanes outside hold 0. */
CRV__INLINE vf crv__row_read(const crv__plane *plane, int32_t x, int32_t y, vm *inside)
{
    const int32_t first = x < plane->x0 ? plane->x0 - x : 0;
    const int32_t rest = plane->x0 + plane->width - x;
    const int32_t end = rest < CRV__LANES ? rest : CRV__LANES;
    if (y < plane->y0 || y >= plane->y0 + plane->height || first >= end) {
        *inside = vm_first(0);
        return vf_zero();
    }
    const float *row = crv__plane_at(plane, plane->x0, y) - plane->x0;
    if (first == 0 && end == CRV__LANES) {
        *inside = vm_first(CRV__LANES);
        return vf_load(row + x);
    }
    float lanes[CRV__LANES] = {0};
    for (int32_t i = first; i < end; i++)
        lanes[i] = row[x + i];
    *inside = vm_and(vm_first(end), vm_not(vm_first(first)));
    return vf_load(lanes);
}

/* crv__slope(): of the two one-sided differences the smaller, the earlier where equal. */
CRV__INLINE vf crv__lanes_slope(const crv__plane *depth, int32_t x, int32_t y,
                                int32_t step_x, int32_t step_y, vf d)
{
    const vf infinity = vf_set(INFINITY);
    vm inside;
    const vf before = crv__row_read(depth, x - step_x, y - step_y, &inside);
    const vf backward = vf_select(inside, d - before, infinity);
    const vf after = crv__row_read(depth, x + step_x, y + step_y, &inside);
    const vf forward = vf_select(inside, after - d, infinity);
    const vf slope =
        vf_select(vf_lt(vf_abs(forward), vf_abs(backward)), forward, backward);
    return vf_where(vf_lt(vf_abs(slope), vf_set(CRV_STEEPEST_SLOPE)), slope);
}

CRV__INLINE crv__window crv__window_at(const crv__frame *f, const crv__plane *input,
                                       int32_t x, int32_t y)
{
    vm inside;
    crv__window w = {.frame = f, .input = input, .x = x, .y = y};
    w.depth = crv__row_read(&f->depth[0], x, y, &inside);
    w.normal.x = crv__row_read(&f->normal[0], x, y, &inside);
    w.normal.y = crv__row_read(&f->normal[1], x, y, &inside);
    w.normal.z = crv__row_read(&f->normal[2], x, y, &inside);
    w.slope_x = w.slope_y = vf_zero();
    if (f->params->filter_slope) {
        w.slope_x = crv__lanes_slope(&f->depth[0], x, y, 1, 0, w.depth);
        w.slope_y = crv__lanes_slope(&f->depth[0], x, y, 0, 1, w.depth);
    }
    return w;
}

typedef struct crv__taps {
    vf value;     /* 0 where there is no tap */
    vf deviation; /* in units of filter_depth */
    vf likeness;  /* 0 where there is no tap */
    vm any;       /* the lanes that have this tap */
} crv__taps;

/* crv__tap_at() */
CRV__INLINE crv__taps crv__taps_at(const crv__window *w, int32_t dx, int32_t dy)
{
    const crv__frame *f = w->frame;
    const int32_t u = w->x + dx, v = w->y + dy;
    const vf one = vf_set(1);
    vm inside, unused;
    const vf d = crv__row_read(&f->depth[0], u, v, &unused);
    const vf value = crv__row_read(w->input, u, v, &inside);
    const crv__v3 n = {crv__row_read(&f->normal[0], u, v, &unused),
                       crv__row_read(&f->normal[1], u, v, &unused),
                       crv__row_read(&f->normal[2], u, v, &unused)};
    inside = vm_and(inside, vf_le(value, value));
    /* In the scalar code's order and rounding: beside silhouettes the slopes are steep,
     * and cancel. They are finite, so that no step adds nothing. */
    vf expected = w->depth;
    if (dx != 0)
        expected = expected + vf_set((float)dx) * w->slope_x;
    if (dy != 0)
        expected = expected + vf_set((float)dy) * w->slope_y;
    crv__taps tap;
    tap.deviation = vf_abs(d - expected) * vf_set(1 / f->params->filter_depth);
    const vf cosine =
        vf_fma(n.x, w->normal.x, vf_fma(n.y, w->normal.y, n.z * w->normal.z));
    const vf likeness =
        vf_min(vf_fma(cosine - one, vf_set(f->params->filter_normal), one), one);
    const vf infinity = vf_set(INFINITY);
    tap.any = vm_and(vm_and(inside, vf_lt(d, infinity)),
                     vm_and(vf_lt(vf_zero(), likeness), vf_lt(tap.deviation, infinity)));
    tap.value = vf_where(tap.any, value);
    tap.likeness = vf_where(tap.any, likeness);
    return tap;
}

/* The slow and general way: `count` pixels of one row of a plane, wherever they are. A
 * centre that is NaN stays so. */
CRV__INLINE void crv__filter_pixels(const crv__frame *f, const crv__picture *input,
                                    int32_t plane, int32_t x, int32_t y, int32_t count,
                                    float *out, vf (*filter)(const crv__window *))
{
    const crv__window w = crv__window_at(f, crv__plane_of(input, plane), x, y);
    vm inside;
    const vf own = crv__row_read(w.input, x, y, &inside);
    const vf result = crv__filter_result(w.depth, filter(&w), plane);
    const vm is_none = vm_and(vm_not(vf_le(own, own)), vf_lt(w.depth, vf_set(INFINITY)));
    vf_store_n(out, vf_select(is_none, own, result), count);
}

#endif
