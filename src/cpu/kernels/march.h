/* SPDX-License-Identifier: MIT */
/*
 * methods/march.h for the lanes of a vector: marches through view space and looks points
 * up in the depth buffer. Everything that a position depends on is rounded as there.
 */
#ifndef CRV_CPU_KERNELS_MARCH_H
#define CRV_CPU_KERNELS_MARCH_H

#include "cpu/kernels/bent.h"

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

/* The least and the greatest slope a / z of points within `distance` of (a, z) in a plane
 * through the eye: those of the tangents to the circle. distance < z. */
CRV__INLINE void crv__lanes_slopes(vf a, vf z, vf distance, vf *least, vf *greatest)
{
    const vf z2 = z * z, distance2 = distance * distance,
             inverse = vf_rcp(z2 - distance2);
    const vf middle = a * z * inverse;
    const vf half = distance * crv__lanes_root(a * a + z2 - distance2) * inverse;
    *least = middle - half;
    *greatest = middle + half;
}

/* Whether every point within `distance` of the active lanes' points lies before the eye
 * and on the buffers, so that none of them need be tested. Perspective. */
CRV__INLINE int crv__lanes_within(const crv__params *p, crv__v3 P, vf distance, vm active)
{
    vf left, right, low, high;
    crv__lanes_slopes(P.x, -P.z, distance, &left, &right);
    crv__lanes_slopes(P.y, -P.z, distance, &low, &high);
    /* A pixel less for all rounding. */
    const vf fx = vf_set(p->fx), fy = vf_set(p->fy);
    vm inside = vm_and(vf_lt(vf_set(1 - p->cx), fx * left),
                       vf_lt(fx * right, vf_set((float)p->width - p->cx - 1)));
    inside = vm_and(inside, vf_lt(vf_set(p->cy - (float)p->height + 1), fy * low));
    inside = vm_and(inside, vf_lt(fy * high, vf_set(p->cy - 1)));
    inside = vm_and(inside, vf_lt(distance * vf_set(1.001f), -P.z));
    return !vm_any(vm_and(active, vm_not(inside)));
}

/* Texels that points fall on. */
typedef struct crv__texels {
    vi u, v;
    vm in; /* the lanes whose point is before the eye and on the buffers */
} crv__texels;

/* crv__texel_of(). shape.within: no point of an
 * active lane leaves the buffers. */
