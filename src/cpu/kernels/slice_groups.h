/* SPDX-License-Identifier: MIT */
/*
 * methods/slice.h in the deinterleaved structure.
 *
 * All is measured in units of the pixel's own depth d (perspective; orthographic: scene
 * units). With k = 1 - ds/d a sample at the step o of the image plane at unit depth is
 * v = o - k (ray + o). T is at right angles to the ray, so that on the slice
 *
 *     x = (1 - k) T.o     z = h - x b/a     h = q + k (g - q)
 *     q = n.o/a - e/d     g = |ray| (n.V)/a
 *
 * h is the height over the tangent along V. Orthographic, with k = d - ds, x = T.o and
 * h = q + k g, q = n.o/a - e, g = (n.V)/a.
 */
#ifndef CRV_CPU_KERNELS_SLICE_GROUPS_H
#define CRV_CPU_KERNELS_SLICE_GROUPS_H

#include "cpu/kernels/beyond.h"
#include "cpu/kernels/slice.h"

/* What does not change from slice to slice. */
typedef struct crv__slice_view {
    const crv__params *params;
    const crv__noise_texel *noise; /* all lanes' */
    vf scale, origin;              /* k = origin - scale * ds */
    vf radius, radius2, inverse_radius;
    vf a, inverse_a, g, minus_lift;
    vf half_nx, half_ny; /* n/2a */
    crv__v3 V;
} crv__slice_view;

/* What does not change from sample to sample. */
typedef struct crv__group_slice {
    vf half_Tx, half_Ty, Tz;
    vf b, minus_b_over_a, cos_tangent, sin_tangent, total, inverse;
    vf density; /* w; 0 where the slice's measure is nothing */
    vf weight;  /* times the total */
} crv__group_slice;

CRV__INLINE crv__slice_view crv__slice_view_of(const crv__group_pixels *at,
                                               int orthographic)
{
    const crv__params *p = at->frame->params;
    const vf one = vf_set(1), rx = at->ray_x, ry = at->ray_y;
    const int32_t phase_x = at->px, phase_y = (at->y + at->di->top) & (CRV__PHASES - 1);
    crv__slice_view w = {.params = p, .origin = one, .scale = one};
    w.noise =
        &at->frame
             ->noise[phase_y % p->noise_size * p->noise_size + phase_x % p->noise_size];
    w.radius = vf_set(p->radius);
    w.inverse_radius = vf_set(p->inv_radius);
    vf length = one;
    if (orthographic) {
        w.origin = at->depth;
        w.V = (crv__v3){vf_zero(), vf_zero(), one};
    } else {
        w.scale = at->inverse;
        w.radius = w.radius * at->inverse;
        w.inverse_radius = w.inverse_radius * at->depth;
        const vf squared = vf_fma(rx, rx, vf_fma(ry, ry, one)),
                 inverse = vf_rsqrt(squared);
        length = squared * inverse;
        w.V = (crv__v3){-rx * inverse, -ry * inverse, inverse};
    }
    w.radius2 = w.radius * w.radius;
    const vf facing = crv__v3_dot(at->n, w.V);
    w.a = vf_max(facing, vf_set(0.02f));
    w.inverse_a = one / w.a;
    w.g = length * facing * w.inverse_a;
    w.half_nx = vf_set(0.5f) * at->n.x * w.inverse_a;
    w.half_ny = vf_set(0.5f) * at->n.y * w.inverse_a;
    w.minus_lift = vf_zero() - crv__lanes_lift(p, w.a);
    return w;
}

/* What follows of a slice from its T, b and tangent; scale: 1 over the root that T was
 * divided by. */
CRV__INLINE void crv__group_slice_finish(crv__group_slice *s, const crv__slice_view *w,
                                         vf scale)
{
    s->minus_b_over_a = -s->b * w->inverse_a;
    s->total = crv__lanes_measure(w->params, w->a, s->b, s->cos_tangent, s->sin_tangent);
    const vm counts = vf_lt(vf_set(1e-7f), s->total);
    s->inverse = vf_where(counts, vf_rcp(s->total));
    s->density = vf_where(counts, scale * scale);
    s->weight = vf_where(counts, scale * scale * s->total);
}

