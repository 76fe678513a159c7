/* SPDX-License-Identifier: MIT */
/* methods/gtao.c in the deinterleaved structure. */
#include "cpu/kernels/slice_groups.h"

/* What the code is specialised by. */
typedef struct shape {
    int32_t layers;
    int32_t falloff; /* none: the last horizon says it all */
    bool orthographic, border;
} shape;

/* A slice so far: see the scalar code. */
typedef struct horizon {
    vf cosine, open, occlusion, weight;
    crv__v2 vector, blocked;
} horizon;

/* Where x and z are 0, the root is a NaN and nothing above. What is as far as the
 * background lies beyond the radius. */
CRV__INLINE void add_sample(horizon *h, const crv__slice_view *w,
                            const crv__group_slice *s, const crv__group_measure *m,
                            shape c, vf x, vf z, bool with_vectors)
{
    const crv__params *p = w->params;
    const vf zero = vf_zero();
    const vf squared = vf_fma(x, x, z * z), inverse = vf_rsqrt_fair(squared);
    const vf cosine = z * inverse, q = squared * inverse * w->inverse_radius;
    const vm above =
        vm_and(vf_lt(h->cosine, cosine), vm_and(vf_lt(zero, x), vf_lt(q, vf_set(1))));
    if (c.falloff == CRV_FALLOFF_NONE) {
        h->cosine = vf_select(above, cosine, h->cosine);
        return;
    }
    const vf share = crv__group_share(m, cosine, x * inverse);
    const vf open = vf_min(vf_max(share, zero), h->open);
    const vf W =
        c.falloff == CRV_FALLOFF_LINEAR ? vf_set(1) - q : crv__lanes_falloff(p, q);
    h->occlusion =
        vf_select(above, vf_fma(h->open - open, W, h->occlusion), h->occlusion);
    h->open = vf_select(above, open, h->open);
    if (p->attenuation == CRV_ATTENUATION_HORIZON)
        h->weight = vf_select(above, W, h->weight);
    h->cosine = vf_select(above, cosine, h->cosine);
    if (with_vectors) {
        const crv__v2 v = crv__lanes_vector(p, w->a, s->b, cosine, x * inverse);
        const vf gain = vf_where(above, W);
        h->blocked.T = vf_fma(h->vector.T - v.T, gain, h->blocked.T);
        h->blocked.V = vf_fma(h->vector.V - v.V, gain, h->blocked.V);
        h->vector.T = vf_select(above, v.T, h->vector.T);
        h->vector.V = vf_select(above, v.V, h->vector.V);
    }
}

/* What the slice's vectors are then. all: of the whole slice. */
CRV__INLINE crv__lanes_vectors vectors_of(const horizon *h, const crv__params *p, shape c,
                                          crv__v2 all)
{
    const vf one = vf_set(1);
    crv__v2 K = h->blocked;
    const bool is_hard = c.falloff == CRV_FALLOFF_NONE;
    if (is_hard || p->attenuation == CRV_ATTENUATION_HORIZON) {
        const vf W = is_hard ? one : h->weight;
        K = (crv__v2){(all.T - h->vector.T) * W, (all.V - h->vector.V) * W};
    }
    return (crv__lanes_vectors){.open = {all.T - K.T, all.V - K.V}, .blocked = K};
}

/* The blocked share of a slice. */
CRV__INLINE vf blocked_share(const crv__group_pixels *at, const crv__list *list,
                             const crv__slice_view *w, const crv__group_slice *s, shape c,
                             int32_t k, crv__lanes_vectors *vectors)
{
    const vf zero = vf_zero(), one = vf_set(1);
    const crv__v2 all =
        crv__lanes_vector(w->params, w->a, s->b, s->cos_tangent, s->sin_tangent);
    const int32_t first = k * at->di->steps, last = first + list->counts[k];
    const crv__group_measure m = crv__group_measure_of(w, s, 1);
    const vf half_x = vf_fma(s->minus_b_over_a, s->half_Tx, w->half_nx),
             half_y = vf_fma(s->minus_b_over_a, s->half_Ty, w->half_ny);
    horizon h = {s->cos_tangent, one, zero, zero, all, {zero, zero}};
    for (int32_t i = first; i < last; i++) {
        for (int32_t layer = 0; layer < c.layers; layer++) {
            const vf d = crv__group_slice_depth(at, &list->places[i], layer, c.border);
            vf x, z;
            crv__group_slice_point(w, s, half_x, half_y, &list->samples[i], d,
                                   c.orthographic, &x, &z);
            add_sample(&h, w, s, &m, c, x, z, vectors);
        }
    }
    if (c.falloff == CRV_FALLOFF_NONE) {
        const vf rest = vf_max(vf_fma(-h.cosine, h.cosine, one), vf_set(1e-30f));
        const vf sine = rest * vf_rsqrt_fair(rest);
        const vf share = crv__group_share(&m, h.cosine, sine);
        h.vector = crv__lanes_vector(w->params, w->a, s->b, h.cosine, sine);
        if (vectors)
            *vectors = vectors_of(&h, w->params, c, all);
        return one - vf_clamp01(share);
    }
    if (vectors)
        *vectors = vectors_of(&h, w->params, c, all);
    return w->params->attenuation == CRV_ATTENUATION_SLAB ? h.occlusion
                                                          : (one - h.open) * h.weight;
}

