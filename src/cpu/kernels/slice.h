/* SPDX-License-Identifier: MIT */
/* methods/slice.h for the lanes of a vector: slices through the eye. All is rounded as
 * there: a small difference is a large one at grazing angles, where a is small. */
#ifndef CRV_CPU_KERNELS_SLICE_H
#define CRV_CPU_KERNELS_SLICE_H

#include "cpu/kernels/bent.h"

/* The largest share of the radius that has a weight. */
#define CRV__BELOW_ONE 0.99999994f

/* The shaded points: see crv__slice_site. */
typedef struct crv__lanes_site {
    vf unit, a, lift, nearness;
    crv__v3 ray, V;
} crv__lanes_site;

typedef struct crv__lanes_slice {
    crv__v3 T;
    vf b, weight, cos_tangent, sin_tangent, total, inverse;
    vf step_x, step_y, length_px, jitter, sector_offset;
} crv__lanes_slice;

/* The lift of a site. */
CRV__INLINE vf crv__lanes_lift(const crv__params *p, vf a)
{
    const float footprint = p->inv_fx > p->inv_fy ? p->inv_fx : p->inv_fy;
    const vf share = vf_set(0.25f) - vf_set(0.5f) * a;
    return vf_set(footprint) * vf_max(share, vf_zero()) / a;
}

CRV__INLINE crv__lanes_site crv__lanes_site_at(const crv__params *p, crv__shape shape,
                                               const crv__pixels *at)
{
    const vf zero = vf_zero(), one = vf_set(1), half = vf_set(0.5f);
    crv__lanes_site site = {
        .unit = one, .ray = {zero, zero, -one}, .V = {zero, zero, one}};
    if (!shape.orthographic) {
        site.unit = at->depth;
        site.ray.x = (vf_of(at->x) + half - vf_set(p->cx)) * vf_set(p->inv_fx);
        site.ray.y = -(vf_set((float)at->y + 0.5f - p->cy) * vf_set(p->inv_fy));
        const vf inverse = one / vf_sqrt(crv__v3_dot(site.ray, site.ray));
        site.V = (crv__v3){-site.ray.x * inverse, -site.ray.y * inverse, inverse};
    }
    site.a = vf_max(crv__v3_dot(at->n, site.V), vf_set(0.02f));
    site.lift = crv__lanes_lift(p, site.a);
    const float focal = p->fx > p->fy ? p->fx : p->fy;
    const vf largest = vf_set(focal * p->radius) / site.unit,
             cap = vf_set(p->max_radius_px);
    site.nearness = one / site.unit;
    site.nearness =
        vf_select(vf_lt(cap, largest), site.nearness * (cap / largest), site.nearness);
    return site;
}

/* crv__slice_segment() */
CRV__INLINE vf crv__lanes_segment(vf cosine, vf sine)
{
    const vf inner = vf_set(0.60547927f) - sine * vf_set(0.20501906f);
    const vf Q = vf_set(1.57020562f) + sine * (vf_set(0.02568289f) + sine * inner);
    return vf_set(1.57079633f) - cosine * Q;
}

/* crv__slice_measure() */
CRV__INLINE vf crv__lanes_measure(const crv__params *p, vf a, vf b, vf cosine, vf sine)
{
    if (p->weighting == CRV_WEIGHTING_UNIFORM)
        return vf_set(1) - cosine;
    return vf_set(0.5f) * (a * sine * sine + b * crv__lanes_segment(cosine, sine));
}

/* A vector of a slice: along T, along V. */
typedef struct crv__v2 {
    vf T, V;
} crv__v2;

/* crv__slice_vector() */
CRV__INLINE crv__v2 crv__lanes_vector(const crv__params *p, vf a, vf b, vf cosine,
                                      vf sine)
{
    if (p->weighting == CRV_WEIGHTING_UNIFORM)
        return (crv__v2){vf_set(0.5f) * crv__lanes_segment(cosine, sine),
                         vf_set(0.5f) * sine * sine};
    const vf one = vf_set(1), third = vf_set(1.0f / 3);
    const vf sine3 = sine * sine * sine, rest = one - cosine;
    const vf along_T = rest * rest * (vf_set(2) + cosine),
             along_V = rest * (one + cosine + cosine * cosine);
    return (crv__v2){(a * sine3 + b * along_T) * third,
                     (b * sine3 + a * along_V) * third};
}

