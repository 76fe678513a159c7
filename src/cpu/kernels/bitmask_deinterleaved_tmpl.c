/* SPDX-License-Identifier: MIT */
/*
 * methods/bitmask.c in the deinterleaved structure, for one layer. Places of sectors are
 * kept negative, -(32 u - zeta), so that rounding down rounds up. What is as far as the
 * background is so far below everything that the next surface begins a run.
 */
#include "cpu/kernels/sectors.h"
#include "cpu/kernels/slice_groups.h"

/* What the code is specialised by. */
typedef struct shape {
    int32_t rule;
    bool hard; /* no falloff: every sector weighs the same */
    bool orthographic, border;
} shape;

/* A slice so far: see the scalar code. */
typedef struct sectors {
    vi mask, count; /* count: of the mask's bits */
    vf occlusion, start, last_x, last_z;
    vf blocked[GROUPS]; /* with bent normals, if sectors weigh differently */
} sectors;

/* What the place of a point is computed from. */
typedef struct scale {
    vf a, b; /* -16 a / Ft and -16 b / Ft; uniform: b alone, -32 / Ft */
    vf offset;
    vf flat; /* see flatness() */
    int32_t uniform;
} scale;

CRV__INLINE vi first_from(const crv__group_slice *s, const scale *c, vf x, vf z)
{
    const vf one = vf_set(1), inverse = vf_rsqrt_fair(vf_fma(x, x, z * z));
    const vf cosine = z * inverse, sine = x * inverse;
    vf place;
    if (c->uniform) {
        place = vf_fma(c->b, one - cosine, c->offset);
    } else {
        vf Q = vf_fma(sine, vf_set(-0.20501906f), vf_set(0.60547927f));
        Q = vf_fma(sine, Q, vf_set(0.02568289f));
        Q = vf_fma(sine, Q, vf_set(1.57020562f));
        const vf angle = vf_fma(-cosine, Q, vf_set(1.57079633f));
        place = vf_fma(c->a * sine, sine, vf_fma(c->b, angle, c->offset));
    }
    const vf least = vf_set(-SECTORS);
    place = vf_select(vf_lt(s->cos_tangent, cosine), place, least);
    return vi_sub(vi_set(0), vi_floor(vf_min(vf_max(place, least), vf_zero())));
}

