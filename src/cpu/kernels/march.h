/* SPDX-License-Identifier: MIT */
/*
 * methods/march.h for the lanes of a vector: walks through view space and looks points up
 * in the depth buffer. Everything that a position depends on is rounded as there.
 */
#ifndef CRV_CPU_KERNELS_MARCH_H
#define CRV_CPU_KERNELS_MARCH_H

#include "cpu/kernels/lanes.h"

CRV__INLINE void crv__lanes_tangents(crv__v3 n, crv__v3 *t, crv__v3 *b)
{
    const vf one = vf_set(1);
    const vf scale = one / (one + vf_max(n.z, vf_set(-0.9999f)));
    const vf xy = -n.x * n.y * scale;
    *t = (crv__v3){one - n.x * n.x * scale, xy, -n.x};
    *b = (crv__v3){xy, one - n.y * n.y * scale, -n.y};
}

CRV__INLINE crv__v3 crv__lanes_slice_tangent(const crv__pixels *at, int32_t k, crv__v3 t,
                                             crv__v3 b)
{
    vf x, y;
    crv__lanes_point(at, k, &x, &y);
    return (crv__v3){x * t.x + y * b.x, x * t.y + y * b.y, x * t.z + y * b.z};
}

CRV__INLINE crv__v3 crv__lanes_raised(crv__v3 n, crv__v3 t, vf z2)
{
    const vf z = vf_sqrt(z2), xy = vf_sqrt(vf_max(vf_set(1) - z2, vf_zero()));
    return (crv__v3){z * n.x + xy * t.x, z * n.y + xy * t.y, z * n.z + xy * t.z};
}

CRV__INLINE crv__v3 crv__lanes_lift(const crv__params *p, crv__shape shape, crv__v3 P,
                                    crv__v3 n)
{
    const vf focal = vf_set(p->fx < p->fy ? p->fx : p->fy);
    return crv__v3_add_scaled(P, n, (shape.orthographic ? vf_set(1) : -P.z) / focal);
}

/* Whether every point within `reach` of the active lanes' points lies before the eye and
 * on the buffers, so that none of them need be tested. */
CRV__INLINE int crv__lanes_within(const crv__params *p, crv__shape shape, crv__v3 P,
                                  vf reach, vm active)
{
    const vf one = vf_set(1), zero = vf_zero();
    const vf nearest = -P.z - reach, farthest = -P.z + reach;
    /* Of the four corners of the square around P the outermost, a pixel more for all
     * rounding. */
    vf inverse_near = one, inverse_far = one;
    if (!shape.orthographic) {
        inverse_near = one / nearest;
        inverse_far = one / farthest;
    }
    const vf left = P.x - reach, right = P.x + reach;
    const vf low = P.y - reach, high = P.y + reach;
    const vf fx = vf_set(p->fx), fy = vf_set(p->fy);
    const vf x0 = fx * left * vf_select(vf_lt(left, zero), inverse_near, inverse_far);
    const vf x1 = fx * right * vf_select(vf_lt(zero, right), inverse_near, inverse_far);
    const vf y0 = fy * low * vf_select(vf_lt(low, zero), inverse_near, inverse_far);
    const vf y1 = fy * high * vf_select(vf_lt(zero, high), inverse_near, inverse_far);
    vm inside = vm_and(vf_lt(vf_set(1 - p->cx), x0),
                       vf_lt(x1, vf_set((float)p->width - p->cx - 1)));
    inside = vm_and(inside, vm_and(vf_lt(vf_set(p->cy - (float)p->height + 1), y0),
                                   vf_lt(y1, vf_set(p->cy - 1))));
    if (!shape.orthographic)
        inside = vm_and(inside, vf_lt(zero, nearest));
    return !vm_any(vm_and(active, vm_not(inside)));
}

/* Texels that points fall on. */
typedef struct crv__texels {
    vi u, v;
    vm in; /* the lanes whose point is before the eye and on the buffers */
} crv__texels;

/* crv__texel_of(). shape.within: no point of an active lane leaves the buffers. */
CRV__INLINE crv__texels crv__lanes_texels(const crv__params *p, crv__shape shape,
                                          crv__v3 Q, vm active)
{
    const vf unit = -Q.z;
    vf x = vf_set(p->fx) * Q.x, y = vf_set(p->fy) * Q.y;
    if (!shape.orthographic)
        vf_quotients(x, y, unit, &x, &y);
    crv__texels texels = {vi_floor(vf_set(p->cx) + x), vi_floor(vf_set(p->cy) - y),
                          active};
    if (!shape.within) {
        const vm on = vm_and(vi_below(texels.u, vi_set(p->width)),
                             vi_below(texels.v, vi_set(p->height)));
        texels.in = vm_and(texels.in, on);
        if (!shape.orthographic)
            texels.in = vm_and(texels.in, vf_lt(vf_zero(), unit));
    }
    return texels;
}

