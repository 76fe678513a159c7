/* SPDX-License-Identifier: MIT */
/* methods/containment.c for the lanes of a vector. */
#include "cpu/kernels/outside.h"

/* The lanes whose ray from `lifted` to `offset` is free. */
CRV__INLINE vm free_rays(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                         crv__v3 lifted, crv__v3 offset)
{
    const crv__params *p = f->params;
    const vf radius = vf_set(p->radius), steps = vf_set((float)p->steps);
    vm open = at->active;
    for (int32_t i = 1; i < p->steps; i++) {
        const vf part = (vf_set((float)i) + vf_set(0.5f) * at->beta) / steps;
        const crv__v3 q = crv__v3_add_scaled(lifted, offset, part * radius);
        open = vm_and(open, vm_not(crv__lanes_inside(f, shape, q, open, p->thickness)));
        if (!vm_any(open))
            return open;
    }
    const crv__v3 q = crv__v3_add_scaled(lifted, offset, radius);
    return vm_and(open, vm_not(crv__lanes_inside(f, shape, q, open, p->thickness)));
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__v3 lifted = crv__lanes_lift(p, shape, at->P, at->n);
    crv__v3 tangent, bitangent;
    crv__lanes_tangents(at->n, &tangent, &bitangent);
    vf sum = vf_set(p->falloff == CRV_FALLOFF_ALCHEMY ? 1 : 0);
    for (int32_t i = 0; i < p->samples; i++) {
        const float *point = f->pattern + 4 * i;
        vf x, y;
        crv__lanes_point(at, i, &x, &y);
        const vf z = vf_set(point[2]);
        const crv__v3 offset = {x * tangent.x + y * bitangent.x + z * at->n.x,
                                x * tangent.y + y * bitangent.y + z * at->n.y,
                                x * tangent.z + y * bitangent.z + z * at->n.z};
        /* Without the depth buffer nothing is inside of anything. */
        const vm open =
            p->use_depth ? free_rays(f, shape, at, lifted, offset) : at->active;
        sum = sum + vf_where(open, vf_set(point[3]));
    }
    return sum;
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__shape shape = {0};
    const crv__v3 lifted = crv__lanes_lift(p, shape, at->P, at->n);
    return crv__lanes_within(p, shape, lifted, vf_set(p->radius * 1.0001f), at->active);
}

CRV__ESTIMATE_KERNEL(containment)