CRV__INLINE vf thickness_of(const sectors *so_far, const crv__slice_view *w, shape c,
                            vf x, vf width)
{
    const vf run = x - so_far->start, least = vf_set(0.1f) * w->radius;
    if (c.rule == CRV_THICKNESS_RUN)
        return vf_max(run + run, least);
    if (c.rule == CRV_THICKNESS_WIDTH)
        return vf_max(vf_min(vf_set(2.5f) * run, width * w->scale), least);
    return vf_set(w->params->thickness) * w->scale;
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
CRV__INLINE vf flatness(const crv__slice_view *w, const crv__group_slice *s, float offset,
                        int32_t uniform)
{
    const vf share = s->inverse * vf_set(1.2f * SECTORS / (1 - offset));
    const vf limit = uniform ? s->sin_tangent * share * (s->sin_tangent * share)
                             : s->sin_tangent * w->a * share * vf_set(0.5f);
    return vf_select(vf_lt(s->cos_tangent, vf_set(-0.9f)), vf_set(1e30f), limit);
}

CRV__INLINE void add_groups(sectors *to, vf weight, vi bits)
{
    const vi counts = crv__group_counts(bits);
    for (int32_t g = 0; g < GROUPS; g++)
        to->blocked[g] = vf_fma(weight, crv__group_count(counts, g), to->blocked[g]);
}

CRV__INLINE void add_sample(sectors *to, const crv__slice_view *w,
                            const crv__group_slice *s, const scale *places, shape c,
                            const crv__sample *sample, vf x, vf z, vf width,
                            bool with_vectors)
{
    const crv__params *p = w->params;
    const vf zero = vf_zero();
    const vm begins = vf_lt(vf_set(16) * (x - to->last_x), z - to->last_z);
    to->start = vf_select(begins, x, to->start);
    to->last_x = x;
    to->last_z = z;
    const vf part = vf_set(0.25f * (1 - sample->near)), front_x = vf_fma(-x, part, x);
    const vf height = vf_fma(s->b_over_a, x, z);
    const vf raised_z = vf_fma(-s->b_over_a, front_x, height);
    const vf front_squared = vf_fma(front_x, front_x, raised_z * raised_z);
    const vm rises = vm_and(vm_and(vf_lt(zero, x), vf_lt(zero, height)),
                            vf_le(front_squared, places->flat * height * height));
    if (!vm_any(rises))
        return; /* most of flat surfaces */
    const vf thickness = thickness_of(to, w, c, x, width);
    const vf back_x = x * vf_set(sample->far);
    const vf rest = vf_max(vf_fma(-front_x, front_x, w->radius2), vf_set(1e-30f));
    const vf end = rest * vf_rsqrt_fair(rest);
    const vf front_z = vf_min(raised_z, end);
    const vf back_z = vf_max(z - thickness, zero - end);
    const vm there = vm_and(rises, vf_lt(back_z, front_z));
    const vi front = vi_from_bit(first_from(s, places, front_x, front_z));
    const vi back = vi_from_bit(first_from(s, places, back_x, back_z));
    const vi bits = vi_select(there, front & ~back, vi_set(0)), before = to->mask;
    to->mask = before | bits;
    if (c.hard)
        return;
    const vi so_far = vi_count_bits(to->mask);
    const vf added = vf_of(so_far - to->count);
    to->count = so_far;
    const vf squared = vf_fma(x, x, z * z);
    const vf r = vf_min(squared * vf_rsqrt_fair(squared), w->radius);
    const vf count = vf_max(vf_of(vi_count_bits(bits)), vf_set(1));
    const vf middle = vf_fma(vf_set(-0.7f) * (r - x), added * vf_rcp(count), r);
    const vf q = vf_min(middle * w->inverse_radius, vf_set(CRV__BELOW_ONE));
    const vm counts = vf_lt(zero, added);
    const vf W = crv__lanes_falloff(p, q);
    to->occlusion = to->occlusion + vf_where(counts, W * added);
    if (with_vectors)
        add_groups(to, vf_where(counts, W), bits & ~before);
}

/* The map's values at a sample. */
CRV__INLINE vf width_at(const crv__group_pixels *at, const crv__sample_place *place,
                        int border)
{
    const crv__frame *f = at->frame;
    const crv__params *p = f->params;
    const float *from = crv__sample_at(at, place, 0, border);
    const vf width = crv__sample_depth(at, from + p->layers * at->di->layer_pitch);
    if (!border || p->border == CRV_BORDER_BACKGROUND)
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

/* The blocked share of a slice. */
CRV__INLINE vf blocked_share(const crv__group_pixels *at, const crv__list *list,
                             const crv__slice_view *w, const crv__group_slice *s, shape c,
                             int32_t k, crv__lanes_vectors *vectors)
{
    const vf zero = vf_zero();
    const int32_t first = k * at->di->steps, last = first + list->counts[k];
    float offset = w->noise->sector_offset + 0.754878f * (float)k;
    offset -= (float)(int32_t)offset;
    const int32_t uniform = w->params->weighting == CRV_WEIGHTING_UNIFORM;
    const scale places = {.a = vf_set(-0.5f * SECTORS) * w->a * s->inverse,
                          .b = uniform ? vf_set(-SECTORS) * s->inverse
                                       : vf_set(-0.5f * SECTORS) * s->b * s->inverse,
                          .offset = vf_set(offset),
                          .flat = flatness(w, s, offset, uniform),
                          .uniform = uniform};
    sectors found = {.mask = vi_set(0),
                     .count = vi_set(0),
                     .occlusion = zero,
                     .start = zero,
                     .last_x = zero,
                     .last_z = zero};
    for (int32_t g = 0; vectors && g < GROUPS; g++)
        found.blocked[g] = zero;
    for (int32_t i = first; i < last; i++) {
        const crv__sample_place *place = &list->places[i];
        const vf d = crv__group_slice_depth(at, place, 0, c.border);
        const vf width =
            c.rule == CRV_THICKNESS_WIDTH ? width_at(at, place, c.border) : zero;
        vf x, z;
        crv__group_slice_point(w, s, &list->samples[i], d, c.orthographic, &x, &z);
        add_sample(&found, w, s, &places, c, &list->samples[i], x, z, width, vectors);
    }
    if (vectors && c.hard)
        add_groups(&found, vf_set(1), found.mask);
    if (vectors)
        *vectors = crv__group_vectors(w->params, s->cos_tangent, s->sin_tangent, s->total,
                                      found.blocked);
    const vf occlusion = c.hard ? vf_of(vi_count_bits(found.mask)) : found.occlusion;
    return occlusion * vf_set(1.0f / SECTORS);
}

CRV__SLICES_SUMMED

CRV__SLICE_SHAPE(hard, .rule = CRV_THICKNESS_WIDTH, .hard = true)
CRV__SLICE_SHAPE(hard_border, .rule = CRV_THICKNESS_WIDTH, .hard = true, .border = true)
CRV__SLICE_SHAPE(soft, .rule = CRV_THICKNESS_WIDTH)
CRV__SLICE_SHAPE(soft_border, .rule = CRV_THICKNESS_WIDTH, .border = true)
CRV__SLICE_SHAPE(soft_run, .rule = CRV_THICKNESS_RUN)
CRV__SLICE_SHAPE(soft_run_border, .rule = CRV_THICKNESS_RUN, .border = true)
CRV__SLICE_SHAPE(hard_run, .rule = CRV_THICKNESS_RUN, .hard = true)
CRV__SLICE_SHAPE(hard_run_border, .rule = CRV_THICKNESS_RUN, .hard = true, .border = true)

CRV__SLICE_BENT_SHAPE(hard_bent, .rule = CRV_THICKNESS_WIDTH, .hard = true)
CRV__SLICE_BENT_SHAPE(soft_bent, .rule = CRV_THICKNESS_WIDTH)

CRV__INLINE shape general_shape(const crv__params *p)
{
    return (shape){
        .rule = p->thickness_rule, .orthographic = p->orthographic, .border = true};
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
    const bool is_hard = p->falloff == CRV_FALLOFF_NONE;
    if (p->orthographic)
        return general(at, list);
    if (p->thickness_rule == CRV_THICKNESS_WIDTH && is_hard)
        return at->at_border ? hard_border(at, list) : hard(at, list);
    if (p->thickness_rule == CRV_THICKNESS_WIDTH)
        return at->at_border ? soft_border(at, list) : soft(at, list);
    if (p->thickness_rule == CRV_THICKNESS_RUN && is_hard)
        return at->at_border ? hard_run_border(at, list) : hard_run(at, list);
    if (p->thickness_rule == CRV_THICKNESS_RUN)
        return at->at_border ? soft_run_border(at, list) : soft_run(at, list);
    return general(at, list);
}

CRV__INLINE vf estimate(const crv__group_pixels *at, const crv__list *list, crv__v3 *bent)
{
    const crv__params *p = at->frame->params;
    if (p->orthographic || p->thickness_rule != CRV_THICKNESS_WIDTH || at->at_border)
        return general_bent(at, list, bent);
    return p->falloff == CRV_FALLOFF_NONE ? hard_bent(at, list, bent)
                                          : soft_bent(at, list, bent);
}

CRV__DEINTERLEAVED_BENT

CRV__DEINTERLEAVED_KERNEL(bitmask, .run_bent = run_bent, .in_slices = true,
                          .jittered = true, .far_on_grid = true, .one_layer = true,
                          .fineness = 2)