CRV__INLINE crv__texels crv__lanes_texels(const crv__params *p, crv__shape shape,
                                          crv__v3 Q, vm active)
{
    const vf unit = -Q.z, cx = vf_set(p->cx), cy = vf_set(p->cy);
    crv__texels texels = {.in = active};
    vf x = vf_set(p->fx) * Q.x, y = vf_set(p->fy) * Q.y;
    if (!shape.orthographic) {
        const vf inverse = vf_set(1) / unit;
        x = x * inverse;
        y = y * inverse;
    }
    texels.u = vi_floor(cx + x);
    texels.v = vi_floor(cy - y);
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

/* A point of a march, looked up in the depth buffer. */
typedef struct crv__lookup {
    vi u, v;
    vf front; /* of the first layer there */
    vf depth; /* of the point; where there are several layers */
    vm open;  /* lanes that may be blocked: one layer alone is decided but for the radius
               */
} crv__lookup;

CRV__INLINE void crv__lanes_look_up(const crv__frame *f, crv__shape shape, crv__v3 Q,
                                    vm active, crv__lookup *look)
{
    const crv__texels at = crv__lanes_texels(f->params, shape, Q, active);
    const vi index = crv__lanes_index(&f->depth[0], at.u, at.v);
    look->u = at.u;
    look->v = at.v;
    look->front = vf_gather(f->depth[0].data, index, at.in);
    if (shape.layers == 1) {
        const vm behind = vm_and(at.in, vf_lt(look->front, -Q.z));
        const vf back = look->front + vf_set(f->params->thickness);
        look->open = vm_and(behind, vf_lt(-Q.z, back));
    } else {
        look->depth = -Q.z;
        look->open = at.in;
    }
}

/* crv__blocked() of a point whose look is open in some lane. *to: from the origin to the
 * surface point; *squared: its length. Both hold anything where not blocked. */
CRV__INLINE vm crv__lanes_blocked(const crv__frame *f, crv__shape shape, crv__v3 origin,
                                  const crv__lookup *look, crv__v3 *to, vf *squared)
{
    const crv__params *p = f->params;
    const vf radius2 = vf_set(p->radius * p->radius);
    *to = crv__v3_sub(crv__lanes_unproject_at(p, shape, look->u, look->v, look->front),
                      origin);
    *squared = crv__v3_dot(*to, *to);
    if (shape.layers == 1)
        return vm_and(look->open, vf_lt(*squared, radius2));

    const vi index = crv__lanes_index(&f->depth[0], look->u, look->v);
    vm open = look->open, blocked = vm_none();
    for (int32_t layer = 0; layer < shape.layers; layer += 1 + shape.solid) {
        const vf d = vf_gather(f->depth[layer].data, index, open);
        vm behind = vm_and(open, vf_lt(d, look->depth));
        const vf back =
            crv__lanes_back(f, shape, layer, index, behind, d, vf_set(p->thickness));
        behind = vm_and(behind, vf_lt(look->depth, back));
        const crv__v3 v =
            crv__v3_sub(crv__lanes_unproject_at(p, shape, look->u, look->v, d), origin);
        const vf length2 = crv__v3_dot(v, v);
        behind = vm_and(behind, vf_lt(length2, radius2));
        to->x = vf_select(behind, v.x, to->x);
        to->y = vf_select(behind, v.y, to->y);
        to->z = vf_select(behind, v.z, to->z);
        *squared = vf_select(behind, length2, *squared);
        blocked = vm_or(blocked, behind);
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
 * the last step may distance 1 / steps of the radius beyond it. */
CRV__INLINE int crv__march_within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__shape shape = {.orthographic = 0};
    const float distance = p->radius * (1 + 1 / (float)p->steps) * 1.0001f;
    const crv__v3 origin = crv__lanes_lift(p, shape, at->P, at->n);
    return crv__lanes_within(p, origin, vf_set(distance), at->active);
}

/*
 * Marches in several directions run side by side: the look-ups of a step do not wait for
 * each other, and they share the delay of a mispredicted branch.
 */
enum { CRV__MARCHES = 8 };

/* crv__march() of `count` directions: the falloff's weight of the first thing in the way,
 * by lane. */
CRV__INLINE void crv__lanes_march(const crv__frame *f, crv__shape shape,
                                  const crv__pixels *at, crv__v3 origin, int32_t count,
                                  const crv__v3 directions[CRV__MARCHES],
                                  vf weights[CRV__MARCHES])
{
    const crv__params *p = f->params;
    const vf infinity = vf_set(INFINITY);
    crv__lookup looks[CRV__MARCHES];
    vm open[CRV__MARCHES], any = at->active;
    for (int32_t k = 0; k < count; k++) {
        open[k] = at->active;
        weights[k] = infinity; /* at first the nearest squared distance */
    }
    for (int32_t i = 1; i <= p->steps && vm_any(any); i++) {
        const vf step = crv__lanes_step(p, at, i);
        for (int32_t k = 0; k < count; k++) {
            if (vm_any(open[k]))
                crv__lanes_look_up(f, shape,
                                   crv__v3_add_scaled(origin, directions[k], step),
                                   open[k], &looks[k]);
        }
        any = vm_none();
        for (int32_t k = 0; k < count; k++) {
            if (vm_any(open[k]) && vm_any(looks[k].open)) {
                crv__v3 to;
                vf squared;
                const vm blocked =
                    crv__lanes_blocked(f, shape, origin, &looks[k], &to, &squared);
                weights[k] = vf_select(blocked, squared, weights[k]);
                open[k] = vm_and(open[k], vm_not(blocked));
            }
            any = vm_or(any, open[k]);
        }
    }
    for (int32_t k = 0; k < count; k++) {
        const vf q = crv__lanes_root(weights[k]) * vf_set(p->inv_radius);
        weights[k] = vf_where(vf_lt(weights[k], infinity), crv__lanes_falloff(p, q));
    }
}

#endif
