/* SPDX-License-Identifier: MIT */
/* methods/hbao.c for the lanes of a vector. */
#include "cpu/kernels/lanes.h"

/* A slice so far, and its step over the image at t = 1. */
typedef struct slice {
    vf step_x, step_y;
    vf horizon, occlusion, weight; /* see the scalar code */
} slice;

/* Slices go side by side: the look-ups of a step do not wait for each other. */
enum { SLICES = 8 };

/* The shaded points, and what does not change from sample to sample. */
typedef struct view {
    vf ray_x, ray_y, facing; /* of the view ray (x, y, -1) of P, or (0, 0, -1) */
    vf centre_x, centre_y, x, y;
} view;

/* The weight of a slice's last horizon is chosen by comparing elevations that may be
 * equal but for rounding; the sum of a slab changes little with them. */
CRV__INLINE vf inverse_root(vf a, int precise)
{
    return precise ? vf_rsqrt(a) : vf_rsqrt_fair(a);
}

/* Surface points at the offsets (in pixels / focal length) from P's view rays, at depth d
 * where `valid`. */
CRV__INLINE void add_samples(slice *s, const crv__params *p, crv__shape shape,
                             const crv__pixels *at, const view *eye, vf offset_x,
                             vf offset_y, vf d, vm valid, int precise)
{
    const crv__v3 n = at->n;
    const vf rise = at->depth - d;
    vf x = offset_x, y = offset_y;
    if (!shape.orthographic) {
        x = vf_fma(eye->ray_x + offset_x, d, -at->P.x);
        y = vf_fma(eye->ray_y + offset_y, d, -at->P.y);
    }
    const vf squared = vf_fma(x, x, vf_fma(y, y, rise * rise));
    /* Outside the radius, background (infinite or NaN) and P itself. */
    valid = vm_and(valid, vm_and(vf_lt(squared, vf_set(p->radius * p->radius)),
                                 vf_lt(vf_zero(), squared)));
    if (!vm_any(valid))
        return;
    const vf along = vf_fma(n.x, offset_x, n.y * offset_y);
    vf Tx = eye->facing * offset_x, Ty = eye->facing * offset_y;
    if (!shape.orthographic) {
        Tx = vf_fma(along, eye->ray_x, Tx);
        Ty = vf_fma(along, eye->ray_y, Ty);
    }
    const vf across = vf_fma(Tx, Tx, Ty * Ty);
    const vf length2 = vf_fma(along, along, across);
    const vf inverse = inverse_root(length2, precise);
    const vf inverse_r = inverse_root(squared, precise);
    vf sin_t = along * inverse; /* downwards */
    valid = vm_and(valid, vf_lt(vf_zero(), length2));
    if (p->sin_bias > 0) {
        const vf cos_t = vf_sqrt(across) * inverse;
        const vf sin_bias = vf_set(p->sin_bias), cos_bias = vf_set(p->cos_bias);
        valid = vm_and(valid, vf_lt(-sin_t * sin_bias, cos_t * cos_bias));
        sin_t = sin_t * cos_bias - cos_t * sin_bias;
    }
    const vf h = vf_fma(rise, inverse_r, sin_t);
    const vm above = vm_and(valid, vf_lt(s->horizon, h));
    const vf W = crv__lanes_falloff(p, squared * inverse_r * vf_set(p->inv_radius));
    s->occlusion = s->occlusion + vf_where(above, (h - s->horizon) * W);
    s->horizon = vf_select(above, h, s->horizon);
    if (precise)
        s->weight = vf_select(above, W, s->weight);
}

CRV__INLINE view view_of(crv__shape shape, const crv__pixels *at)
{
    view eye = {.ray_x = vf_zero(), .ray_y = vf_zero(), .facing = at->n.z};
    if (!shape.orthographic) {
        eye.ray_x = at->P.x / at->depth;
        eye.ray_y = at->P.y / at->depth;
        eye.facing = at->n.z - at->n.x * eye.ray_x - at->n.y * eye.ray_y;
    }
    eye.x = vf_of(at->x);
    eye.y = vf_set((float)at->y);
    eye.centre_x = eye.x + vf_set(0.5f);
    eye.centre_y = eye.y + vf_set(0.5f);
    return eye;
}

