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
    vf last;            /* z - 16 x of the sample before */
    vf blocked[GROUPS]; /* with bent normals, if sectors weigh differently */
} sectors;

/* 32 u - zeta in the direction that these are the cosine and sine of, from 0 to 32. */
CRV__INLINE vf place_of(const crv__group_measure *places, vf cosine, vf sine)
{
    const vf place = crv__group_share(places, cosine, sine);
    return vf_min(vf_max(place, vf_zero()), vf_set(SECTORS));
}

/*
 * `flat` of a slice. A front that rises over the tangent by an angle delta has at most
 *
 *     cosine:   |(a, b)| (1 - cos delta) < |(a, b)| sin^2(delta)/1.9
 *     uniform:  delta < 1.1 sin(delta)
 *
 * of the measure below it, with sin(delta) = h a/(|(a, b)| r), h its height over the
 * tangent along V. It blocks no sector if that is less than Ft (1 - zeta)/32, for which
 * flat h^2 < r^2 suffices. Tangents by which delta may be obtuse get no such limit.
 */
CRV__INLINE vf flatness(const crv__slice_view *w, const crv__group_slice *s, float offset)
{
    const vf share = s->inverse * vf_set(1.2f * SECTORS / (1 - offset));
    const bool is_uniform = w->params->weighting == CRV_WEIGHTING_UNIFORM;
    const vf limit = is_uniform ? s->sin_tangent * share * (s->sin_tangent * share)
                                : s->sin_tangent * w->a * share * vf_set(0.5f);
    return vf_select(vf_lt(s->cos_tangent, vf_set(-0.9f)), vf_set(1e30f), limit);
}

CRV__INLINE void add_groups(sectors *to, vf weight, vi bits)
{
    const vi counts = crv__group_counts(bits);
    for (int32_t g = 0; g < GROUPS; g++)
        to->blocked[g] = vf_fma(weight, crv__group_count(counts, g), to->blocked[g]);
}

