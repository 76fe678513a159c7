/* SPDX-License-Identifier: MIT */
/*
 * methods/bitmask.c in the deinterleaved structure, for one layer. What is as far as the
 * background is so far below everything that the next surface begins a run.
 */
#include "cpu/kernels/sectors.h"
#include "cpu/kernels/slice_groups.h"

/* What the code is specialised by. falloff: NONE, every sector weighs the same; LINEAR;
 * or any other, which is then looked up. */
typedef struct shape {
    int32_t rule, falloff;
    bool orthographic, border;
} shape;

/* A slice so far: see the scalar code. Linear: `occlusion` is what the sectors' distances
 * take off, in units of the radius' inverse. */
typedef struct sectors {
    vi mask;
    vf occlusion, start;
    vf last;            /* climb of the sample before */
    vf blocked[GROUPS]; /* with bent normals, if sectors weigh differently */
} sectors;

/* The sector limit at or above the direction that these are the cosine and sine of:
 * 32 u - zeta rounded up. */
CRV__INLINE vi limit_of(const crv__group_measure *places, vf cosine, vf sine)
{
    return vi_max(vi_ceil(crv__group_share(places, cosine, sine)), vi_set(0));
}

/*
 * A front at x, h over the tangent along V, rises over it by an angle delta. It blocks no
 * sector if it leaves less than Ft (1 - zeta)/32 of the measure below it, which is
 *
 *     cosine:   at most |(a, b)| (1 - cos delta) < |(a, b)| tan^2(delta)/2
 *     uniform:  at most delta < tan(delta)
 *
 * With t the tangent for which these bounds are that much, and since
 * tan(delta) = h/(x (1 + (b/a)^2) - h b/a), no sector is blocked if h < rise x,
 *
 *     rise = t (1 + (b/a)^2)/(1 + t b/a)
 */
CRV__INLINE vf least_rise(const crv__slice_view *w, const crv__group_slice *s,
                          float offset)
{
    const vf one = vf_set(1), bound = s->total * vf_set((1 - offset) / SECTORS);
    vf t = bound;
    if (w->params->weighting == CRV_WEIGHTING_COSINE) {
        const vf squared = vf_set(2) * bound * s->sin_tangent * w->inverse_a;
        t = squared * vf_rsqrt_fair(squared);
    }
    const vf whole = vf_fma(s->minus_b_over_a, s->minus_b_over_a, one);
    return vf_set(0.998f) * t * whole * vf_rcp_rough(vf_fma(-t, s->minus_b_over_a, one));
}

CRV__INLINE void add_groups(sectors *to, vf weight, vi bits)
{
    const vi counts = crv__group_counts(bits);
    for (int32_t g = 0; g < GROUPS; g++)
        to->blocked[g] = vf_fma(weight, crv__group_count(counts, g), to->blocked[g]);
}

/* Where the map's values at a sample are, if it is on the picture. */
CRV__INLINE const float *width_place(const crv__group_pixels *at,
                                     const crv__sample_place *place)
{
    return at->own + place->offset[0] + at->frame->params->layers * at->di->layer_pitch;
}

/* The map's values at a sample. */
CRV__INLINE vf width_at(const crv__group_pixels *at, const crv__sample_place *place,
                        int border)
{
    const crv__frame *f = at->frame;
    const crv__params *p = f->params;
    if (!border || crv__group_slice_is_inside(at, place))
        return crv__sample_depth(at, width_place(at, place));
    const ptrdiff_t skip = p->layers * at->di->layer_pitch;
    const vf width = crv__sample_depth(at, crv__sample_at(at, place, 0, border) + skip);
    if (p->border == CRV_BORDER_BACKGROUND)
        return width;
    const crv__group_spot spot = crv__group_spot_at(at, place);
    return vf_select(spot.off, crv__group_nearest(at, f->map, skip, &spot), width);
}

