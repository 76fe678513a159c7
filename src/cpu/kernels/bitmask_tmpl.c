/* SPDX-License-Identifier: MIT */
/* methods/bitmask.c for the lanes of a vector. A sector is one side of a limit or the
 * other: all is rounded as there. */
#include "cpu/kernels/sectors.h"

/* A slice so far, and what bodies are: see the scalar code. */
typedef struct sectors {
    vi mask;
    vf occlusion, start, last_x, last_z;
    vf blocked[GROUPS];
} sectors;

typedef struct body {
    vf x, z, thickness;
} body;

CRV__INLINE vf share(const crv__params *p, const crv__lanes_site *site,
                     const crv__lanes_slice *s, vf x, vf z)
{
    const vf one = vf_set(1), inverse = one / vf_sqrt(x * x + z * z);
    const vf cosine = z * inverse;
    return vf_select(vf_lt(s->cos_tangent, cosine),
                     crv__lanes_share(p, site, s, cosine, x * inverse), one);
}

/* The number of the first sector from this place on. */
CRV__INLINE vi first_from(const crv__lanes_slice *s, vf share)
{
    const vf place = vf_set(SECTORS) * share - s->sector_offset;
    const vf up = vf_zero() - vf_floor(vf_zero() - place);
    return vi_trunc(vf_min(vf_max(up, vf_zero()), vf_set(SECTORS)));
}

/* Adds the bodies of the lanes of `there`. */
CRV__INLINE void add_bodies(sectors *to, const crv__params *p,
                            const crv__lanes_site *site, const crv__lanes_slice *s,
                            const crv__lanes_texel *texel, const body *b, vm there,
                            bool with_vectors)
{
    const vf one = vf_set(1), zero = vf_zero(), R = vf_set(p->radius);
    const vf front_x = b->x * (one - vf_set(0.3f) * (one - texel->near));
    const vf back_x = b->x * texel->far;
    const vf end = vf_sqrt(vf_max(R * R - front_x * front_x, zero));
    const vf front_z = vf_min(b->z - s->b / site->a * (front_x - b->x), end);
    const vf back_z = vf_max(b->z - b->thickness, zero - end);
    there = vm_and(there, vm_and(vf_lt(zero, b->x), vf_lt(back_z, front_z)));
    if (!vm_any(there))
        return;
    const vi front = vi_from_bit(first_from(s, share(p, site, s, front_x, front_z)));
    const vi back = vi_from_bit(first_from(s, share(p, site, s, back_x, back_z)));
    const vi bits = front & ~back, added = bits & ~to->mask;
    there = vm_and(there, vm_not(vi_eq(added, vi_set(0))));
    if (!vm_any(there))
        return;
    to->mask = vi_select(there, to->mask | bits, to->mask);
    const vf new_count = vf_of(vi_count_bits(added)), count = vf_of(vi_count_bits(bits));
    const vf r = vf_min(vf_sqrt(b->x * b->x + b->z * b->z), R);
    const vf middle = r - vf_set(0.7f) * (r - b->x) * new_count / count;
    const vf q = vf_min(middle * vf_set(p->inv_radius), vf_set(CRV__BELOW_ONE));
    const vf W = crv__lanes_falloff(p, q);
    to->occlusion =
        to->occlusion + vf_where(there, W * new_count / vf_set((float)SECTORS));
    const vi counts = crv__group_counts(added);
    for (int32_t g = 0; with_vectors && g < GROUPS; g++)
        to->blocked[g] =
            to->blocked[g] + vf_where(there, W * crv__group_count(counts, g));
}

/* crv__map_at() */
CRV__INLINE vf map_at(const crv__frame *f, crv__shape shape,
                      const crv__lanes_texel *texel, vm mask)
{
    vi u = texel->u, v = texel->v;
    if (!shape.within) {
        const vi zero = vi_set(0), right = vi_set(f->params->width - 1),
                 bottom = vi_set(f->params->height - 1);
        u = vi_select(vi_lt(u, zero), zero, vi_select(vi_lt(right, u), right, u));
        v = vi_select(vi_lt(v, zero), zero, vi_select(vi_lt(bottom, v), bottom, v));
    }
    return vf_gather(f->map->data, crv__lanes_index(f->map, u, v), mask);
}

