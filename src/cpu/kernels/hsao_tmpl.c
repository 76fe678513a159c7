/* SPDX-License-Identifier: MIT */
/* methods/hsao.c for the lanes of a vector. */
#include "cpu/kernels/march.h"

/* A slice and its horizon so far. */
typedef struct slice {
    crv__v3 t;            /* the tangent */
    crv__v3 h;            /* the horizon ray's direction */
    vf height, occlusion; /* see the scalar code */
    vf weight;            /* of what raised the horizon last */
} slice;

/* Raises the horizon where the look of step i is blocked. */
CRV__INLINE void raise_horizon(const crv__frame *f, crv__shape shape, crv__v3 origin,
                               crv__v3 n, const crv__lookup *look, int32_t i, slice *s)
{
    const crv__params *p = f->params;
    const crv__v3 t = s->t;
    crv__v3 to;
    vf squared;
    vm raise = crv__lanes_blocked(f, shape, origin, look, &to, &squared);
    const vf along_t = crv__v3_dot(to, t), along_n = crv__v3_dot(to, n);
    /* Above the horizon there is only what is above the tangent. */
    raise = vm_and(raise, vm_and(vf_lt(vf_zero(), along_t), vf_lt(vf_zero(), along_n)));
    /* The height turns the next positions: it is rounded as the scalar code's. */
    const vf scale = vf_set(1) / vf_sqrt(along_t * along_t + along_n * along_n);
    const vf height = along_n * scale, along = along_t * scale;
    const vf distance = crv__lanes_root(squared);
    raise = vm_and(raise, vf_lt(s->height, height));
    if (p->growing_sphere)
        raise = vm_and(raise,
                       vf_le(distance, vf_set((float)i * (p->radius / (float)p->steps))));
    const vf W = crv__lanes_falloff(p, distance * vf_set(p->inv_radius));
    const vf gain = height * height - s->height * s->height;
    s->occlusion = s->occlusion + vf_where(raise, gain * W);
    s->height = vf_select(raise, height, s->height);
    if (p->attenuation == CRV_ATTENUATION_HORIZON)
        s->weight = vf_select(raise, W, s->weight);
    s->h.x = vf_select(raise, height * n.x + along * t.x, s->h.x);
    s->h.y = vf_select(raise, height * n.y + along * t.y, s->h.y);
    s->h.z = vf_select(raise, height * n.z + along * t.z, s->h.z);
}

CRV__INLINE void trace_horizons(const crv__frame *f, crv__shape shape,
                                const crv__pixels *at, crv__v3 origin, int32_t count,
                                slice slices[CRV__MARCHES])
{
    const crv__params *p = f->params;
    crv__lookup looks[CRV__MARCHES];
    for (int32_t i = 1; i <= p->steps; i++) {
        const vf step = crv__lanes_step(p, at, i);
        for (int32_t k = 0; k < count; k++)
            crv__lanes_look_up(f, shape, crv__v3_add_scaled(origin, slices[k].h, step),
                               at->active, &looks[k]);
        for (int32_t k = 0; k < count; k++) {
            if (vm_any(looks[k].open))
                raise_horizon(f, shape, origin, at->n, &looks[k], i, &slices[k]);
        }
    }
    for (int32_t k = 0; k < count && p->attenuation == CRV_ATTENUATION_HORIZON; k++)
        slices[k].occlusion = slices[k].height * slices[k].height * slices[k].weight;
}

/* What the rays above the horizons hit, added to the slices' occlusion. */
CRV__INLINE void add_normal_rays(const crv__frame *f, crv__shape shape,
                                 const crv__pixels *at, crv__v3 origin, int32_t first,
                                 int32_t count, slice slices[CRV__MARCHES])
{
    const crv__params *p = f->params;
    const vf rays = vf_set((float)p->normal_rays), one = vf_set(1);
    crv__v3 directions[CRV__MARCHES];
    vf weights[CRV__MARCHES], blocked[CRV__MARCHES];
    for (int32_t k = 0; k < count; k++)
        blocked[k] = vf_zero();
    for (int32_t ray = 0; ray < p->normal_rays; ray++) {
        for (int32_t k = 0; k < count; k++) {
            const vf squared = slices[k].height * slices[k].height;
            const vf stratum = vf_set((float)ray) + crv__lanes_stratum(at, first + k);
            directions[k] = crv__lanes_raised(at->n, slices[k].t,
                                              squared + (one - squared) * stratum / rays);
        }
        crv__lanes_march(f, shape, at, origin, count, directions, weights);
        for (int32_t k = 0; k < count; k++)
            blocked[k] = blocked[k] + weights[k];
    }
    for (int32_t k = 0; k < count && p->normal_rays > 0; k++) {
        const vf rest = one - slices[k].height * slices[k].height;
        slices[k].occlusion = slices[k].occlusion + rest * blocked[k] / rays;
    }
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const vf zero = vf_zero();
    const crv__v3 origin = crv__lanes_lift(p, shape, at->P, at->n);
    crv__v3 tangent, bitangent;
    crv__lanes_tangents(at->n, &tangent, &bitangent);
    vf occlusion = zero;
    for (int32_t first = 0; first < p->directions; first += CRV__MARCHES) {
        const int32_t rest = p->directions - first;
        const int32_t count = rest < CRV__MARCHES ? rest : CRV__MARCHES;
        slice slices[CRV__MARCHES];
        for (int32_t k = 0; k < count; k++) {
            const crv__v3 t = crv__lanes_slice_tangent(at, first + k, tangent, bitangent);
            slices[k] = (slice){
                .t = t, .h = t, .height = zero, .occlusion = zero, .weight = zero};
        }
        trace_horizons(f, shape, at, origin, count, slices);
        add_normal_rays(f, shape, at, origin, first, count, slices);
        for (int32_t k = 0; k < count; k++)
            occlusion = occlusion + slices[k].occlusion;
    }
    return vf_set(1) - occlusion / vf_set((float)p->directions);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    return crv__march_within(f, at);
}

CRV__ESTIMATE_KERNEL(hsao, 1)