/* run: how far along the slice the sample's surface has been seen. */
CRV__INLINE vf thickness_of(const crv__slice_view *w, shape c, vf run, vf width)
{
    const vf least = vf_set(0.1f) * w->radius;
    if (c.rule == CRV_THICKNESS_RUN)
        return vf_max(run + run, least);
    if (c.rule == CRV_THICKNESS_WIDTH)
        return vf_max(vf_min(vf_set(2.5f) * run, width * w->scale), least);
    return vf_set(w->params->thickness) * w->scale;
}

/* Weighs the bits that are new, of `count` that the body has; any number of none. */
CRV__INLINE void weigh(sectors *to, const crv__slice_view *w, shape c, vf x, vf z,
                       vi bits, vi count, bool with_vectors)
{
    const vi new_bits = bits & ~to->mask;
    const vf added = vf_of(vi_count_bits(new_bits));
    const vf squared = vf_fma(x, x, z * z);
    const vf r = vf_min(squared * vf_rsqrt_fair(squared), w->radius);
    const vf share = added * vi_rcp(count);
    const vf middle = vf_fma(vf_set(-0.7f) * (r - x), share, r);
    const bool is_linear = c.falloff == CRV_FALLOFF_LINEAR;
    if (is_linear)
        to->occlusion = vf_fma(middle, added, to->occlusion);
    if (is_linear && !with_vectors)
        return;
    const vf q = vf_min(middle * w->inverse_radius, vf_set(CRV__BELOW_ONE));
    const vf W = crv__lanes_falloff(w->params, q);
    if (!is_linear)
        to->occlusion = vf_fma(W, added, to->occlusion);
    if (with_vectors)
        add_groups(to, W, new_bits);
}

/* What a slice's bodies are measured by. */
typedef struct scale {
    crv__group_measure places;
    vf rise; /* least_rise() */
} scale;

/* Samples some lanes of which see something above their tangent. Those of all slices are
 * collected before any is added: that takes long, and few branches. */
enum { MOST_STEPS = 16, MOST_RISEN = MOST_STEPS * CRV__SLICES_AT_ONCE };

typedef struct risen {
    vf x, height; /* over the tangent, along V */
    vf run;       /* how far along the slice its surface has been seen */
    vf width;     /* at borders, where it is costly to find again */
    int32_t index, slice;
} risen;

CRV__INLINE vf width_of(const crv__group_pixels *at, const crv__list *list, shape c,
                        const risen *r)
{
    if (c.rule != CRV_THICKNESS_WIDTH)
        return vf_zero();
    return c.border ? r->width : width_at(at, &list->places[r->index], false);
}

/* Adds the body whose front is seen at a sample's point. */
CRV__INLINE void add_body(sectors *to, const crv__group_pixels *at, const crv__list *list,
                          const crv__slice_view *w, const crv__group_slice *s,
                          const crv__group_measure *places, shape c, const risen *r,
                          bool with_vectors)
{
    const crv__sample *sample = &list->samples[r->index];
    const vf zero = vf_zero(), x = r->x;
    const vf thickness = thickness_of(w, c, r->run, width_of(at, list, c, r));
    const vf front_x = x * vf_set(sample->front), back_x = x * vf_set(sample->far);
    const vf rest = vf_max(vf_fma(-front_x, front_x, w->radius2), vf_set(1e-30f));
    const vf end = rest * vf_rsqrt_fair(rest);
    const vf z = vf_fma(s->minus_b_over_a, x, r->height);
    const vf front_z = vf_min(vf_fma(s->minus_b_over_a, front_x, r->height), end);
    const vf back_z = vf_max(z - thickness, zero - end);
    const vf front_inverse = vf_rsqrt_fair(vf_fma(front_x, front_x, front_z * front_z));
    const vf back_inverse = vf_rsqrt_fair(vf_fma(back_x, back_x, back_z * back_z));
    const vf front_cosine = front_z * front_inverse, back_cosine = back_z * back_inverse;
    const vm there = vm_and(vm_and(vf_lt(zero, x), vf_lt(back_z, front_z)),
                            vf_lt(s->cos_tangent, front_cosine));
    const vi first = limit_of(places, front_cosine, front_x * front_inverse),
             back = limit_of(places, back_cosine, back_x * back_inverse);
    const vi last = vi_select(vf_lt(s->cos_tangent, back_cosine),
                              vi_min(back, vi_set(SECTORS)), vi_set(SECTORS));
    const vi bits = vi_select(there, vi_from_bit(first) & ~vi_from_bit(last), vi_set(0));
    if (c.falloff != CRV_FALLOFF_NONE)
        weigh(to, w, c, x, z, bits, last - first, with_vectors);
    to->mask = to->mask | bits;
}

