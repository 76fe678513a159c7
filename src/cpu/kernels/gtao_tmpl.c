/* SPDX-License-Identifier: MIT */
/* methods/gtao.c for the lanes of a vector. */
#include "cpu/kernels/slice.h"

/* A slice so far: see the scalar code. */
typedef struct horizon {
    vf cosine, open, occlusion, weight;
    crv__v2 vector, blocked;
} horizon;

/* crv__slice_vector() of the lanes whose horizon rises. */
CRV__INLINE void add_vector(horizon *h, crv__v2 vector, vf W, vm above)
{
    h->blocked.T = h->blocked.T + vf_where(above, (h->vector.T - vector.T) * W);
    h->blocked.V = h->blocked.V + vf_where(above, (h->vector.V - vector.V) * W);
    h->vector.T = vf_select(above, vector.T, h->vector.T);
    h->vector.V = vf_select(above, vector.V, h->vector.V);
}

CRV__INLINE void add_sample(horizon *h, const crv__params *p, const crv__lanes_site *site,
                            const crv__lanes_slice *s, vf x, vf z, vm there,
                            bool with_vectors)
{
    const vf r = vf_sqrt(x * x + z * z), cosine = z / r, sine = x / r;
    there = vm_and(there, vm_and(vf_lt(vf_zero(), x), vf_lt(r, vf_set(p->radius))));
    const vm above = vm_and(there, vf_lt(h->cosine, cosine));
    if (!vm_any(above))
        return;
    const vf open = crv__lanes_share(p, site, s, cosine, sine);
    const vf W = crv__lanes_falloff(p, r * vf_set(p->inv_radius));
    const vf gain = vf_max(h->open - open, vf_zero());
    h->occlusion = h->occlusion + vf_where(above, gain * W);
    h->cosine = vf_select(above, cosine, h->cosine);
    h->open = vf_select(above, vf_min(h->open, open), h->open);
    h->weight = vf_select(above, W, h->weight);
    if (with_vectors)
        add_vector(h, crv__lanes_vector(p, site->a, s->b, cosine, sine), W, above);
}

CRV__INLINE crv__lanes_vectors vectors_of(const horizon *h, const crv__params *p,
                                          crv__v2 all)
{
    crv__v2 K = h->blocked;
    if (p->attenuation == CRV_ATTENUATION_HORIZON)
        K = (crv__v2){(all.T - h->vector.T) * h->weight,
                      (all.V - h->vector.V) * h->weight};
    return (crv__lanes_vectors){.open = {all.T - K.T, all.V - K.V}, .blocked = K};
}

CRV__INLINE vf blocked_share(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                             const crv__lanes_site *site, const crv__lanes_slice *s,
                             crv__lanes_vectors *vectors)
{
    const crv__params *p = f->params;
    const vf zero = vf_zero();
    const crv__v2 all =
        crv__lanes_vector(p, site->a, s->b, s->cos_tangent, s->sin_tangent);
    horizon h = {s->cos_tangent, vf_set(1), zero, zero, all, {zero, zero}};
    for (int32_t i = 0; i < p->steps; i++) {
        const crv__lanes_texel texel = crv__lanes_slice_texel(p, shape, at, s, i);
        for (int32_t layer = 0; layer < shape.layers; layer++) {
            const vf d = crv__lanes_slice_depth(f, shape, layer, &texel);
            vf x, z;
            crv__lanes_slice_point(p, shape, at, site, s, &texel, d, &x, &z);
            add_sample(&h, p, site, s, x, z, vf_lt(d, vf_set(INFINITY)), vectors);
        }
    }
    if (vectors)
        *vectors = vectors_of(&h, p, all);
    return p->attenuation == CRV_ATTENUATION_SLAB ? h.occlusion
                                                  : (vf_set(1) - h.open) * h.weight;
}

CRV__INLINE vf estimate(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                        crv__v3 *bent)
{
    return crv__lanes_slices_open(f, shape, at, blocked_share, bent);
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    return estimate(f, shape, at, NULL);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    return crv__slices_within(f, at);
}

CRV__ESTIMATE_KERNEL(gtao, 1)

CRV__BENT_KERNEL(gtao)
