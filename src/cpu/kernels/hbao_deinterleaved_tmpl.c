/* SPDX-License-Identifier: MIT */
/*
 * methods/hbao.c in the di structure.
 *
 * All is measured in units of the pixel's own depth d (perspective; orthographic: scene
 * units). With k = 1 - ds/d the sample is v = o - k (ray + o), so that
 * |v|^2 = k^2 (|ray|^2 + 2 ray.o + o.o) - 2 k (ray.o + o.o) + o.o, and v.z = k. The
 * tangent's length is a quadratic form in the unit offset, E + F cos 2 phi + G sin 2 phi.
 * What depends on the offset alone serves the opposite sample too, with ray.o and n.o of
 * the other sign.
 */
#include "cpu/kernels/groups.h"

/* What the code is specialised by. */
typedef struct shape {
    int32_t falloff, layers;
    bool biased, horizon, orthographic, paired, border;
} shape;

/* What does not change from sample to sample. */
typedef struct view {
    const crv__params *params;
    ptrdiff_t layer_pitch;
    vf scale, origin; /* k = origin - scale * ds */
    vf ray2;          /* |ray|^2 */
    vf limit;         /* radius^2 */
    vf inverse_radius;
    vf E, F, G;
} view;

typedef struct slice {
    vf horizon, occlusion, weight;
} slice;

CRV__INLINE view view_of(const crv__group_pixels *at, shape s)
{
    const crv__params *p = at->frame->params;
    const vf one = vf_set(1), half = vf_set(0.5f), rx = at->ray_x, ry = at->ray_y;
    view w = {.params = p, .layer_pitch = at->di->layer_pitch};
    w.scale = s.orthographic ? one : at->inverse;
    w.origin = s.orthographic ? at->depth : one;
    const vf inverse_unit = s.orthographic ? one : at->inverse;
    const vf radius = vf_set(p->radius) * inverse_unit;
    w.limit = radius * radius;
    w.inverse_radius = vf_set(p->inv_radius) * (s.orthographic ? one : at->depth);
    w.ray2 = vf_fma(rx, rx, vf_fma(ry, ry, one));
    const crv__v3 n = at->n;
    const vf facing = n.z - n.x * rx - n.y * ry, square = facing * facing;
    const vf twice = facing + facing;
    const vf A = vf_fma(n.x, vf_fma(n.x, w.ray2, twice * rx), square);
    const vf C = vf_fma(n.y, vf_fma(n.y, w.ray2, twice * ry), square);
    w.E = (A + C) * half;
    w.F = (A - C) * half;
    w.G = vf_fma(n.x, vf_fma(n.y, w.ray2, facing * ry), facing * n.y * rx);
    return w;
}

/* One surface point. twice_along: 2 ray.o; tilt: minus the sine of the tangent. */
CRV__INLINE void add_sample(slice *current, const view *w, shape s,
                            const crv__sample *sample, vf depth, vf twice_along, vf tilt)
{
    const vf k = vf_fma(-depth, w->scale, w->origin);
    const vf squared2 = vf_set(sample->squared);
    vf squared;
    if (s.orthographic)
        squared = vf_fma(k, k, squared2);
    else
        squared = vf_fma(k,
                         vf_fma(k, w->ray2 + squared2 + twice_along,
                                vf_set(sample->minus_squared2) - twice_along),
                         squared2);
    const vf inverse = vf_rsqrt_rough(squared), distance = squared * inverse;
    vm valid = vf_lt(squared, w->limit);
    if (s.biased) {
        const vf sin_bias = vf_set(w->params->sin_bias),
                 cos_bias = vf_set(w->params->cos_bias);
        const vf cosine = vf_sqrt(vf_max(vf_set(1) - tilt * tilt, vf_zero()));
        valid = vm_and(valid, vf_lt(vf_zero() - tilt * sin_bias, cosine * cos_bias));
        tilt = tilt * cos_bias - cosine * sin_bias;
    }
    const vf h = vf_fma(k, inverse, tilt);
    const vf risen = s.biased ? vf_max(vf_where(valid, h), current->horizon)
                              : vf_max_within(current->horizon, h, squared, w->limit);
    const vf rise = risen - current->horizon;
    if (s.falloff == CRV_FALLOFF_LINEAR && !s.horizon) {
        current->occlusion =
            vf_fma(rise, distance, current->occlusion); /* to be taken off */
    } else if (s.falloff != CRV_FALLOFF_NONE) {
        const vf W = crv__lanes_falloff(w->params, distance * w->inverse_radius);
        if (s.horizon)
            current->weight =
                vf_select(vf_lt(current->horizon, risen), W, current->weight);
        else
            current->occlusion = vf_fma(rise, W, current->occlusion);
    }
    current->horizon = risen;
}

