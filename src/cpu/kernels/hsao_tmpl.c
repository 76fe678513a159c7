/* SPDX-License-Identifier: MIT */
/* methods/hsao.c for the lanes of a vector. */
#include "cpu/kernels/march.h"

/* The horizon of one slice. */
typedef struct horizon {
    vf height, occlusion;
} horizon;

CRV__INLINE horizon trace_horizon(const crv__frame *f, crv__shape shape,
                                  const crv__pixels *at, crv__v3 origin, crv__v3 t)
{
    const crv__params *p = f->params;
    const vf step = vf_set(p->radius / (float)p->steps);
    horizon result = {vf_zero(), vf_zero()};
    vf weight = vf_zero();
    crv__v3 h = t;
    for (int32_t i = 1; i <= p->steps; i++) {
        crv__v3 to = origin;
        vf squared = vf_zero();
        const crv__v3 Q = crv__v3_add_scaled(origin, h, crv__lanes_step(p, at, i));
        vm raise = crv__lanes_blocked(f, shape, origin, Q, at->active, &to, &squared);
        if (!vm_any(raise))
            continue;
        const vf along_t = crv__v3_dot(to, t), along_n = crv__v3_dot(to, at->n);
        raise = vm_and(raise, vf_lt(vf_zero(), along_t));
        /* The height changes the next positions, so it is rounded as the scalar code's;
         * it is above the horizon's only where along_n > 0. */
        raise = vm_and(raise, vf_lt(vf_zero(), along_n));
        if (!vm_any(raise))
            continue;
        const vf scale = vf_set(1) / vf_sqrt(along_t * along_t + along_n * along_n);
        const vf height = along_n * scale;
        raise = vm_and(raise, vf_lt(result.height, height));
        const vf distance = vf_sqrt(squared);
        if (p->growing_sphere)
            raise = vm_and(raise, vf_le(distance, vf_set((float)i) * step));
        if (!vm_any(raise))
            continue;
        const vf W = crv__lanes_falloff(p, distance * vf_set(p->inv_radius));
        const vf gain = height * height - result.height * result.height;
        result.occlusion = result.occlusion + vf_where(raise, gain * W);
        result.height = vf_select(raise, height, result.height);
        weight = vf_select(raise, W, weight);
        const vf along = along_t * scale;
        const crv__v3 n = at->n;
        h.x = vf_select(raise, height * n.x + along * t.x, h.x);
        h.y = vf_select(raise, height * n.y + along * t.y, h.y);
        h.z = vf_select(raise, height * n.z + along * t.z, h.z);
    }
    if (p->attenuation == CRV_ATTENUATION_HORIZON)
        result.occlusion = result.height * result.height * weight;
    return result;
}

CRV__INLINE vf normal_occlusion(const crv__frame *f, crv__shape shape,
                                const crv__pixels *at, crv__v3 origin, crv__v3 t,
                                vf height, vf stratum)
{
    const crv__params *p = f->params;
    const vf squared = height * height, rest = vf_set(1) - squared;
    const vf rays = vf_set((float)p->normal_rays);
    vf blocked = vf_zero();
    for (int32_t k = 0; k < p->normal_rays; k++) {
        const vf z2 = squared + rest * (vf_set((float)k) + stratum) / rays;
        blocked =
            blocked
            + crv__lanes_march(f, shape, at, origin, crv__lanes_raised(at->n, t, z2));
    }
    return p->normal_rays ? rest * blocked / rays : vf_zero();
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__v3 origin = crv__lanes_lift(p, shape, at->P, at->n);
    crv__v3 tangent, bitangent;
    crv__lanes_tangents(at->n, &tangent, &bitangent);
    vf occlusion = vf_zero();
    for (int32_t i = 0; i < p->directions; i++) {
        const crv__v3 t = crv__lanes_slice_tangent(at, i, tangent, bitangent);
        const horizon h = trace_horizon(f, shape, at, origin, t);
        occlusion = occlusion + h.occlusion
                    + normal_occlusion(f, shape, at, origin, t, h.height,
                                       crv__lanes_stratum(at, i));
    }
    return vf_set(1) - occlusion / vf_set((float)p->directions);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    return crv__march_within(f, at);
}

CRV__ESTIMATE_KERNEL(hsao)