/* crv__slice_share() */
CRV__INLINE vf crv__lanes_share(const crv__params *p, const crv__lanes_site *site,
                                const crv__lanes_slice *s, vf cosine, vf sine)
{
    return vf_clamp01(crv__lanes_measure(p, site->a, s->b, cosine, sine) * s->inverse);
}

/* crv__slice_at(); `total` is 0 in lanes whose slice's measure is nothing. */
CRV__INLINE crv__lanes_slice crv__lanes_slice_at(const crv__params *p,
                                                 const crv__pixels *at,
                                                 const crv__lanes_site *site, int32_t k)
{
    const vf one = vf_set(1);
    const crv__v3 V = site->V;
    crv__lanes_slice s;
    vf Dx, Dy;
    crv__lanes_point(at, k, &Dx, &Dy);
    const vf DV = Dx * V.x + Dy * V.y, squared = one - DV * DV;
    const vf scale = one / vf_sqrt(squared);
    s.T = (crv__v3){(Dx - DV * V.x) * scale, (Dy - DV * V.y) * scale, -DV * V.z * scale};
    s.b = crv__v3_dot(at->n, s.T);
    s.weight = one / squared;
    const vf inverse = one / vf_sqrt(site->a * site->a + s.b * s.b);
    s.cos_tangent = -s.b * inverse;
    s.sin_tangent = site->a * inverse;
    const vf total = crv__lanes_measure(p, site->a, s.b, s.cos_tangent, s.sin_tangent);
    s.total = vf_where(vf_lt(vf_set(1e-7f), total), total);
    s.inverse = one / total;
    /* Texels depend on these: rounded as the scalar code's. */
    const vf px_x = Dx * vf_set(p->fx), px_y = -Dy * vf_set(p->fy);
    const vf length = vf_sqrt(px_x * px_x + px_y * px_y);
    s.step_x = px_x / length;
    s.step_y = px_y / length;
    s.length_px = vf_set(p->radius) * site->nearness * length;
    s.jitter = crv__lanes_stratum(at, k);
    const vf offset = at->sector_offset + vf_set(0.754878f * (float)k);
    s.sector_offset = offset - vf_floor(offset);
    return s;
}

/* crv__slice_texel */
typedef struct crv__lanes_texel {
    vi u, v;
    vm in, beyond; /* lanes whose texel is on the buffers; off them, but not too far */
    vf near, far;
} crv__lanes_texel;

CRV__INLINE float crv__slice_border(const crv__params *p, int32_t i)
{
    const float t = (float)i / (float)p->steps;
    return p->spacing == CRV_SPACING_QUADRATIC ? t * t : t;
}

/* crv__slice_texel_at() */
CRV__INLINE crv__lanes_texel crv__lanes_slice_texel(const crv__params *p,
                                                    crv__shape shape,
                                                    const crv__pixels *at,
                                                    const crv__lanes_slice *s, int32_t i)
{
    const vf one = vf_set(1), half = vf_set(0.5f);
    crv__lanes_texel texel;
    vf spaced = (vf_set((float)i) + s->jitter) / vf_set((float)p->steps);
    if (p->spacing == CRV_SPACING_QUADRATIC)
        spaced = spaced * spaced;
    const vf t = vf_max(spaced * s->length_px, one);
    /* Lanes without a surface or beyond every picture stay where integers can follow. */
    const vf farthest = vf_set((float)(4 * CRV_MAX_SIZE));
    const vf bounded = vf_min(t, farthest);
    texel.u = vi_floor(vf_of(at->x) + half + bounded * s->step_x);
    texel.v = vi_floor(vf_set((float)at->y + 0.5f) + bounded * s->step_y);
    texel.in = at->active;
    texel.beyond = vm_none();
    if (!shape.within) {
        const vm on = vm_and(vi_below(texel.u, vi_set(p->width)),
                             vi_below(texel.v, vi_set(p->height)));
        const vm there = vm_and(at->active, vf_lt(t, farthest));
        texel.in = vm_and(there, on);
        texel.beyond = vm_and(there, vm_not(on));
    }
    texel.near =
        vf_min(vf_max(vf_set(crv__slice_border(p, i)) * s->length_px, half) / t, one);
    texel.far = vf_max(vf_set(crv__slice_border(p, i + 1)) * s->length_px / t, one);
    return texel;
}