CRV__INLINE void seen_thickness(const sectors *so_far, const crv__frame *f,
                                crv__shape shape, const crv__lanes_texel *texel, vf x,
                                vm there, vf *first, vf *sheet)
{
    const crv__params *p = f->params;
    const vf least = vf_set(0.1f * p->radius), run = x - so_far->start;
    vf most = vf_set(p->thickness);
    if (p->thickness_rule == CRV_THICKNESS_RUN)
        most = vf_set(2) * run;
    if (p->thickness_rule == CRV_THICKNESS_WIDTH)
        most = vf_min(vf_set(2.5f) * run, map_at(f, shape, texel, there));
    *first = *sheet = most;
    if (p->thickness_rule == CRV_THICKNESS_RUN
        || p->thickness_rule == CRV_THICKNESS_WIDTH) {
        *first = vf_max(most, least);
        *sheet = vf_max(vf_set(0.5f) * most, least);
    }
}

CRV__INLINE vf ray_length(const crv__params *p, crv__shape shape,
                          const crv__lanes_texel *texel)
{
    if (shape.orthographic)
        return vf_set(1);
    const crv__v3 ray = crv__lanes_unproject_at(p, shape, texel->u, texel->v, vf_set(1));
    return vf_sqrt(crv__v3_dot(ray, ray));
}

/* The first surfaces at a texel begin and continue runs. */
CRV__INLINE void follow_run(sectors *to, vf x, vf z, vm there)
{
    const vm begins = vm_and(there, vf_lt(vf_set(16) * (x - to->last_x), z - to->last_z));
    to->start = vf_select(begins, x, to->start);
    to->last_x = vf_select(there, x, to->last_x);
    to->last_z = vf_select(there, z, vf_set(-INFINITY));
}

CRV__INLINE void add_texels(sectors *to, const crv__frame *f, crv__shape shape,
                            const crv__pixels *at, const crv__lanes_site *site,
                            const crv__lanes_slice *s, const crv__lanes_texel *texel,
                            bool with_vectors)
{
    const crv__params *p = f->params;
    const vf infinity = vf_set(INFINITY);
    vf d = crv__lanes_slice_depth(f, shape, 0, texel), thickness, sheet;
    vm there = vm_and(at->active, vf_lt(d, infinity));
    if (!vm_any(there)) {
        to->last_z = vf_set(-INFINITY);
        return;
    }
    for (int32_t layer = 0; layer < shape.layers && vm_any(there);) {
        body b;
        crv__lanes_slice_point(p, shape, at, site, s, texel, d, &b.x, &b.z);
        if (layer == 0) {
            follow_run(to, b.x, b.z, there);
            seen_thickness(to, f, shape, texel, b.x, there, &thickness, &sheet);
        }
        b.thickness = layer == 0 ? thickness : sheet;
        if (layer + 1 < shape.layers) {
            const vf next = crv__lanes_slice_depth(f, shape, layer + 1, texel);
            const vf gap = (next - d) * ray_length(p, shape, texel);
            const bool ends = shape.solid || p->thickness_rule == CRV_THICKNESS_LAYERS;
            b.thickness = vf_select(vf_lt(gap, infinity),
                                    ends ? gap : vf_min(b.thickness, gap), b.thickness);
        }
        add_bodies(to, p, site, s, texel, &b, there, with_vectors);
        layer += 1 + shape.solid;
        if (layer < shape.layers) {
            d = crv__lanes_slice_depth(f, shape, layer, texel);
            there = vm_and(there, vf_lt(d, infinity));
        }
    }
}

CRV__INLINE vf blocked_share(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                             const crv__lanes_site *site, const crv__lanes_slice *s,
                             crv__lanes_vectors *vectors)
{
    const vf zero = vf_zero();
    sectors found = {.mask = vi_set(0),
                     .occlusion = zero,
                     .start = zero,
                     .last_x = zero,
                     .last_z = zero};
    for (int32_t g = 0; vectors && g < GROUPS; g++)
        found.blocked[g] = zero;
    for (int32_t i = 0; i < f->params->steps; i++) {
        const crv__lanes_texel texel = crv__lanes_slice_texel(f->params, shape, at, s, i);
        add_texels(&found, f, shape, at, site, s, &texel, vectors);
    }
    if (vectors)
        *vectors = crv__group_vectors(f->params, s->cos_tangent, s->sin_tangent, s->total,
                                      found.blocked);
    return found.occlusion;
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

CRV__ESTIMATE_KERNEL(bitmask, 1)

CRV__BENT_KERNEL(bitmask)
