/* SPDX-License-Identifier: MIT */
/* methods/hsao.c for the lanes of a vector. */
#include "cpu/kernels/march.h"

/* A slice and its horizon so far. */
typedef struct slice {
    crv__v3 t;            /* the tangent */
    crv__v3 across, h;    /* it and the horizon ray's direction, projected */
    vf height, occlusion; /* see the scalar code */
    vf weight;            /* of what raised the horizon last */
} slice;

/* Raises the horizon where the look of step i is blocked. */
CRV__INLINE void raise_horizon(const crv__walk *walk, crv__shape shape, crv__v3 n,
                               crv__v3 up, const crv__look *look, int32_t i, slice *s)
{
    const crv__params *p = walk->frame->params;
    const crv__v3 t = s->t;
    crv__v3 to;
    vf squared;
    vm raise = crv__lanes_blocked(walk, shape, look, &to, &squared);
    const vf along_t = crv__lanes_dot(shape, to, t),
             along_n = crv__lanes_dot(shape, to, n);
    /* Above the horizon there is only what is above the tangent. */
    raise = vm_and(raise, vm_and(vf_lt(vf_zero(), along_t), vf_lt(vf_zero(), along_n)));
    /* The height turns the next positions: it is rounded as the scalar code's, but in
     * lean kernels. */
    const vf both = crv__mad(shape, along_n, along_n, along_t * along_t);
    const vf least_normal = vf_set(0x1p-126f);
    const vf scale = shape.lean ? vf_rsqrt_fair(vf_max(both, least_normal))
                                : vf_set(1) / vf_sqrt(both);
    const vf height = along_n * scale, along = along_t * scale;
    const vf distance = shape.lean
                            ? squared * vf_rsqrt_fair(vf_max(squared, least_normal))
                            : crv__lanes_root(squared);
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
    const crv__v3 across = s->across;
    s->h.x = vf_select(raise, crv__mad(shape, height, up.x, along * across.x), s->h.x);
    s->h.y = vf_select(raise, crv__mad(shape, height, up.y, along * across.y), s->h.y);
    s->h.z = vf_select(raise, crv__mad(shape, height, up.z, along * across.z), s->h.z);
}

CRV__INLINE void trace_horizons(const crv__frame *f, crv__shape shape,
                                const crv__pixels *at, crv__v3 origin, int32_t count,
                                slice slices[CRV__WALKS])
{
    const crv__params *p = f->params;
    const crv__walk walk = crv__walk_from(f, origin);
    const crv__v3 start = crv__lanes_projected(p, shape, origin);
    const crv__v3 up = crv__lanes_projected(p, shape, at->n);
    crv__look looks[CRV__WALKS];
    for (int32_t i = 1; i <= p->steps; i++) {
        const vf step = crv__lanes_step(p, at, i);
        for (int32_t k = 0; k < count; k++)
            crv__lanes_look(f, shape, crv__lanes_along(shape, start, slices[k].h, step),
                            at->active, &looks[k]);
        for (int32_t k = 0; k < count; k++) {
            if (vm_any(looks[k].open))
                raise_horizon(&walk, shape, at->n, up, &looks[k], i, &slices[k]);
        }
    }
    for (int32_t k = 0; k < count && p->attenuation == CRV_ATTENUATION_HORIZON; k++)
        slices[k].occlusion = slices[k].height * slices[k].height * slices[k].weight;
}

/* What the rays above the horizons hit, added to the slices' occlusion. */
CRV__INLINE void add_normal_rays(const crv__frame *f, crv__shape shape,
                                 const crv__pixels *at, crv__v3 origin, int32_t first,
                                 int32_t count, slice slices[CRV__WALKS])
{
    const crv__params *p = f->params;
    const vf rays = vf_set((float)p->normal_rays), one = vf_set(1);
    crv__v3 directions[CRV__WALKS];
    vf weights[CRV__WALKS], blocked[CRV__WALKS];
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
    for (int32_t first = 0; first < p->directions; first += CRV__WALKS) {
        const int32_t rest = p->directions - first;
        const int32_t count = rest < CRV__WALKS ? rest : CRV__WALKS;
        slice slices[CRV__WALKS];
        for (int32_t k = 0; k < count; k++) {
            const crv__v3 t = crv__lanes_slice_tangent(at, first + k, tangent, bitangent);
            const crv__v3 across = crv__lanes_projected(p, shape, t);
            slices[k] = (slice){t, across, across, zero, zero, zero};
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
CRV__LEAN_KERNEL(hsao, 1)
