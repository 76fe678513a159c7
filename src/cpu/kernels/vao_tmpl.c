/* SPDX-License-Identifier: MIT */
/* methods/vao.c for the lanes of a vector: fields are not for it. */
#include "cpu/kernels/march.h"

/*
 * The tangent sphere, as methods/pipe.h has it, and what its pipes share. Places are
 * reckoned from P: pixels from its own, u to the right and v down. Lengths are in units
 * of P's depth d (orthographic: of the scene), so that o = (x, y) is a pipe's step on the
 * image plane at unit depth, ray = (ray_x, ray_y, -1) the view ray of P, c the centre
 * from P, and r the radius.
 *
 * A pipe P + (o, 0) + t w, w = ray + (o, 0), is in the sphere for t within `half` of
 * `middle`, where nothing is large that cancels, since r^2 - c.c is 0 but for the
 * rounding of the normal; orthographic: w = (0, 0, -1).
 *
 * middle = (c - o).w / w.w
 *
 * half^2 = middle^2 + (r^2 - c.c + 2 c.o - o.o) / w.w
 */
typedef struct sphere {
    vf unit;             /* depth of the centre, or 1: scene units */
    vf scale_x, scale_y; /* px per scene unit there */
    vf u, v;             /* of the centre, px */
    crv__v3 c;
    vf lack;                 /* r^2 - c.c */
    vf ray_x2, ray_y2, ray2; /* 2 ray; ray.ray */
    vf b, bx, by;            /* (c - o).w = b + x bx + y by - o.o */
    vf nearer, inverse;      /* see crv__pipe_outside(), and 1 / d */
    vi index;                /* of P's texel */
} sphere;

/* The sphere's part on the view ray of texel (u, v). Half is next to 0 where the ray
 * misses the sphere. */
typedef struct chord {
    vf middle, half;
} chord;

CRV__INLINE sphere sphere_at(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const float radius = 0.5f * p->radius;
    const vf one = vf_set(1), x = vf_of(at->x), y = vf_set((float)at->y);
    const crv__v3 offset = {at->n.x * vf_set(radius), at->n.y * vf_set(radius),
                            at->n.z * vf_set(radius)};
    sphere s = {.nearer = at->depth * vf_set(1 - 2e-6f), .inverse = one, .c = offset};
    s.unit = shape.orthographic ? one : at->depth - offset.z;
    const vf inverse = one / s.unit;
    s.scale_x = vf_set(p->fx) * inverse;
    s.scale_y = vf_set(p->fy) * inverse;
    s.u = vf_set(p->cx) + (at->P.x + offset.x) * s.scale_x - x;
    s.v = vf_set(p->cy) - (at->P.y + offset.y) * s.scale_y - y;
    s.b = -offset.z;
    vf span = vf_set(radius);
    if (!shape.orthographic) {
        /* Of a sphere this far away all pipes are P's own, o = 0, and any unit does. */
        s.inverse = one / vf_min(at->depth, vf_set(1e12f * radius));
        s.c = (crv__v3){offset.x * s.inverse, offset.y * s.inverse, offset.z * s.inverse};
        const vf ray_x = (x + vf_set(0.5f - p->cx)) * vf_set(p->inv_fx);
        const vf ray_y = (y + vf_set(0.5f - p->cy)) * vf_set(-p->inv_fy);
        s.ray2 = vf_fma(ray_x, ray_x, vf_fma(ray_y, ray_y, one));
        s.ray_x2 = ray_x + ray_x;
        s.ray_y2 = ray_y + ray_y;
        s.b = vf_fma(s.c.x, ray_x, vf_fma(s.c.y, ray_y, -s.c.z));
        s.bx = s.c.x - ray_x;
        s.by = s.c.y - ray_y;
        span = span * s.inverse;
    }
    s.lack = vf_fma(span, span, -crv__v3_dot(s.c, s.c));
    s.index = crv__lanes_index(&f->depth[0], at->x, vi_set(at->y));
    return s;
}

/* crv__pipe_through(). is_fair: nothing is decided by its numbers. */
CRV__INLINE chord chord_through(const crv__params *p, crv__shape shape, const sphere *s,
                                vf u, vf v, int is_fair)
{
    const vf x = u * vf_set(p->inv_fx), y = v * vf_set(-p->inv_fy);
    const vf squared = vf_fma(x, x, y * y);
    const vf rest =
        vf_fma(x, s->c.x + s->c.x, vf_fma(y, s->c.y + s->c.y, s->lack - squared));
    chord c = {s->b, rest};
    if (shape.orthographic) {
        c.half = vf_fma(s->c.z, s->c.z, rest);
    } else {
        const vf length2 = vf_fma(x, s->ray_x2, vf_fma(y, s->ray_y2, s->ray2 + squared));
        const vf inverse = vf_rcp(length2);
        c.middle = vf_fma(x, s->bx, vf_fma(y, s->by, s->b - squared)) * inverse;
        c.half = vf_fma(c.middle, c.middle, rest * inverse);
    }
    const vf least_normal = vf_set(0x1p-126f);
    c.half = vf_max(c.half, least_normal);
    c.half = c.half * (is_fair ? vf_rsqrt_fair(c.half) : vf_rsqrt(c.half));
    return c;
}