CRV__INLINE vf crv__lanes_linear(const crv__frame *f, crv__shape shape, vi x, vi y,
                                 vm mask)
{
    const vf d = vf_gather(f->depth[0].data, crv__lanes_index(&f->depth[0], x, y), mask);
    return shape.orthographic ? d : vf_set(1) / d;
}

/* crv__border_outward() of the lanes of `mask`: over `count` texels. */
CRV__INLINE vf crv__lanes_outward(const crv__frame *f, crv__shape shape, vi x, vi y,
                                  vi in_x, vi in_y, vm mask, vf own, vi count)
{
    const vi two = vi_set(2), four = vi_set(4);
    const vf middle = crv__lanes_linear(f, shape, x + two * in_x, y + two * in_y, mask);
    const vf inner = crv__lanes_linear(f, shape, x + four * in_x, y + four * in_y, mask);
    const vf bend = vf_abs(own - vf_set(2) * middle + inner);
    const vm planar = vm_and(vf_lt(vf_zero(), inner), vf_lt(bend, vf_set(0.01f) * own));
    return vf_where(vm_and(mask, planar),
                    vf_set(0.25f) * (own - inner) * vf_abs(vf_of(count)));
}

/* crv__slice_beyond() of the lanes of `mask`. */
CRV__NOINLINE vf crv__lanes_beyond(const crv__frame *f, vi u, vi v, vm mask)
{
    const crv__params *p = f->params;
    const crv__shape shape = {.orthographic = p->orthographic};
    const vi zero = vi_set(0), one = vi_set(1), minus_one = vi_set(-1);
    const vi right = vi_set(p->width - 1), bottom = vi_set(p->height - 1);
    const vm over_left = vi_lt(u, zero), over_top = vi_lt(v, zero);
    const vm over_x = vm_and(mask, vm_or(over_left, vi_lt(right, u)));
    const vm over_y = vm_and(mask, vm_or(over_top, vi_lt(bottom, v)));
    const vi x = vi_select(over_left, zero, vi_select(vi_lt(right, u), right, u));
    const vi y = vi_select(over_top, zero, vi_select(vi_lt(bottom, v), bottom, v));
    const vf d = vf_gather(f->depth[0].data, crv__lanes_index(&f->depth[0], x, y), mask);
    const vm surface = vm_and(mask, vf_lt(d, vf_set(INFINITY)));
    const vf own = shape.orthographic ? d : vf_set(1) / d;
    vf w = own;
    if (p->width > 4 && vm_any(over_x))
        w = w
            + crv__lanes_outward(f, shape, x, y, vi_select(over_left, one, minus_one),
                                 zero, over_x, own, u - x);
    if (p->height > 4 && vm_any(over_y))
        w = w
            + crv__lanes_outward(f, shape, x, y, zero,
                                 vi_select(over_top, one, minus_one), over_y, own, v - y);
    const vf third = own / vf_set(3), thrice = vf_set(3) * own;
    const vm near = shape.orthographic ? vf_le(w, thrice) : vf_le(third, w);
    w = shape.orthographic ? vf_max(w, third) : vf_set(1) / vf_min(w, thrice);
    return vf_select(vm_and(surface, near), w, vf_set(INFINITY));
}

/* crv__slice_depth() */
CRV__INLINE vf crv__lanes_slice_depth(const crv__frame *f, crv__shape shape,
                                      int32_t layer, const crv__lanes_texel *texel)
{
    const vf infinity = vf_set(INFINITY);
    const vi index = crv__lanes_index(&f->depth[0], texel->u, texel->v);
    const vf d = vf_gather(f->depth[layer].data, index, texel->in);
    if (shape.within)
        return d;
    if (layer > 0 || f->params->border == CRV_BORDER_BACKGROUND || !vm_any(texel->beyond))
        return vf_select(texel->in, d, infinity);
    const vf beyond = crv__lanes_beyond(f, texel->u, texel->v, texel->beyond);
    return vf_select(texel->in, d, vf_select(texel->beyond, beyond, infinity));
}