CRV__INLINE void blocked_shares(const crv__group_pixels *at, const crv__list *list,
                                const crv__slice_view *w, const crv__group_slice *s,
                                shape c, int32_t first, int32_t count, vf *shares,
                                crv__lanes_vectors *vectors)
{
    for (int32_t k = 0; k < count; k++)
        shares[k] =
            blocked_share(at, list, w, &s[k], c, crv__group_slice_number(at, first + k),
                          vectors ? &vectors[k] : NULL);
}

CRV__SLICES_SUMMED

CRV__SLICE_SHAPE(hard, .layers = 1, .falloff = CRV_FALLOFF_NONE)
CRV__SLICE_SHAPE(hard_border, .layers = 1, .falloff = CRV_FALLOFF_NONE, .border = true)
CRV__SLICE_SHAPE(linear, .layers = 1, .falloff = CRV_FALLOFF_LINEAR)
CRV__SLICE_SHAPE(linear_border, .layers = 1, .falloff = CRV_FALLOFF_LINEAR,
                 .border = true)
CRV__SLICE_BENT_SHAPE(hard_bent, .layers = 1, .falloff = CRV_FALLOFF_NONE)
CRV__SLICE_BENT_SHAPE(hard_border_bent, .layers = 1, .falloff = CRV_FALLOFF_NONE,
                      .border = true)
CRV__SLICE_BENT_SHAPE(linear_bent, .layers = 1, .falloff = CRV_FALLOFF_LINEAR)

CRV__INLINE shape general_shape(const crv__params *p)
{
    return (shape){.layers = p->layers,
                   .falloff = p->falloff,
                   .orthographic = p->orthographic,
                   .border = true};
}

/* Everything else. */
CRV__NOINLINE vf general(const crv__group_pixels *at, const crv__list *list)
{
    return sum_of_slices(at, list, general_shape(at->frame->params), NULL);
}

CRV__NOINLINE vf general_bent(const crv__group_pixels *at, const crv__list *list,
                              crv__v3 *bent)
{
    return sum_of_slices(at, list, general_shape(at->frame->params), bent);
}

CRV__INLINE vf accessibility(const crv__group_pixels *at, const crv__list *list)
{
    const crv__params *p = at->frame->params;
    const bool is_common = p->layers == 1 && !p->orthographic;
    if (is_common && p->falloff == CRV_FALLOFF_NONE)
        return at->at_border ? hard_border(at, list) : hard(at, list);
    if (is_common && p->falloff == CRV_FALLOFF_LINEAR)
        return at->at_border ? linear_border(at, list) : linear(at, list);
    return general(at, list);
}

CRV__INLINE vf estimate(const crv__group_pixels *at, const crv__list *list, crv__v3 *bent)
{
    const crv__params *p = at->frame->params;
    const bool is_common = p->layers == 1 && !p->orthographic;
    if (is_common && p->falloff == CRV_FALLOFF_NONE)
        return at->at_border ? hard_border_bent(at, list, bent)
                             : hard_bent(at, list, bent);
    if (is_common && p->falloff == CRV_FALLOFF_LINEAR && !at->at_border)
        return linear_bent(at, list, bent);
    return general_bent(at, list, bent);
}

CRV__DEINTERLEAVED_BENT

CRV__DEINTERLEAVED_KERNEL(gtao, .run_bent = run_bent, .in_slices = true, .jittered = true,
                          .far_on_grid = true, .fineness = 2)