/* crv__open_length() less half the chord. */
CRV__INLINE vf open_part(const crv__frame *f, crv__shape shape, const sphere *s,
                         const chord *c, vi index, vm on)
{
    const vf half = c->half;
    vf open = half, from = -half;
    for (int32_t layer = 0; layer < shape.layers; layer += 2) {
        const vf depth = vf_gather(f->depth[layer].data, index, on);
        const vf behind = vf_fma(depth - s->nearer, s->inverse, -c->middle);
        const vf nearer = vf_max(vf_min(behind, half), -half);
        if (layer == 0)
            open = nearer;
        else
            open = open + vf_max(nearer - from, vf_zero());
        if (!shape.solid || layer + 1 >= shape.layers)
            return shape.within ? open : vf_select(on, open, half);
        /* Where the nearer is behind the end, so is the back: nothing is added. */
        const vf back = vf_gather(f->depth[layer + 1].data, index, on) - s->nearer;
        from = vf_max(from, vf_select(vf_lt(nearer, half),
                                      vf_fma(back, s->inverse, -c->middle), half));
    }
    return vf_select(on, open + vf_max(half - from, vf_zero()), half);
}

/* What all pipes of a sphere come to. */
typedef struct sums {
    vf open, halves; /* less half of the chords; half of the chords */
} sums;

/* Whether the spheres are before the eye, and none so large that texels would not fit
 * into integers. */
CRV__INLINE int all_before(const crv__params *p, crv__shape shape, const sphere *s,
                           vm active)
{
    const vf radius = vf_set(0.5001f * p->radius);
    vm before = vm_and(vf_lt(radius * s->scale_x, vf_set(1e8f)),
                       vf_lt(radius * s->scale_y, vf_set(1e8f)));
    if (!shape.orthographic)
        before = vm_and(before, vf_lt(radius, s->unit));
    return !vm_any(vm_and(active, vm_not(before)));
}

CRV__INLINE sums sums_of(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                         const sphere *s, int before)
{
    const crv__params *p = f->params;
    const int32_t pitch = (int32_t)f->depth[0].pitch;
    /* Whole numbers that a float holds. */
    const int is_small = shape.within && pitch <= (1 << 24) / p->height;
    const vf far_px = vf_set(1e9f);
    sums all = {vf_zero(), vf_zero()};
    for (int32_t i = 0; i < p->samples; i++) {
        vf x, y;
        crv__lanes_point(at, i, &x, &y);
        const vf u = vf_floor(s->u + x * s->scale_x), v = vf_floor(s->v - y * s->scale_y);
        const vi du = vi_trunc(u), dv = vi_trunc(v);
        const vi step = is_small ? vi_trunc(vf_fma(v, vf_set((float)pitch), u))
                                 : vi_add(du, vi_mul(dv, vi_set(pitch)));
        const vi index = vi_add(s->index, step);
        const chord c = chord_through(p, shape, s, u, v, before && shape.layers == 1);
        vm in = at->active, on = in;
        if (!before) {
            in = vm_and(in, vm_and(vf_lt(vf_abs(u), far_px), vf_lt(vf_abs(v), far_px)));
            in = vm_and(in, vf_lt(vf_zero(), s->unit));
            if (!shape.orthographic)
                in = vm_and(in, vf_lt(c.half - c.middle, vf_set(1)));
        }
        if (!shape.within) {
            on = vm_and(in, vi_below(vi_add(at->x, du), vi_set(p->width)));
            on = vm_and(on, vi_below(vi_add(vi_set(at->y), dv), vi_set(p->height)));
        }
        const vf part = p->use_depth ? open_part(f, shape, s, &c, index, on) : c.half;
        all.open = all.open + (before ? part : vf_where(in, part));
        all.halves = all.halves + (before ? c.half : vf_where(in, c.half));
    }
    return all;
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const sphere s = sphere_at(f, shape, at);
    const sums all = shape.within || all_before(p, shape, &s, at->active)
                         ? sums_of(f, shape, at, &s, 1)
                         : sums_of(f, shape, at, &s, 0);
    const vf open = all.open + all.halves, whole = all.halves + all.halves;
    if (p->normaliser == CRV_NORMALISER_ANALYTIC)
        return open / (s.inverse * vf_set(2.0f / 3.0f * p->radius * (float)p->samples));
    /* Chords that there are not come to 1e-19 each. */
    return vf_select(vf_lt(vf_set(1e-15f), whole), open / whole, vf_set(1));
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const vf radius = vf_set(0.5f * p->radius);
    const crv__v3 centre = crv__v3_add_scaled(at->P, at->n, radius);
    return crv__lanes_within(p, centre, vf_set(0.5001f * p->radius), at->active);
}

CRV__ESTIMATE_KERNEL(vao, 0.5f * f->params->radius)