/* Collects those of samples `first` to last - 1 of slice k. */
CRV__INLINE risen *collect(risen *to, sectors *so_far, const crv__group_pixels *at,
                           const crv__list *list, const crv__slice_view *w,
                           const crv__group_slice *s, vf rise, shape c, int32_t k,
                           int32_t first, int32_t last)
{
    const vf steep = s->minus_b_over_a - vf_set(16);
    vf start = so_far->start, last_climb = so_far->last;
    for (int32_t i = first; i < last; i++) {
        const crv__sample *sample = &list->samples[i];
        const crv__sample_place *place = &list->places[i];
        const vf d = crv__group_slice_depth(at, place, 0, c.border);
        vf x, height;
        crv__group_slice_point(w, s, w->half_nx, w->half_ny, sample, d, c.orthographic,
                               &x, &height);
        const vf climb = vf_fma(steep, x, height); /* z - 16 x */
        start = vf_select(vf_lt(last_climb, climb), x, start);
        last_climb = climb;
        to->x = x;
        to->height = height;
        to->run = x - start;
        if (c.rule == CRV_THICKNESS_WIDTH && c.border) {
            to->width = width_at(at, place, true);
        } else if (c.rule == CRV_THICKNESS_WIDTH) {
            __builtin_prefetch(width_place(at, place)); /* its body may follow */
            __builtin_prefetch(width_place(at, place) + 15);
        }
        to->index = i;
        to->slice = k;
        to += vm_any(vf_lt(x * vf_set(sample->front) * rise, height)) ? 1 : 0;
    }
    so_far->start = start;
    so_far->last = last_climb;
    return to;
}

/* The blocked share of a slice, and its bent normal's part. */
CRV__INLINE vf share_of(const sectors *found, const crv__slice_view *w,
                        const crv__group_slice *s, shape c, crv__lanes_vectors *vectors)
{
    const vf count = vf_of(vi_count_bits(found->mask));
    if (vectors)
        *vectors = crv__group_vectors(w->params, s->cos_tangent, s->sin_tangent, s->total,
                                      found->blocked);
    vf occlusion = found->occlusion;
    if (c.falloff == CRV_FALLOFF_NONE)
        occlusion = count;
    else if (c.falloff == CRV_FALLOFF_LINEAR)
        occlusion = vf_fma(-occlusion, w->inverse_radius, count);
    return occlusion * vf_set(1.0f / SECTORS);
}

