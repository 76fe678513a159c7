/* SPDX-License-Identifier: MIT */
/* methods/gtao.c in the deinterleaved structure. */
#include "cpu/kernels/slice_groups.h"

/* What the code is specialised by. */
typedef struct shape {
    int32_t layers;
    bool hard; /* no falloff: the last horizon says it all */
    bool orthographic, border;
} shape;

/* A slice so far: see the scalar code. */
typedef struct horizon {
    vf cosine, open, occlusion, weight;
} horizon;

/* Where x and z are 0, the root is a NaN and nothing above. What is as far as the
 * background lies beyond the radius. */
CRV__INLINE void add_sample(horizon *h, const crv__slice_view *w,
                            const crv__group_slice *s, shape c, vf x, vf z)
{
    const crv__params *p = w->params;
    const vf zero = vf_zero();
    const vf squared = vf_fma(x, x, z * z), inverse = vf_rsqrt_fair(squared);
    const vf cosine = z * inverse, q = squared * inverse * w->inverse_radius;
    const vm above =
        vm_and(vf_lt(h->cosine, cosine), vm_and(vf_lt(zero, x), vf_lt(q, vf_set(1))));
    if (c.hard) {
        h->cosine = vf_select(above, cosine, h->cosine);
        return;
    }
    const vf measure = crv__lanes_measure(p, w->a, s->b, cosine, x * inverse);
    const vf open = vf_min(vf_max(measure * s->inverse, zero), h->open);
    const vf W = crv__lanes_falloff(p, q);
    h->occlusion =
        vf_select(above, vf_fma(h->open - open, W, h->occlusion), h->occlusion);
    h->open = vf_select(above, open, h->open);
    if (p->attenuation == CRV_ATTENUATION_HORIZON)
        h->weight = vf_select(above, W, h->weight);
    h->cosine = vf_select(above, cosine, h->cosine);
}

/* The blocked share of a slice. */
CRV__INLINE vf blocked_share(const crv__group_pixels *at, const crv__list *list,
                             const crv__slice_view *w, const crv__group_slice *s, shape c,
                             int32_t k)
{
    const vf zero = vf_zero(), one = vf_set(1);
    const int32_t first = k * at->di->steps, last = first + list->counts[k];
    horizon h = {s->cos_tangent, one, zero, zero};
    for (int32_t i = first; i < last; i++) {
        for (int32_t layer = 0; layer < c.layers; layer++) {
            const vf d = crv__group_slice_depth(at, &list->places[i], layer, c.border);
            vf x, z;
            crv__group_slice_point(w, s, &list->samples[i], d, c.orthographic, &x, &z);
            add_sample(&h, w, s, c, x, z);
        }
    }
    if (c.hard) {
        const vf rest = vf_max(vf_fma(-h.cosine, h.cosine, one), vf_set(1e-30f));
        const vf sine = rest * vf_rsqrt_fair(rest);
        const vf measure = crv__lanes_measure(w->params, w->a, s->b, h.cosine, sine);
        return one - vf_clamp01(measure * s->inverse);
    }
    return w->params->attenuation == CRV_ATTENUATION_SLAB ? h.occlusion
                                                          : (one - h.open) * h.weight;
}

CRV__SLICES_SUMMED

CRV__SLICE_SHAPE(hard, .layers = 1, .hard = true)
CRV__SLICE_SHAPE(hard_border, .layers = 1, .hard = true, .border = true)
CRV__SLICE_SHAPE(soft, .layers = 1)
CRV__SLICE_SHAPE(soft_border, .layers = 1, .border = true)

/* Everything else. */
CRV__NOINLINE vf general(const crv__group_pixels *at, const crv__list *list)
{
    const crv__params *p = at->frame->params;
    return sum_of_slices(
        at, list,
        (shape){.layers = p->layers, .orthographic = p->orthographic, .border = true});
}

CRV__INLINE vf accessibility(const crv__group_pixels *at, const crv__list *list)
{
    const crv__params *p = at->frame->params;
    if (p->layers > 1 || p->orthographic)
        return general(at, list);
    if (p->falloff == CRV_FALLOFF_NONE)
        return at->at_border ? hard_border(at, list) : hard(at, list);
    return at->at_border ? soft_border(at, list) : soft(at, list);
}

CRV__DEINTERLEAVED_KERNEL(gtao, .in_slices = true, .jittered = true, .far_on_grid = true,
                          .fineness = 2)