/* The samples of one place, and of the one opposite to it. */
CRV__INLINE void add_place(slice pair[2], const crv__group_pixels *at, const view *w,
                           shape s, const crv__sample *sample,
                           const crv__sample_place *place)
{
    const vf along =
        vf_fma(vf_set(sample->x2), at->ray_x, vf_set(sample->y2) * at->ray_y);
    const vf length2 =
        vf_fma(vf_set(sample->cosine2), w->F, vf_fma(vf_set(sample->sine2), w->G, w->E));
    const vf tilt =
        vf_fma(vf_set(sample->cosine), at->n.x, vf_set(sample->sine) * at->n.y)
        * vf_rsqrt_fair(length2);
    const float *from[2] = {crv__sample_at(at, place, 0, s.border),
                            crv__sample_at(at, place, 1, s.border)};
    for (int32_t layer = 0; layer < s.layers; layer++) {
        const ptrdiff_t skip = layer * w->layer_pitch;
        add_sample(&pair[0], w, s, sample, crv__sample_depth(at, from[0] + skip), along,
                   tilt);
        if (s.paired)
            add_sample(&pair[1], w, s, sample, crv__sample_depth(at, from[1] + skip),
                       -along, -tilt);
    }
}

/* The occlusion of a finished slice. */
CRV__INLINE vf occlusion_of(const slice *current, shape s)
{
    if (s.horizon)
        return s.falloff == CRV_FALLOFF_NONE ? current->horizon
                                             : current->horizon * current->weight;
    return s.falloff == CRV_FALLOFF_NONE || s.falloff == CRV_FALLOFF_LINEAR
               ? current->horizon
               : current->occlusion;
}

CRV__INLINE vf sum_of_slices(const crv__group_pixels *at, const crv__list *list, shape s)
{
    const crv__deinterleaved *di = at->di;
    const view w = view_of(at, s);
    const vf zero = vf_zero();
    slice pair[2] = {{zero, zero, zero}, {zero, zero, zero}};
    vf sum = zero;
    for (int32_t k = 0; k < di->slices; k++) {
        const int32_t first = k * di->steps, last = first + list->counts[k];
        for (int32_t i = 0; i < 1 + s.paired; i++) {
            pair[i].horizon = zero;
            if (s.falloff != CRV_FALLOFF_LINEAR || s.horizon)
                pair[i].occlusion = pair[i].weight = zero;
        }
        for (int32_t i = first; i < last; i++)
            add_place(pair, at, &w, s, &list->samples[i], &list->places[i]);
        for (int32_t i = 0; i < 1 + s.paired; i++)
            sum = sum + occlusion_of(&pair[i], s);
    }
    /* Linear: the rises less the rises times the distances. */
    if (s.falloff == CRV_FALLOFF_LINEAR && !s.horizon)
        for (int32_t i = 0; i < 1 + s.paired; i++)
            sum = sum - pair[i].occlusion * w.inverse_radius;
    return vf_set(1) - sum * vf_set(1.0f / (float)w.params->directions);
}

#define SHAPE(name, ...)                                                                 \
    CRV__NOINLINE vf name(const crv__group_pixels *at, const crv__list *list)            \
    {                                                                                    \
        return sum_of_slices(at, list, (shape){__VA_ARGS__});                            \
    }

SHAPE(linear, .falloff = CRV_FALLOFF_LINEAR, .layers = 1, .paired = true)
SHAPE(linear_border, .falloff = CRV_FALLOFF_LINEAR, .layers = 1, .paired = true,
      .border = true)
SHAPE(hard, .falloff = CRV_FALLOFF_NONE, .layers = 1, .paired = true)
SHAPE(hard_border, .falloff = CRV_FALLOFF_NONE, .layers = 1, .paired = true,
      .border = true)

/* Everything else. */
CRV__NOINLINE vf general(const crv__group_pixels *at, const crv__list *list)
{
    const crv__params *p = at->frame->params;
    return sum_of_slices(at, list,
                         (shape){.falloff = p->falloff,
                                 .layers = p->layers,
                                 .biased = p->sin_bias > 0,
                                 .horizon = p->attenuation == CRV_ATTENUATION_HORIZON,
                                 .orthographic = p->orthographic,
                                 .paired = at->di->paired,
                                 .border = true});
}

CRV__INLINE vf accessibility(const crv__group_pixels *at, const crv__list *list)
{
    const crv__params *p = at->frame->params;
    if (at->di->paired && p->layers == 1 && !p->orthographic && !(p->sin_bias > 0)
        && p->attenuation == CRV_ATTENUATION_SLAB) {
        if (p->falloff == CRV_FALLOFF_LINEAR)
            return at->at_border ? linear_border(at, list) : linear(at, list);
        if (p->falloff == CRV_FALLOFF_NONE)
            return at->at_border ? hard_border(at, list) : hard(at, list);
    }
    return general(at, list);
}

CRV__DEINTERLEAVED_KERNEL(hbao, .in_slices = true, .in_pairs = true, .far_on_grid = true,
                          .fineness = 2)
