/* SPDX-License-Identifier: MIT */
/* methods/hbao.c for the lanes of a vector. */
#include "cpu/kernels/lanes.h"

/* The slices so far. */
typedef struct slices {
    vf horizon, occlusion, weight;
} slices;

/* What does not change from sample to sample. */
typedef struct view {
    vf ray_x, ray_y, facing; /* of the view ray (x, y, -1) of P, or (0, 0, -1) */
} view;

static inline void add_samples(slices *s, const crv__params *p, const crv__pixels *at,
                               const view *eye, vf offset_x, vf offset_y, crv__v3 S,
                               vm valid)
{
    const crv__v3 v = crv__v3_sub(S, at->P);
    const vf squared = crv__v3_dot(v, v);
    /* Outside the radius, background (infinite or NaN) and P itself. */
    valid = vm_and(valid, vm_and(vf_lt(squared, vf_set(p->radius * p->radius)),
                                 vf_lt(vf_zero(), squared)));
    if (!vm_any(valid))
        return;
    const vf along = vf_fma(at->n.x, offset_x, at->n.y * offset_y);
    const vf Tx = vf_fma(eye->facing, offset_x, along * eye->ray_x);
    const vf Ty = vf_fma(eye->facing, offset_y, along * eye->ray_y);
    const vf across = vf_fma(Tx, Tx, Ty * Ty);
    const vf length2 = vf_fma(along, along, across);
    const vf inverse = vf_rsqrt(length2);
    const vf inverse_r = vf_rsqrt(squared);
    vf sin_t = -along * inverse;
    valid = vm_and(valid, vf_lt(vf_zero(), length2));
    if (p->sin_bias > 0) {
        const vf cos_t = vf_sqrt(across) * inverse;
        const vf sin_bias = vf_set(p->sin_bias), cos_bias = vf_set(p->cos_bias);
        valid = vm_and(valid, vf_lt(sin_t * sin_bias, cos_t * cos_bias));
        sin_t = sin_t * cos_bias + cos_t * sin_bias;
    }
    const vf h = v.z * inverse_r - sin_t;
    const vm above = vm_and(valid, vf_lt(s->horizon, h));
    const vf W = crv__lanes_falloff(p, squared * inverse_r * vf_set(p->inv_radius));
    s->occlusion = s->occlusion + vf_where(above, (h - s->horizon) * W);
    s->horizon = vf_select(above, h, s->horizon);
    s->weight = vf_select(above, W, s->weight);
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const vf half = vf_set(0.5f), unit = shape.orthographic ? vf_set(1) : at->depth;
    const view eye = {shape.orthographic ? vf_zero() : at->P.x / at->depth,
                      shape.orthographic ? vf_zero() : at->P.y / at->depth,
                      shape.orthographic ? at->n.z
                                         : at->n.z - at->n.x * (at->P.x / at->depth)
                                               - at->n.y * (at->P.y / at->depth)};
    vf radius_x = vf_set(p->radius * p->fx) / unit,
       radius_y = vf_set(p->radius * p->fy) / unit;
    const vf largest = vf_max(radius_x, radius_y), cap = vf_set(p->max_radius_px);
    const vm over = vf_lt(cap, largest);
    radius_x = vf_select(over, radius_x * (cap / largest), radius_x);
    radius_y = vf_select(over, radius_y * (cap / largest), radius_y);

    const vi y = vi_set(at->y);
    const vf centre_x = vf_of(at->x) + half, centre_y = vf_of(y) + half;
    const vf width = vf_set((float)p->width), height = vf_set((float)p->height);
    vf occlusion = vf_zero();
    for (int32_t k = 0; k < p->directions; k++) {
        vf cosine, sine;
        crv__lanes_point(at, k, &cosine, &sine);
        const vf step_x = cosine * radius_x, step_y = -sine * radius_y;
        slices walk = {vf_zero(), vf_zero(), vf_zero()};
        for (int32_t i = 0; i < p->steps; i++) {
            vf t = (vf_set((float)i) + half + half * at->beta) / vf_set((float)p->steps);
            if (p->spacing == CRV_SPACING_QUADRATIC)
                t = t * t;
            const vf sample_x = centre_x + t * step_x, sample_y = centre_y + t * step_y;
            vm in = vm_and(vm_and(vf_le(vf_zero(), sample_x), vf_lt(sample_x, width)),
                           vm_and(vf_le(vf_zero(), sample_y), vf_lt(sample_y, height)));
            in = vm_and(in, at->active);
            const vi u = vi_trunc(sample_x), v = vi_trunc(sample_y);
            in = vm_and(in, vm_not(vm_and(vi_eq(u, at->x), vi_eq(v, y))));
            if (!vm_any(in))
                continue;
            const vf offset_x = vf_of(vi_sub(u, at->x)) * vf_set(p->inv_fx);
            const vf offset_y = vf_of(vi_sub(y, v)) * vf_set(p->inv_fy);
            for (int32_t layer = 0; layer < shape.layers; layer++) {
                const vf depth = crv__lanes_read(&f->depth[layer], u, v, in);
                const vm there = vm_and(in, vf_lt(depth, vf_set(INFINITY)));
                add_samples(&walk, p, at, &eye, offset_x, offset_y,
                            crv__lanes_unproject(p, u, v, depth), there);
            }
        }
        occlusion =
            occlusion
            + (p->attenuation == CRV_ATTENUATION_SLAB ? walk.occlusion
                                                      : walk.horizon * walk.weight);
    }
    return vf_set(1) - occlusion / vf_set((float)p->directions);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    (void)f;
    (void)at;
    return 0;
}

CRV__ESTIMATE_KERNEL(hbao)