/* The sample of a slice at t. */
CRV__INLINE void take_sample(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                             const view *eye, vf t, slice *s, int precise)
{
    const crv__params *p = f->params;
    const vi u = vi_floor(eye->centre_x + t * s->step_x);
    const vi v = vi_floor(eye->centre_y + t * s->step_y);
    vm in = at->active;
    if (!shape.within)
        in = vm_and(
            in, vm_and(vi_below(u, vi_set(p->width)), vi_below(v, vi_set(p->height))));
    /* P's own texel: of the first layer it is P itself. */
    if (shape.layers > 1)
        in = vm_and(in, vm_not(vm_and(vi_eq(u, at->x), vi_eq(v, vi_set(at->y)))));
    const vf offset_x = (vf_of(u) - eye->x) * vf_set(p->inv_fx);
    const vf offset_y = (eye->y - vf_of(v)) * vf_set(p->inv_fy);
    const vi index = crv__lanes_index(&f->depth[0], u, v);
    for (int32_t layer = 0; layer < shape.layers; layer++) {
        const vf d = vf_gather(f->depth[layer].data, index, in);
        const vm there = shape.layers > 1 ? vm_and(in, vf_lt(d, vf_set(INFINITY))) : in;
        add_samples(s, p, shape, at, eye, offset_x, offset_y, d, there, precise);
    }
}

CRV__INLINE void radii(const crv__params *p, crv__shape shape, vf depth, vf *x, vf *y)
{
    const vf unit = shape.orthographic ? vf_set(1) : depth;
    *x = vf_set(p->radius * p->fx) / unit;
    *y = vf_set(p->radius * p->fy) / unit;
    const vf largest = vf_max(*x, *y), cap = vf_set(p->max_radius_px);
    const vm over = vf_lt(cap, largest);
    if (!vm_any(over))
        return;
    *x = vf_select(over, *x * (cap / largest), *x);
    *y = vf_select(over, *y * (cap / largest), *y);
}

CRV__INLINE vf sum_slices(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                          int precise)
{
    const crv__params *p = f->params;
    const vf zero = vf_zero(), half = vf_set(0.5f);
    const view eye = view_of(shape, at);
    vf radius_x, radius_y, occlusion = zero;
    radii(p, shape, at->depth, &radius_x, &radius_y);
    for (int32_t first = 0; first < p->directions; first += SLICES) {
        const int32_t rest = p->directions - first;
        const int32_t count = rest < SLICES ? rest : SLICES;
        slice slices[SLICES];
        for (int32_t k = 0; k < count; k++) {
            vf cosine, sine;
            crv__lanes_point(at, first + k, &cosine, &sine);
            slices[k] = (slice){cosine * radius_x, -sine * radius_y, zero, zero, zero};
        }
        for (int32_t i = 0; i < p->steps; i++) {
            vf t = (vf_set((float)i) + half + half * at->beta) / vf_set((float)p->steps);
            if (p->spacing == CRV_SPACING_QUADRATIC)
                t = t * t;
            for (int32_t k = 0; k < count; k++)
                take_sample(f, shape, at, &eye, t, &slices[k], precise);
        }
        for (int32_t k = 0; k < count; k++)
            occlusion =
                occlusion
                + (precise ? slices[k].horizon * slices[k].weight : slices[k].occlusion);
    }
    return vf_set(1) - occlusion / vf_set((float)p->directions);
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    return f->params->attenuation == CRV_ATTENUATION_SLAB ? sum_slices(f, shape, at, 0)
                                                          : sum_slices(f, shape, at, 1);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    vf radius_x, radius_y;
    radii(f->params, (crv__shape){0}, at->depth, &radius_x, &radius_y);
    return crv__lanes_disk_within(f->params, at, radius_x, radius_y);
}

CRV__ESTIMATE_KERNEL(hbao, 1)