/* The map's values at a sample. */
CRV__INLINE vf width_at(const crv__group_pixels *at, const crv__sample_place *place,
                        int border)
{
    const crv__frame *f = at->frame;
    const crv__params *p = f->params;
    const ptrdiff_t skip = p->layers * at->di->layer_pitch;
    if (!border || crv__group_slice_is_inside(at, place))
        return crv__sample_depth(at, at->own + place->offset[0] + skip);
    const vf width = crv__sample_depth(at, crv__sample_at(at, place, 0, border) + skip);
    if (p->border == CRV_BORDER_BACKGROUND)
        return width;
    const vi zero = vi_set(0), right = vi_set(p->width - 1),
             bottom = vi_set(p->height - 1);
    const vi u = at->x + vi_set(place->du), v = vi_set(at->y + place->dv);
    const vm on = vm_and(vi_below(u, vi_set(p->width)), vi_below(v, vi_set(p->height)));
    const vm off = vm_not(on);
    if (!vm_any(off))
        return width;
    const vi x = vi_select(vi_lt(u, zero), zero, vi_select(vi_lt(right, u), right, u));
    const vi y = vi_select(vi_lt(v, zero), zero, vi_select(vi_lt(bottom, v), bottom, v));
    const vf border_width = vf_gather(f->map->data, crv__lanes_index(f->map, x, y), off);
    return vf_select(off, border_width, width);
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

/* Weighs the bits that are new. bits: the body's; count: how many, or any number of none.
 */
CRV__INLINE void weigh(sectors *to, const crv__slice_view *w, shape c, vf x, vf z,
                       vi bits, vf count, bool with_vectors)
{
    const vi new_bits = bits & ~to->mask;
    const vf added = vf_of(vi_count_bits(new_bits));
    const vm is_new = vf_lt(vf_zero(), added);
    const vf squared = vf_fma(x, x, z * z);
    const vf r = vf_min(squared * vf_rsqrt_fair(squared), w->radius);
    const vf middle = vf_fma(vf_set(-0.7f) * (r - x), added * vf_rcp_rough(count), r);
    const bool is_linear = c.falloff == CRV_FALLOFF_LINEAR;
    if (is_linear)
        to->occlusion =
            vf_select(is_new, vf_fma(middle, added, to->occlusion), to->occlusion);
    if (is_linear && !with_vectors)
        return;
    const vf q = vf_min(middle * w->inverse_radius, vf_set(CRV__BELOW_ONE));
    const vf W = vf_where(is_new, crv__lanes_falloff(w->params, q));
    if (!is_linear)
        to->occlusion = vf_fma(W, added, to->occlusion);
    if (with_vectors)
        add_groups(to, W, new_bits);
}

/* Adds the body whose front is seen at a sample's point. */
CRV__INLINE void add_body(sectors *to, const crv__slice_view *w,
                          const crv__group_slice *s, const crv__group_measure *places,
                          shape c, const crv__sample *sample, vf x, vf z, vf thickness,
                          bool with_vectors)
{
    const vf zero = vf_zero();
    const vf front_x = x * vf_set(sample->front), back_x = x * vf_set(sample->far);
    const vf rest = vf_max(vf_fma(-front_x, front_x, w->radius2), vf_set(1e-30f));
    const vf end = rest * vf_rsqrt_fair(rest);
    const vf raised_z = vf_fma(s->b_over_a, x - front_x, z);
    const vf front_z = vf_min(raised_z, end), back_z = vf_max(z - thickness, zero - end);
    const vf front_inverse = vf_rsqrt_fair(vf_fma(front_x, front_x, front_z * front_z));
    const vf back_inverse = vf_rsqrt_fair(vf_fma(back_x, back_x, back_z * back_z));
    const vf front_cosine = front_z * front_inverse, back_cosine = back_z * back_inverse;
    const vm there = vm_and(vm_and(vf_lt(zero, x), vf_lt(back_z, front_z)),
                            vf_lt(s->cos_tangent, front_cosine));
    const vf front = place_of(places, front_cosine, front_x * front_inverse),
             back = place_of(places, back_cosine, back_x * back_inverse);
    const vi first = vi_ceil(front),
             last = vi_ceil(
                 vf_select(vf_lt(s->cos_tangent, back_cosine), back, vf_set(SECTORS)));
    const vi bits = vi_select(there, vi_from_bit(first) & ~vi_from_bit(last), vi_set(0));
    if (c.falloff != CRV_FALLOFF_NONE)
        weigh(to, w, c, x, z, bits, vf_of(last - first), with_vectors);
    to->mask = to->mask | bits;
}

/* Samples of a slice some lanes of which see something above their tangent. They are
 * collected before any is added: that takes long, and few branches. */
enum { MOST_RISEN = 16 };

typedef struct risen {
    vf x[MOST_RISEN], z[MOST_RISEN], thickness[MOST_RISEN];
    int32_t index[MOST_RISEN];
} risen;

/* Collects those of samples `first` to last - 1. Returns how many. */
CRV__INLINE int32_t collect(risen *r, sectors *so_far, const crv__group_pixels *at,
                            const crv__list *list, const crv__slice_view *w,
                            const crv__group_slice *s, vf flat, shape c, int32_t first,
                            int32_t last)
{
    int32_t count = 0;
    for (int32_t i = first; i < last; i++) {
        const crv__sample *sample = &list->samples[i];
        const crv__sample_place *place = &list->places[i];
        const vf d = crv__group_slice_depth(at, place, 0, c.border);
        const vf width =
            c.rule == CRV_THICKNESS_WIDTH ? width_at(at, place, c.border) : vf_zero();
        vf x, z;
        crv__group_slice_point(w, s, sample, d, c.orthographic, &x, &z);
        const vf climb = vf_fma(vf_set(-16), x, z);
        so_far->start = vf_select(vf_lt(so_far->last, climb), x, so_far->start);
        so_far->last = climb;
        const vf front_x = x * vf_set(sample->front);
        const vf height = vf_fma(s->b_over_a, x, z);
        const vf raised_z = vf_fma(-s->b_over_a, front_x, height);
        const vf squared = vf_fma(front_x, front_x, raised_z * raised_z);
        const vm rises = vm_and(vf_lt(vf_zero(), vf_min(x, height)),
                                vf_le(squared, flat * height * height));
        r->x[count] = x;
        r->z[count] = z;
        r->thickness[count] = thickness_of(w, c, x - so_far->start, width);
        r->index[count] = i;
        count += vm_any(rises) ? 1 : 0;
    }
    return count;
}

/* The blocked share of a slice. */
CRV__INLINE vf blocked_share(const crv__group_pixels *at, const crv__list *list,
                             const crv__slice_view *w, const crv__group_slice *s, shape c,
                             int32_t k, crv__lanes_vectors *vectors)
{
    const vf zero = vf_zero();
    const int32_t first = k * at->di->steps, last = first + list->counts[k];
    float offset = w->noise->sector_offset + 0.754878f * (float)k;
    offset -= (float)(int32_t)offset;
    crv__group_measure places = crv__group_measure_of(w, s, SECTORS);
    places.whole = places.whole - vf_set(offset);
    const vf flat = flatness(w, s, offset);
    sectors found = {.mask = vi_set(0), .occlusion = zero, .start = zero, .last = zero};
    for (int32_t g = 0; vectors && g < GROUPS; g++)
        found.blocked[g] = zero;
    for (int32_t i = first; i < last; i += MOST_RISEN) {
        const int32_t end = i + MOST_RISEN < last ? i + MOST_RISEN : last;
        risen r;
        const int32_t count = collect(&r, &found, at, list, w, s, flat, c, i, end);
        for (int32_t n = 0; n < count; n++) {
            add_body(&found, w, s, &places, c, &list->samples[r.index[n]], r.x[n], r.z[n],
                     r.thickness[n], vectors);
        }
    }
    if (vectors && c.falloff == CRV_FALLOFF_NONE)
        add_groups(&found, vf_set(1), found.mask);
    if (vectors)
        *vectors = crv__group_vectors(w->params, s->cos_tangent, s->sin_tangent, s->total,
                                      found.blocked);
    vf occlusion = found.occlusion;
    if (c.falloff == CRV_FALLOFF_NONE)
        occlusion = vf_of(vi_count_bits(found.mask));
    else if (c.falloff == CRV_FALLOFF_LINEAR)
        occlusion =
            vf_fma(-occlusion, w->inverse_radius, vf_of(vi_count_bits(found.mask)));
    return occlusion * vf_set(1.0f / SECTORS);
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
