/* SPDX-License-Identifier: MIT */
/* methods/vao.c for the lanes of a vector: fields are not for it. */
#include "cpu/kernels/march.h"

/* The tangent sphere, as methods/pipe.h has it, and what its pipes share. Places are
 * reckoned from P: pixels from its own, u to the right and v down, depths from `near`. */
typedef struct sphere {
    crv__v3 offset;      /* of the centre from P */
    vf unit;             /* depth of the centre */
    vf scale_x, scale_y; /* px per scene unit there */
    vf u, v;             /* of the centre, px */
    vf ray_x, ray_y;     /* of P's view ray (x, y, -1) */
    vf pixel_x, pixel_y; /* at P's depth, scene units */
    vf radius2;
    vf near;  /* see crv__pipe_outside() */
    vi index; /* of P's texel */
} sphere;

/* The sphere's part on the view ray of texel (u, v): `middle` +- `half` by depth, from
 * P's. Half is 0 where the ray misses the sphere. */
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
    sphere s = {.offset = offset, .near = at->depth * vf_set(1 - 2e-6f)};
    s.unit = shape.orthographic ? one : at->depth - offset.z;
    const vf inverse = one / s.unit;
    s.scale_x = vf_set(p->fx) * inverse;
    s.scale_y = vf_set(p->fy) * inverse;
    s.u = vf_set(p->cx) + (at->P.x + offset.x) * s.scale_x - x;
    s.v = vf_set(p->cy) - (at->P.y + offset.y) * s.scale_y - y;
    s.pixel_x = vf_set(p->inv_fx);
    s.pixel_y = vf_set(p->inv_fy);
    s.ray_x = s.ray_y = vf_zero();
    if (!shape.orthographic) {
        s.pixel_x = s.pixel_x * at->depth;
        s.pixel_y = s.pixel_y * at->depth;
        s.ray_x = (x + vf_set(0.5f - p->cx)) * vf_set(p->inv_fx);
        s.ray_y = (y + vf_set(0.5f - p->cy)) * vf_set(-p->inv_fy);
    }
    s.radius2 = vf_set(radius * radius);
    s.index = crv__lanes_index(&f->depth[0], at->x, vi_set(at->y));
    return s;
}

/* crv__pipe_through(): |t ray - to| = radius with ray = (ray_x, ray_y, -1). */
CRV__INLINE chord chord_through(const crv__params *p, crv__shape shape, const sphere *s,
                                vf u, vf v)
{
    const vf x = vf_fma(u, -s->pixel_x, s->offset.x);
    const vf y = vf_fma(v, s->pixel_y, s->offset.y);
    chord c = {-s->offset.z, vf_fma(-x, x, vf_fma(-y, y, s->radius2))};
    if (!shape.orthographic) {
        const vf ray_x = vf_fma(u, vf_set(p->inv_fx), s->ray_x);
        const vf ray_y = vf_fma(v, vf_set(-p->inv_fy), s->ray_y);
        const vf squared = vf_fma(ray_x, ray_x, vf_fma(ray_y, ray_y, vf_set(1)));
        const vf inverse = vf_rcp(squared);
        c.middle = vf_fma(x, ray_x, vf_fma(y, ray_y, c.middle)) * inverse;
        /* About the point nearest to the centre: on the way there and back much may
         * cancel. */
        const crv__v3 miss = {vf_fma(-c.middle, ray_x, x), vf_fma(-c.middle, ray_y, y),
                              s->offset.z + c.middle};
        c.half = vf_fma(-miss.x, miss.x, vf_fma(-miss.y, miss.y, s->radius2));
        c.half = vf_fma(-miss.z, miss.z, c.half) * inverse;
    }
    c.half = vf_max(c.half, vf_zero());
    c.half = crv__lanes_root(c.half);
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
        const vf front = vf_max(vf_min((depth - s->near) - c->middle, half), -half);
        if (layer == 0)
            open = front;
        else
            open = open + vf_max(front - from, vf_zero());
        if (!shape.solid || layer + 1 >= shape.layers)
            return shape.within ? open : vf_select(on, open, half);
        /* Where the front is behind the end, so is the back: nothing is added. */
        const vf back = vf_gather(f->depth[layer + 1].data, index, on) - s->near;
        from = vf_max(from, vf_select(vf_lt(front, half), back - c->middle, half));
    }
    return vf_select(on, open + vf_max(half - from, vf_zero()), half);
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const sphere s = sphere_at(f, shape, at);
    const vi pitch = vi_set((int32_t)f->depth[0].pitch);
    const vf far_px = vf_set(1e9f);
    vf open = vf_zero(), halves = vf_zero();
    for (int32_t i = 0; i < p->samples; i++) {
        vf x, y;
        crv__lanes_point(at, i, &x, &y);
        const vf u = vf_floor(s.u + x * s.scale_x), v = vf_floor(s.v - y * s.scale_y);
        const vi du = vi_trunc(u), dv = vi_trunc(v);
        const vi index = vi_add(vi_add(s.index, du), vi_mul(dv, pitch));
        const chord c = chord_through(p, shape, &s, u, v);
        vm in = at->active, on = in;
        if (!shape.within) {
            in = vm_and(in, vm_and(vf_lt(vf_abs(u), far_px), vf_lt(vf_abs(v), far_px)));
            in = vm_and(in, vf_lt(vf_zero(), s.unit));
            if (!shape.orthographic)
                in = vm_and(in, vf_lt(vf_zero(), at->depth + (c.middle - c.half)));
            on = vm_and(in, vi_below(vi_add(at->x, du), vi_set(p->width)));
            on = vm_and(on, vi_below(vi_add(vi_set(at->y), dv), vi_set(p->height)));
        }
        const vf part = p->use_depth ? open_part(f, shape, &s, &c, index, on) : c.half;
        open = open + (shape.within ? part : vf_where(in, part));
        halves = halves + (shape.within ? c.half : vf_where(in, c.half));
    }
    open = open + halves;
    if (p->normaliser == CRV_NORMALISER_ANALYTIC)
        return open / vf_set(2.0f / 3.0f * p->radius * (float)p->samples);
    return vf_select(vf_lt(vf_zero(), halves), open / (halves + halves), vf_set(1));
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const vf radius = vf_set(0.5f * p->radius);
    const crv__v3 centre = crv__v3_add_scaled(at->P, at->n, radius);
    return crv__lanes_within(p, centre, vf_set(0.5001f * p->radius), at->active);
}

CRV__ESTIMATE_KERNEL(vao, 0.5f * f->params->radius)