CRV__INLINE void blocked_shares(const crv__group_pixels *at, const crv__list *list,
                                const crv__slice_view *w, const crv__group_slice *s,
                                shape c, int32_t first, int32_t count, vf *shares,
                                crv__lanes_vectors *vectors)
{
    const vf zero = vf_zero();
    sectors found[CRV__SLICES_AT_ONCE];
    scale scales[CRV__SLICES_AT_ONCE];
    for (int32_t k = 0; k < count; k++) {
        const int32_t number = crv__group_slice_number(at, first + k);
        float offset = w->noise->sector_offset + 0.754878f * (float)number;
        offset -= (float)(int32_t)offset;
        scales[k].places = crv__group_measure_of(w, &s[k], SECTORS);
        scales[k].places.whole = scales[k].places.whole - vf_set(offset);
        scales[k].rise = least_rise(w, &s[k], offset);
        found[k].mask = vi_set(0);
        found[k].occlusion = found[k].start = found[k].last = zero;
        for (int32_t g = 0; vectors && g < GROUPS; g++)
            found[k].blocked[g] = zero;
    }
    for (int32_t i = 0; i < at->di->steps; i += MOST_STEPS) {
        risen all[MOST_RISEN], *end_of_all = all;
        for (int32_t k = 0; k < count; k++) {
            const int32_t number = crv__group_slice_number(at, first + k),
                          begin = number * at->di->steps,
                          end = begin + list->counts[number], to = begin + i + MOST_STEPS;
            end_of_all = collect(end_of_all, &found[k], at, list, w, &s[k],
                                 scales[k].rise, c, k, begin + i, to < end ? to : end);
        }
        for (const risen *r = all; r < end_of_all; r++)
            add_body(&found[r->slice], at, list, w, &s[r->slice],
                     &scales[r->slice].places, c, r, vectors);
    }
    for (int32_t k = 0; k < count; k++) {
        if (vectors && c.falloff == CRV_FALLOFF_NONE)
            add_groups(&found[k], vf_set(1), found[k].mask);
        shares[k] = share_of(&found[k], w, &s[k], c, vectors ? &vectors[k] : NULL);
    }
}

CRV__SLICES_SUMMED

#define SHAPES(name, ...)                                                                \
    CRV__SLICE_SHAPE(name, __VA_ARGS__)                                                  \
    CRV__SLICE_SHAPE(name##_border, .border = true, __VA_ARGS__)

SHAPES(hard, .rule = CRV_THICKNESS_WIDTH, .falloff = CRV_FALLOFF_NONE)
SHAPES(linear, .rule = CRV_THICKNESS_WIDTH, .falloff = CRV_FALLOFF_LINEAR)
SHAPES(hard_run, .rule = CRV_THICKNESS_RUN, .falloff = CRV_FALLOFF_NONE)
SHAPES(linear_run, .rule = CRV_THICKNESS_RUN, .falloff = CRV_FALLOFF_LINEAR)

CRV__SLICE_BENT_SHAPE(hard_bent, .rule = CRV_THICKNESS_WIDTH, .falloff = CRV_FALLOFF_NONE)
CRV__SLICE_BENT_SHAPE(linear_bent, .rule = CRV_THICKNESS_WIDTH,
                      .falloff = CRV_FALLOFF_LINEAR)

CRV__INLINE shape general_shape(const crv__params *p)
{
    return (shape){.rule = p->thickness_rule,
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
    const bool is_width = p->thickness_rule == CRV_THICKNESS_WIDTH,
               is_run = p->thickness_rule == CRV_THICKNESS_RUN,
               is_hard = p->falloff == CRV_FALLOFF_NONE,
               is_linear = p->falloff == CRV_FALLOFF_LINEAR;
    if (p->orthographic)
        return general(at, list);
    if (is_width && is_linear)
        return at->at_border ? linear_border(at, list) : linear(at, list);
    if (is_width && is_hard)
        return at->at_border ? hard_border(at, list) : hard(at, list);
    if (is_run && is_linear)
        return at->at_border ? linear_run_border(at, list) : linear_run(at, list);
    if (is_run && is_hard)
        return at->at_border ? hard_run_border(at, list) : hard_run(at, list);
    return general(at, list);
}

CRV__INLINE vf estimate(const crv__group_pixels *at, const crv__list *list, crv__v3 *bent)
{
    const crv__params *p = at->frame->params;
    const bool is_common =
        !p->orthographic && !at->at_border && p->thickness_rule == CRV_THICKNESS_WIDTH;
    if (is_common && p->falloff == CRV_FALLOFF_LINEAR)
        return linear_bent(at, list, bent);
    if (is_common && p->falloff == CRV_FALLOFF_NONE)
        return hard_bent(at, list, bent);
    return general_bent(at, list, bent);
}

CRV__DEINTERLEAVED_BENT

CRV__DEINTERLEAVED_KERNEL(bitmask, .run_bent = run_bent, .in_slices = true,
                          .jittered = true, .far_on_grid = true, .one_layer = true,
                          .fineness = 2)
