/* SPDX-License-Identifier: MIT */
/* methods/vo.c for the lanes of a vector. */
#include "cpu/kernels/lanes.h"

/* Chords of the sphere along the view axis, from -half to half about P. */
typedef struct chords {
    vi index; /* of the texel */
    vm on;    /* on the buffers; elsewhere chords are open */
    vf half;
} chords;

CRV__INLINE vf open_part(crv__shape shape, vf d, vf z, vf half)
{
    const vf behind = shape.orthographic ? z - d : d - d * (d / z);
    const vf part = vf_min(vf_max(behind, -half), half) + half;
    return vf_select(vf_lt(z, vf_set(INFINITY)), part, half + half);
}

CRV__INLINE vf open_length(const crv__frame *f, crv__shape shape, const chords *c, vf d)
{
    const vf length = c->half + c->half;
    vf open = vf_zero(), closed = vf_zero();
    for (int32_t layer = 0; layer < shape.layers; layer += 2) {
        const vf z = vf_gather(f->depth[layer].data, c->index, c->on);
        const vf front = open_part(shape, d, z, c->half);
        open = open + vf_max(front - closed, vf_zero());
        if (!shape.solid || layer + 1 >= shape.layers)
            return vf_select(c->on, open, length);
        const vf back = vf_gather(f->depth[layer + 1].data, c->index, c->on);
        closed = vf_max(front, open_part(shape, d, back, c->half));
    }
    return vf_select(c->on, open + length - closed, length);
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const vf one = vf_set(1), zero = vf_zero();
    const vf unit = shape.orthographic ? one : at->depth;
    const vf radius_x = vf_set(p->radius * p->fx) / unit;
    const vf radius_y = vf_set(p->radius * p->fy) / unit;
    /* Radii too small for a reciprocal reach the pixel's own texel only. */
    const vf least = vf_set(1e-30f);
    const vf inverse_x = one / vf_max(radius_x, least);
    const vf inverse_y = one / vf_max(radius_y, least);
    const vi y = vi_set(at->y), width = vi_set(p->width), height = vi_set(p->height);
    vf open = zero, total = zero;
    for (int32_t i = 0; i < p->samples; i++) {
        vf x, up;
        crv__lanes_point(at, i, &x, &up);
        const vi du = vi_round(x * radius_x), dv = vi_round(up * radius_y);
        const vi u = vi_add(at->x, du), v = vi_sub(y, dv);
        const vf offset_x = vf_of(du) * inverse_x, offset_y = vf_of(dv) * inverse_y;
        const vf rest = vf_max(one - offset_x * offset_x - offset_y * offset_y, zero);
        chords c = {crv__lanes_index(&f->depth[0], u, v), at->active,
                    vf_set(p->radius) * vf_sqrt(rest)};
        if (!shape.within)
            c.on = vm_and(c.on, vm_and(vi_below(u, width), vi_below(v, height)));
        /* Where the chord is empty both lengths are 0. */
        open = open + open_length(f, shape, &c, at->depth);
        total = total + c.half;
    }
    /* 2 open / (2 total) */
    const vf share = vf_select(vf_lt(zero, total), vf_min(open / total, one), one);
    /* Pixels farther out than this are background anyway, and no integers. */
    return vf_select(vf_lt(vf_max(radius_x, radius_y), vf_set(1e9f)), share, one);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    return crv__lanes_disk_within(p, at, vf_set(p->radius * p->fx) / at->depth,
                                  vf_set(p->radius * p->fy) / at->depth);
}

CRV__ESTIMATE_KERNEL(vo, 1)
