/* SPDX-License-Identifier: MIT */
/*
 * methods/hbao.c in the fast structure.
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
    int32_t falloff, biased, horizon, orthographic, layers, paired, near;
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

static inline __attribute__((always_inline)) view view_of(const crv__fast_pixels *at,
                                                          shape s)
{
    const crv__params *p = at->frame->params;
    const vf one = vf_set(1), half = vf_set(0.5f), rx = at->ray_x, ry = at->ray_y;
    view w = {.params = p, .layer_pitch = at->fast->layer_pitch};
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
static inline __attribute__((always_inline)) void add_sample(
    slice *walk, const view *w, shape s, const crv__fast_sample *sample, vf depth,
    vf twice_along, vf tilt)
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
    const vf risen = s.biased ? vf_max(vf_where(valid, h), walk->horizon)
                              : vf_max_within(walk->horizon, h, squared, w->limit);
    const vf rise = risen - walk->horizon;
    if (s.falloff == CRV_FALLOFF_LINEAR && !s.horizon) {
        walk->occlusion = vf_fma(rise, distance, walk->occlusion); /* to be taken off */
    } else if (s.falloff != CRV_FALLOFF_NONE) {
        const vf W = crv__lanes_falloff(w->params, distance * w->inverse_radius);
        if (s.horizon)
            walk->weight = vf_select(vf_lt(walk->horizon, risen), W, walk->weight);
        else
            walk->occlusion = vf_fma(rise, W, walk->occlusion);
    }
    walk->horizon = risen;
}

/* The samples of one place, and of the one opposite to it. */
static inline __attribute__((always_inline)) void add_place(
    slice walks[2], const crv__fast_pixels *at, const view *w, shape s,
    const crv__fast_sample *sample, const crv__fast_place *place)
{
    const vf along =
        vf_fma(vf_set(sample->x2), at->ray_x, vf_set(sample->y2) * at->ray_y);
    const vf length2 =
        vf_fma(vf_set(sample->cosine2), w->F, vf_fma(vf_set(sample->sine2), w->G, w->E));
    const vf tilt =
        vf_fma(vf_set(sample->cosine), at->n.x, vf_set(sample->sine) * at->n.y)
        * vf_rsqrt_fair(length2);
    const float *from[2] = {crv__fast_from(at, place, 0, s.near),
                            crv__fast_from(at, place, 1, s.near)};
    for (int32_t layer = 0; layer < s.layers; layer++) {
        const ptrdiff_t skip = layer * w->layer_pitch;
        add_sample(&walks[0], w, s, sample, crv__fast_read(at, from[0] + skip), along,
                   tilt);
        if (s.paired)
            add_sample(&walks[1], w, s, sample, crv__fast_read(at, from[1] + skip),
                       -along, -tilt);
    }
}

/* The occlusion of a finished slice. */
static inline __attribute__((always_inline)) vf occlusion_of(const slice *walk, shape s)
{
    if (s.horizon)
        return s.falloff == CRV_FALLOFF_NONE ? walk->horizon
                                             : walk->horizon * walk->weight;
    return s.falloff == CRV_FALLOFF_NONE || s.falloff == CRV_FALLOFF_LINEAR
               ? walk->horizon
               : walk->occlusion;
}

static inline __attribute__((always_inline)) vf sum_of_walks(const crv__fast_pixels *at,
                                                             const crv__fast_list *list,
                                                             shape s)
{
    const crv__fast *fast = at->fast;
    const view w = view_of(at, s);
    const vf zero = vf_zero();
    slice walks[2] = {{zero, zero, zero}, {zero, zero, zero}};
    vf sum = zero;
    for (int32_t k = 0; k < fast->walks; k++) {
        const int32_t first = k * fast->steps, last = first + list->counts[k];
        for (int32_t i = 0; i < 1 + s.paired; i++) {
            walks[i].horizon = zero;
            if (s.falloff != CRV_FALLOFF_LINEAR || s.horizon)
                walks[i].occlusion = walks[i].weight = zero;
        }
        for (int32_t i = first; i < last; i++)
            add_place(walks, at, &w, s, &list->samples[i], &list->places[i]);
        for (int32_t i = 0; i < 1 + s.paired; i++)
            sum = sum + occlusion_of(&walks[i], s);
    }
    /* Linear: the rises less the rises times the distances. */
    if (s.falloff == CRV_FALLOFF_LINEAR && !s.horizon)
        for (int32_t i = 0; i < 1 + s.paired; i++)
            sum = sum - walks[i].occlusion * w.inverse_radius;
    return vf_set(1) - sum * vf_set(1.0f / (float)w.params->directions);
}

#define SHAPE(name, ...)                                                                 \
    static __attribute__((noinline)) vf name(const crv__fast_pixels *at,                 \
                                             const crv__fast_list *list)                 \
    {                                                                                    \
        return sum_of_walks(at, list, (shape){__VA_ARGS__});                             \
    }

SHAPE(linear, CRV_FALLOFF_LINEAR, 0, 0, 0, 1, 1, 0)
SHAPE(linear_near, CRV_FALLOFF_LINEAR, 0, 0, 0, 1, 1, 1)
SHAPE(hard, CRV_FALLOFF_NONE, 0, 0, 0, 1, 1, 0)
SHAPE(hard_near, CRV_FALLOFF_NONE, 0, 0, 0, 1, 1, 1)

/* Everything else. */
static __attribute__((noinline)) vf general(const crv__fast_pixels *at,
                                            const crv__fast_list *list)
{
    const crv__params *p = at->frame->params;
    return sum_of_walks(at, list,
                        (shape){p->falloff, p->sin_bias > 0,
                                p->attenuation == CRV_ATTENUATION_HORIZON,
                                p->orthographic, p->layers, at->fast->paired, 1});
}

static inline vf accessibility(const crv__fast_pixels *at, const crv__fast_list *list)
{
    const crv__params *p = at->frame->params;
    if (at->fast->paired && p->layers == 1 && !p->orthographic && !(p->sin_bias > 0)
        && p->attenuation == CRV_ATTENUATION_SLAB) {
        if (p->falloff == CRV_FALLOFF_LINEAR)
            return at->near ? linear_near(at, list) : linear(at, list);
        if (p->falloff == CRV_FALLOFF_NONE)
            return at->near ? hard_near(at, list) : hard(at, list);
    }
    return general(at, list);
}

CRV__FAST_KERNEL(hbao, .is_walk = true, .in_pairs = true, .on_grid = true, .fineness = 2)
