/* SPDX-License-Identifier: MIT */
/* methods/gtao.c for the lanes of a vector. */
#include "cpu/kernels/slice.h"

/* A slice so far: see the scalar code. */
typedef struct horizon {
    vf cosine, open, occlusion, weight;
} horizon;

CRV__INLINE void add_sample(horizon *h, const crv__params *p, const crv__lanes_site *site,
                            const crv__lanes_slice *s, vf x, vf z, vm there)
{
    const vf r = vf_sqrt(x * x + z * z), cosine = z / r;
    there = vm_and(there, vm_and(vf_lt(vf_zero(), x), vf_lt(r, vf_set(p->radius))));
    const vm above = vm_and(there, vf_lt(h->cosine, cosine));
    if (!vm_any(above))
        return;
    const vf open = crv__lanes_share(p, site, s, cosine, x / r);
    const vf W = crv__lanes_falloff(p, r * vf_set(p->inv_radius));
    const vf gain = vf_max(h->open - open, vf_zero());
    h->occlusion = h->occlusion + vf_where(above, gain * W);
    h->cosine = vf_select(above, cosine, h->cosine);
    h->open = vf_select(above, vf_min(h->open, open), h->open);
    h->weight = vf_select(above, W, h->weight);
}

CRV__INLINE vf blocked_share(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                             const crv__lanes_site *site, const crv__lanes_slice *s)
{
    const crv__params *p = f->params;
    horizon h = {s->cos_tangent, vf_set(1), vf_zero(), vf_zero()};
    for (int32_t i = 0; i < p->steps; i++) {
        const crv__lanes_texel texel = crv__lanes_slice_texel(p, shape, at, s, i);
        for (int32_t layer = 0; layer < shape.layers; layer++) {
            const vf d = crv__lanes_slice_depth(f, shape, layer, &texel);
            vf x, z;
            crv__lanes_slice_point(p, shape, at, site, s, &texel, d, &x, &z);
            add_sample(&h, p, site, s, x, z, vf_lt(d, vf_set(INFINITY)));
        }
    }
    return p->attenuation == CRV_ATTENUATION_SLAB ? h.occlusion
                                                  : (vf_set(1) - h.open) * h.weight;
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    return crv__lanes_slices_open(f, shape, at, blocked_share);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    return crv__slices_within(f, at);
}

CRV__ESTIMATE_KERNEL(gtao, 1)