/* crv__back_of() */
CRV__INLINE vf crv__lanes_back(const crv__frame *f, crv__shape shape, int32_t layer,
                               vi index, vm mask, vf d, vf thickness)
{
    return shape.solid && layer + 1 < shape.layers
               ? vf_gather(f->depth[layer + 1].data, index, mask)
               : d + thickness;
}

/* crv__blocked(). Lanes that are not `active` are not blocked. *to: from the origin to
 * the surface point; *squared: its length. Both hold anything where not blocked. */
CRV__INLINE vm crv__lanes_blocked(const crv__frame *f, crv__shape shape, crv__v3 origin,
                                  crv__v3 Q, vm active, crv__v3 *to, vf *squared)
{
    const crv__params *p = f->params;
    const crv__texels at = crv__lanes_texels(p, shape, Q, active);
    const vi index = crv__lanes_index(&f->depth[0], at.u, at.v);
    vm open = at.in, blocked = vm_none();
    for (int32_t layer = 0; layer < shape.layers; layer += 1 + shape.solid) {
        const vf d = vf_gather(f->depth[layer].data, index, open);
        vm behind = vm_and(open, vf_lt(d, -Q.z));
        if (!vm_any(behind))
            continue;
        const vf back =
            crv__lanes_back(f, shape, layer, index, behind, d, vf_set(p->thickness));
        behind = vm_and(behind, vf_lt(-Q.z, back));
        const crv__v3 I = crv__lanes_unproject_at(p, shape, at.u, at.v, d);
        const crv__v3 v = crv__v3_sub(I, origin);
        const vf length2 = crv__v3_dot(v, v);
        behind = vm_and(behind, vf_lt(length2, vf_set(p->radius * p->radius)));
        if (layer == 0) {
            *to = v;
            *squared = length2;
        } else {
            to->x = vf_select(behind, v.x, to->x);
            to->y = vf_select(behind, v.y, to->y);
            to->z = vf_select(behind, v.z, to->z);
            *squared = vf_select(behind, length2, *squared);
        }
        blocked = vm_or(blocked, behind);
        if (shape.layers == 1)
            break;
        open = vm_and(open, vm_not(behind));
        if (!vm_any(open))
            break;
    }
    return blocked;
}

/* The distances from the origin of the steps of a march: (i + beta) * radius / steps. */
CRV__INLINE vf crv__lanes_step(const crv__params *p, const crv__pixels *at, int32_t i)
{
    const float step = p->radius / (float)p->steps;
    return (vf_set((float)i) + at->beta) * vf_set(step);
}

/* Whether the march of every active lane, from its lifted point, stays on the buffers:
 * the last step may reach 1 / steps of the radius beyond it. */
CRV__INLINE int crv__march_within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__shape shape = {.orthographic = 0};
    const float reach = p->radius * (1 + 1 / (float)p->steps) * 1.0001f;
    const crv__v3 origin = crv__lanes_lift(p, shape, at->P, at->n);
    return crv__lanes_within(p, shape, origin, vf_set(reach), at->active);
}

/* crv__march(): the falloff's weight of the first thing in the way, by lane. */
CRV__INLINE vf crv__lanes_march(const crv__frame *f, crv__shape shape,
                                const crv__pixels *at, crv__v3 origin, crv__v3 direction)
{
    const crv__params *p = f->params;
    vm open = at->active;
    vf nearest = vf_set(INFINITY);
    for (int32_t i = 1; i <= p->steps; i++) {
        crv__v3 to = origin;
        vf squared = vf_zero();
        const crv__v3 Q =
            crv__v3_add_scaled(origin, direction, crv__lanes_step(p, at, i));
        const vm blocked = crv__lanes_blocked(f, shape, origin, Q, open, &to, &squared);
        if (!vm_any(blocked))
            continue;
        nearest = vf_select(blocked, squared, nearest);
        open = vm_and(open, vm_not(blocked));
        if (!vm_any(open))
            break;
    }
    return vf_where(vf_lt(nearest, vf_set(INFINITY)),
                    crv__lanes_falloff(p, vf_sqrt(nearest) * vf_set(p->inv_radius)));
}

#endif
