/* SPDX-License-Identifier: MIT */
/* methods/vao.c for the lanes of a vector: fields are not for it. */
#include "cpu/kernels/march.h"

/* The tangent sphere, and pipes through it as methods/pipe.h has them. */
typedef struct sphere {
    vf radius;
    crv__v3 offset; /* of the centre from P */
    vf unit;        /* depth of the centre */
    vf centre_x, centre_y;
    vf ray_x, ray_y;     /* of P's view ray (x, y, -1) */
    vf pixel_x, pixel_y; /* at P's depth, scene units */
    vf x, y;             /* P's pixel */
} sphere;

typedef struct pipes {
    vi u, v;
    vm in;
    vf entry, exit; /* depth; equal where the ray misses the sphere */
} pipes;

CRV__INLINE sphere sphere_at(const crv__params *p, crv__shape shape,
                             const crv__pixels *at)
{
    const vf radius = vf_set(0.5f * p->radius);
    sphere s = {.radius = radius,
                .offset = {at->n.x * radius, at->n.y * radius, at->n.z * radius}};
    s.unit = shape.orthographic ? vf_set(1) : at->depth - s.offset.z;
    s.centre_x = at->P.x + s.offset.x;
    s.centre_y = at->P.y + s.offset.y;
    s.pixel_x = vf_set(p->inv_fx);
    s.pixel_y = vf_set(p->inv_fy);
    s.x = vf_of(at->x);
    s.y = vf_set((float)at->y);
    s.ray_x = s.ray_y = vf_zero();
    if (!shape.orthographic) {
        s.pixel_x = s.pixel_x * at->depth;
        s.pixel_y = s.pixel_y * at->depth;
        s.ray_x = at->P.x / at->depth;
        s.ray_y = at->P.y / at->depth;
    }
    return s;
}

/* crv__pipe_through() */
CRV__INLINE pipes pipes_through(const crv__params *p, crv__shape shape,
                                const crv__pixels *at, const sphere *s, vf x, vf y)
{
    const vf zero = vf_zero(), far_px = vf_set(1e9f);
    vf sx = vf_set(p->fx) * (s->centre_x + x), sy = vf_set(p->fy) * (s->centre_y + y);
    if (!shape.orthographic) {
        sx = sx / s->unit;
        sy = sy / s->unit;
    }
    sx = vf_set(p->cx) + sx;
    sy = vf_set(p->cy) - sy;
    pipes pipe = {.u = vi_floor(sx), .v = vi_floor(sy), .in = at->active};
    if (!shape.within)
        pipe.in = vm_and(
            pipe.in, vm_and(vm_and(vf_lt(vf_abs(sx), far_px), vf_lt(vf_abs(sy), far_px)),
                            vf_lt(zero, s->unit)));
    const vf across = vf_of(pipe.u) - s->x, up = s->y - vf_of(pipe.v);
    const crv__v3 to = {vf_fma(across, -s->pixel_x, s->offset.x),
                        vf_fma(up, -s->pixel_y, s->offset.y), s->offset.z};
    /* |t ray - to| = radius with ray = (ray_x, ray_y, -1), about the point nearest to the
     * centre: on the way there and back much may cancel. */
    vf middle = -to.z, inverse = vf_set(1);
    crv__v3 miss = {to.x, to.y, vf_zero()};
    if (!shape.orthographic) {
        const vf ray_x = vf_fma(across, vf_set(p->inv_fx), s->ray_x);
        const vf ray_y = vf_fma(up, vf_set(p->inv_fy), s->ray_y);
        inverse = inverse / vf_fma(ray_x, ray_x, vf_fma(ray_y, ray_y, inverse));
        middle = vf_fma(to.x, ray_x, vf_fma(to.y, ray_y, middle)) * inverse;
        miss = (crv__v3){vf_fma(-middle, ray_x, to.x), vf_fma(-middle, ray_y, to.y),
                         to.z + middle};
    }
    const vf miss2 = vf_fma(miss.x, miss.x, vf_fma(miss.y, miss.y, miss.z * miss.z));
    const vf rest = s->radius * s->radius - miss2;
    const vf half = vf_sqrt(vf_max(rest, zero) * inverse);
    pipe.entry = at->depth + (middle - half);
    pipe.exit = at->depth + (middle + half);
    /* Where the ray misses the sphere, both lengths come to 0. */
    if (!shape.orthographic && !shape.within)
        pipe.in = vm_and(pipe.in, vf_lt(zero, pipe.entry));
    return pipe;
}

/* crv__open_length() */
CRV__INLINE vf open_lengths(const crv__frame *f, crv__shape shape, const pipes *pipe,
                            vf from, vf to)
{
    const crv__params *p = f->params;
    const vi index = crv__lanes_index(&f->depth[0], pipe->u, pipe->v);
    vm on = pipe->in;
    if (!shape.within)
        on = vm_and(on, vm_and(vi_below(pipe->u, vi_set(p->width)),
                               vi_below(pipe->v, vi_set(p->height))));
    const vf all = to - from;
    vf open = vf_zero();
    for (int32_t layer = 0; layer < shape.layers; layer += 2) {
        const vf front = vf_gather(f->depth[layer].data, index, on);
        open = open + vf_max(vf_min(front, to) - from, vf_zero());
        if (!shape.solid || layer + 1 >= shape.layers)
            return shape.within ? open : vf_select(on, open, all);
        /* Where the front is behind the end, so is the back: nothing is added. */
        const vf back = vf_gather(f->depth[layer + 1].data, index, on);
        from = vf_max(from, vf_select(vf_lt(front, to), back, to));
    }
    return vf_select(on, open + vf_max(to - from, vf_zero()), all);
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const sphere s = sphere_at(p, shape, at);
    /* See crv__pipe_outside(). */
    const vf nearer = vf_set(1 - 2e-6f);
    vf open = vf_zero(), chords = vf_zero();
    for (int32_t i = 0; i < p->samples; i++) {
        vf x, y;
        crv__lanes_point(at, i, &x, &y);
        const pipes pipe = pipes_through(p, shape, at, &s, x, y);
        const vf chord = pipe.exit - pipe.entry;
        const vf length =
            p->use_depth
                ? open_lengths(f, shape, &pipe, pipe.entry * nearer, pipe.exit * nearer)
                : chord;
        open = open + (shape.within ? length : vf_where(pipe.in, length));
        chords = chords + (shape.within ? chord : vf_where(pipe.in, chord));
    }
    if (p->normaliser == CRV_NORMALISER_ANALYTIC)
        return open / vf_set(2.0f / 3.0f * p->radius * (float)p->samples);
    return vf_select(vf_lt(vf_zero(), chords), open / chords, vf_set(1));
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const sphere s = sphere_at(p, (crv__shape){0}, at);
    const crv__v3 centre = {s.centre_x, s.centre_y, at->P.z + s.offset.z};
    return crv__lanes_within(p, centre, vf_set(0.5001f * p->radius), at->active);
}

CRV__ESTIMATE_KERNEL(vao, 0.5f * f->params->radius)
