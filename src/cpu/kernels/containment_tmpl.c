/* SPDX-License-Identifier: MIT */
/* methods/containment.c for the lanes of a vector. */
#include "cpu/kernels/outside.h"

/* Rays go side by side: the look-ups of a step do not wait for each other. */
enum { RAYS = 8 };

/* Leaves in open[] the lanes whose rays from `lifted` to the offsets are free. */
CRV__INLINE void follow(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                        crv__v3 lifted, int32_t count, const crv__v3 offsets[RAYS],
                        vm open[RAYS])
{
    const crv__params *p = f->params;
    const vf radius = vf_set(p->radius), steps = vf_set((float)p->steps);
    for (int32_t i = 1; i <= p->steps; i++) {
        const vf part = (vf_set((float)i) + vf_set(0.5f) * at->beta) / steps;
        const vf distance = i < p->steps ? part * radius : radius;
        for (int32_t k = 0; k < count; k++) {
            if (!vm_any(open[k]))
                continue;
            const crv__v3 q = crv__v3_add_scaled(lifted, offsets[k], distance);
            const vm inside = crv__lanes_inside(f, shape, q, open[k], p->thickness);
            open[k] = vm_and(open[k], vm_not(inside));
        }
    }
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__v3 lifted = crv__lanes_lift(p, shape, at->P, at->n), n = at->n;
    crv__v3 t, b;
    crv__lanes_tangents(n, &t, &b);
    vf sum = vf_set(p->falloff == CRV_FALLOFF_ALCHEMY ? 1 : 0);
    for (int32_t first = 0; first < p->samples; first += RAYS) {
        const int32_t rest = p->samples - first, count = rest < RAYS ? rest : RAYS;
        crv__v3 offsets[RAYS];
        vm open[RAYS];
        for (int32_t k = 0; k < count; k++) {
            const vf z = vf_set(f->pattern[4 * (first + k) + 2]);
            vf x, y;
            crv__lanes_point(at, first + k, &x, &y);
            offsets[k] =
                (crv__v3){x * t.x + y * b.x + z * n.x, x * t.y + y * b.y + z * n.y,
                          x * t.z + y * b.z + z * n.z};
            open[k] = at->active;
        }
        /* Without the depth buffer nothing is inside of anything. */
        if (p->use_depth)
            follow(f, shape, at, lifted, count, offsets, open);
        for (int32_t k = 0; k < count; k++)
            sum = sum + vf_where(open[k], vf_set(f->pattern[4 * (first + k) + 3]));
    }
    return sum;
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__v3 lifted = crv__lanes_lift(p, (crv__shape){0}, at->P, at->n);
    return crv__lanes_within(p, lifted, vf_set(p->radius * 1.0001f), at->active);
}

CRV__ESTIMATE_KERNEL(containment, 1)