/* crv__slice_point() */
CRV__INLINE void crv__lanes_slice_point(const crv__params *p, crv__shape shape,
                                        const crv__pixels *at,
                                        const crv__lanes_site *site,
                                        const crv__lanes_slice *s,
                                        const crv__lanes_texel *texel, vf depth, vf *x,
                                        vf *z)
{
    const vf offset_x = vf_of(texel->u - at->x) * vf_set(p->inv_fx);
    const vf offset_y = vf_of(vi_set(at->y) - texel->v) * vf_set(p->inv_fy);
    vf ray_x = site->ray.x, ray_y = site->ray.y;
    if (!shape.orthographic) {
        ray_x = ray_x + offset_x;
        ray_y = ray_y + offset_y;
    }
    const vf behind = depth - at->depth;
    const crv__v3 v = {behind * ray_x + site->unit * offset_x,
                       behind * ray_y + site->unit * offset_y, -behind};
    *x = crv__v3_dot(v, s->T);
    const vf lift = shape.orthographic ? site->lift : site->lift * depth;
    *z = (crv__v3_dot(v, at->n) - s->b * *x) / site->a - lift;
}

/* crv__slice_vectors */
typedef struct crv__lanes_vectors {
    crv__v2 open, blocked;
} crv__lanes_vectors;

/* Adds those of a slice of this weight. */
CRV__INLINE void crv__lanes_add_vectors(crv__lanes_sums *sums, crv__v3 T, crv__v3 V,
                                        vf weight, const crv__lanes_vectors *v)
{
    crv__v3 *open = &sums->open, *blocked = &sums->blocked;
    *open = crv__v3_add_scaled(*open, T, weight * v->open.T);
    *open = crv__v3_add_scaled(*open, V, weight * v->open.V);
    *blocked = crv__v3_add_scaled(*blocked, T, weight * v->blocked.T);
    *blocked = crv__v3_add_scaled(*blocked, V, weight * v->blocked.V);
}

/* The share of the hemisphere's mean direction in its measure. */
CRV__INLINE vf crv__lanes_mean(const crv__params *p)
{
    return vf_set(p->weighting == CRV_WEIGHTING_COSINE ? CRV__BENT_COSINE
                                                       : CRV__BENT_UNIFORM);
}

/* The blocked share of a slice's measure. vectors NULL: not wanted. */
typedef vf (*crv__lanes_slice_fn)(const crv__frame *f, crv__shape shape,
                                  const crv__pixels *at, const crv__lanes_site *site,
                                  const crv__lanes_slice *s, crv__lanes_vectors *vectors);

/* crv__slices_open() */
CRV__INLINE vf crv__lanes_slices_open(const crv__frame *f, crv__shape shape,
                                      const crv__pixels *at,
                                      crv__lanes_slice_fn blocked_share, crv__v3 *bent)
{
    const crv__params *p = f->params;
    const crv__lanes_site site = crv__lanes_site_at(p, shape, at);
    vf blocked = vf_zero(), total = vf_zero();
    crv__lanes_sums sums = crv__lanes_no_sums();
    for (int32_t k = 0; k < p->directions; k++) {
        const crv__lanes_slice s = crv__lanes_slice_at(p, at, &site, k);
        crv__lanes_vectors vectors;
        const vf share = blocked_share(f, shape, at, &site, &s, bent ? &vectors : NULL);
        const vm counts = vf_lt(vf_zero(), s.total);
        blocked = blocked + vf_where(counts, s.weight * s.total * share);
        total = total + vf_where(counts, s.weight * s.total);
        if (bent)
            crv__lanes_add_vectors(&sums, s.T, site.V, vf_where(counts, s.weight),
                                   &vectors);
    }
    const vf one = vf_set(1);
    const vf A = vf_select(vf_lt(vf_zero(), total), one - blocked / total, one);
    if (bent)
        *bent = crv__lanes_bent_normal(&sums, at->n, A, crv__lanes_mean(p) * total);
    return A;
}

/* Whether no sample of these pixels leaves the buffers. */
CRV__INLINE int crv__slices_within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__shape shape = {.orthographic = p->orthographic};
    const vf one = vf_set(1);
    const vf radius = vf_set(p->radius) * crv__lanes_site_at(p, shape, at).nearness;
    return crv__lanes_disk_within(p, at, vf_max(radius * vf_set(p->fx), one),
                                  vf_max(radius * vf_set(p->fy), one));
}

#endif