/* Slice k, and if `opposite` is not NULL the one opposite to it. */
CRV__INLINE void crv__group_slice_at(const crv__group_pixels *at,
                                     const crv__slice_view *w, int32_t k,
                                     crv__group_slice *s, crv__group_slice *opposite)
{
    const float *direction = at->frame->directions + 2 * k;
    const float ca = w->noise->cos_alpha, sa = w->noise->sin_alpha;
    const vf one = vf_set(1);
    const vf Dx = vf_set(direction[0] * ca - direction[1] * sa),
             Dy = vf_set(direction[0] * sa + direction[1] * ca);
    const vf DV = vf_fma(Dx, w->V.x, Dy * w->V.y), squared = one - DV * DV;
    const vf scale = vf_rsqrt(squared);
    const vf Tx = (Dx - DV * w->V.x) * scale, Ty = (Dy - DV * w->V.y) * scale;
    s->half_Tx = vf_set(0.5f) * Tx;
    s->half_Ty = vf_set(0.5f) * Ty;
    s->Tz = -DV * w->V.z * scale;
    s->b = vf_fma(at->n.x, Tx, vf_fma(at->n.y, Ty, at->n.z * s->Tz));
    const vf inverse = vf_rsqrt(vf_fma(w->a, w->a, s->b * s->b));
    s->cos_tangent = -s->b * inverse;
    s->sin_tangent = w->a * inverse;
    if (opposite) {
        opposite->half_Tx = -s->half_Tx;
        opposite->half_Ty = -s->half_Ty;
        opposite->Tz = -s->Tz;
        opposite->b = -s->b;
        opposite->cos_tangent = -s->cos_tangent;
        opposite->sin_tangent = s->sin_tangent;
        crv__group_slice_finish(opposite, w, scale);
    }
    crv__group_slice_finish(s, w, scale);
}

/* What a share of the slice's measure is computed from. F being a (1 - cos^2) plus a
 * multiple of crv__lanes_segment(), it is whole - cos (a cos + Q(sin)); and so it is
 * for uniform weighting, with other coefficients. */
typedef struct crv__group_measure {
    vf whole, a, Q[4];
} crv__group_measure;

/* Of shares in units of 1/parts. */
CRV__INLINE crv__group_measure crv__group_measure_of(const crv__slice_view *w,
                                                     const crv__group_slice *s,
                                                     float parts)
{
    const vf zero = vf_zero(), unit = vf_set(parts) * s->inverse;
    if (w->params->weighting == CRV_WEIGHTING_UNIFORM)
        return (crv__group_measure){
            .whole = unit, .a = zero, .Q = {unit, zero, zero, zero}};
    const vf half = vf_set(0.5f * parts) * s->inverse, a = w->a * half, b = s->b * half;
    return (crv__group_measure){.whole = vf_fma(b, vf_set(1.57079633f), a),
                                .a = a,
                                .Q = {b * vf_set(1.57020562f), b * vf_set(0.02568289f),
                                      b * vf_set(0.60547927f), b * vf_set(-0.20501906f)}};
}

/* F/Ft in the direction that these are the cosine and sine of. */
CRV__INLINE vf crv__group_share(const crv__group_measure *m, vf cosine, vf sine)
{
    vf Q = vf_fma(sine, m->Q[3], m->Q[2]);
    Q = vf_fma(sine, Q, m->Q[1]);
    Q = vf_fma(sine, Q, m->Q[0]);
    return vf_fma(-cosine, vf_fma(m->a, cosine, Q), m->whole);
}

/* The point of the slice at a sample with depth ds: its x; and its height over the
 * tangent along V for half of n/a, or z for half of n/a - T b/a. */
CRV__INLINE void crv__group_slice_point(const crv__slice_view *w,
                                        const crv__group_slice *s, vf half_x, vf half_y,
                                        const crv__sample *sample, vf depth,
                                        int orthographic, vf *x, vf *height)
{
    const vf x2 = vf_set(sample->x2), y2 = vf_set(sample->y2);
    const vf k = vf_fma(-depth, w->scale, w->origin);
    const vf m = vf_fma(x2, s->half_Tx, y2 * s->half_Ty);
    const vf q = vf_fma(x2, half_x, vf_fma(y2, half_y, w->minus_lift));
    *x = orthographic ? m : vf_fma(-k, m, m);
    *height = orthographic ? vf_fma(k, w->g, q) : vf_fma(k, w->g - q, q);
}

/* Whether all lanes have their sample on the picture. */
CRV__INLINE bool crv__group_slice_is_inside(const crv__group_pixels *at,
                                            const crv__sample_place *place)
{
    const crv__params *p = at->frame->params;
    const int32_t left = at->left + place->du, v = at->y + place->dv;
    return (place->shift[0] != CRV__SHIFT_OFF) & ((uint32_t)v < (uint32_t)p->height)
           & (left >= 0) & (left + CRV__PHASES * (CRV__LANES - 1) < p->width);
}

/* Depth of a layer at a sample; from the background on there is no surface. */
CRV__INLINE vf crv__group_slice_depth(const crv__group_pixels *at,
                                      const crv__sample_place *place, int32_t layer,
                                      int border)
{
    const crv__params *p = at->frame->params;
    const ptrdiff_t skip = layer * at->di->layer_pitch;
    if (!border || crv__group_slice_is_inside(at, place))
        return crv__sample_depth(at, at->own + place->offset[0] + skip);
    const vf d = crv__sample_depth(at, crv__sample_at(at, place, 0, border) + skip);
    if (layer > 0 || p->border == CRV_BORDER_BACKGROUND
        || place->shift[0] == CRV__SHIFT_OFF)
        return d;
    const crv__group_spot spot = crv__group_spot_at(at, place);
    const vm off = vm_and(spot.off, vf_lt(at->depth, vf_set(at->di->background)));
    return vm_any(off) ? vf_select(off, crv__group_beyond(at, &spot), d) : d;
}

/* Slices that are set up at once: one after the other they would wait for their roots. */
enum { CRV__SLICES_AT_ONCE = 6 };

/* The slice that is the i-th to be computed: if their number is even, those that are
 * opposite follow one another. */
CRV__INLINE int32_t crv__group_slice_number(const crv__group_pixels *at, int32_t i)
{
    const int32_t slices = at->di->slices;
    return slices % 2 ? i : i / 2 + i % 2 * (slices / 2);
}

/* sum_of_slices(): accessibility from a group's slices, by the template's `shape` and
 * blocked_shares(); and the bent normal, if bent is not NULL. CRV__SLICE_SHAPE: for one
 * shape, compiled by itself; CRV__SLICE_BENT_SHAPE: with bent normals. */
#define CRV__SLICES_SUMMED                                                               \
    CRV__INLINE vf sum_of_slices(const crv__group_pixels *at, const crv__list *list,     \
                                 shape c, crv__v3 *bent)                                 \
    {                                                                                    \
        const crv__slice_view w = crv__slice_view_of(at, c.orthographic);                \
        const int32_t slices = at->di->slices, pairs = slices % 2 == 0;                  \
        const vf one = vf_set(1);                                                        \
        vf blocked = vf_zero(), total = vf_zero();                                       \
        crv__lanes_sums sums = crv__lanes_no_sums();                                     \
        for (int32_t first = 0; first < slices; first += CRV__SLICES_AT_ONCE) {          \
            const int32_t rest = slices - first, count = rest < CRV__SLICES_AT_ONCE      \
                                                             ? rest                      \
                                                             : CRV__SLICES_AT_ONCE;      \
            crv__group_slice s[CRV__SLICES_AT_ONCE];                                     \
            crv__lanes_vectors vectors[CRV__SLICES_AT_ONCE];                             \
            vf shares[CRV__SLICES_AT_ONCE];                                              \
            for (int32_t k = 0; k < count; k += 1 + pairs)                               \
                crv__group_slice_at(at, &w, crv__group_slice_number(at, first + k),      \
                                    &s[k], pairs ? &s[k + 1] : NULL);                    \
            blocked_shares(at, list, &w, s, c, first, count, shares,                     \
                           bent ? vectors : NULL);                                       \
            for (int32_t k = 0; k < count; k++) {                                        \
                blocked = vf_fma(s[k].weight, shares[k], blocked);                       \
                total = total + s[k].weight;                                             \
                const crv__v3 T = {s[k].half_Tx + s[k].half_Tx,                          \
                                   s[k].half_Ty + s[k].half_Ty, s[k].Tz};                \
                if (bent)                                                                \
                    crv__lanes_add_vectors(&sums, T, w.V, s[k].density, &vectors[k]);    \
            }                                                                            \
        }                                                                                \
        const vf A = vf_select(vf_lt(vf_zero(), total), one - blocked / total, one);     \
        if (bent)                                                                        \
            *bent = crv__lanes_bent_normal(&sums, at->n, A,                              \
                                           crv__lanes_mean(w.params) * total);           \
        return A;                                                                        \
    }

#define CRV__SLICE_SHAPE(name, ...)                                                      \
    CRV__NOINLINE vf name(const crv__group_pixels *at, const crv__list *list)            \
    {                                                                                    \
        return sum_of_slices(at, list, (shape){__VA_ARGS__}, NULL);                      \
    }

#define CRV__SLICE_BENT_SHAPE(name, ...)                                                 \
    CRV__NOINLINE vf name(const crv__group_pixels *at, const crv__list *list,            \
                          crv__v3 *bent)                                                 \
    {                                                                                    \
        return sum_of_slices(at, list, (shape){__VA_ARGS__}, bent);                      \
    }

#endif
