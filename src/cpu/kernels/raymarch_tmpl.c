/* SPDX-License-Identifier: MIT */
/* methods/raymarch.c for the lanes of a vector. */
#include "cpu/kernels/march.h"

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const crv__v3 origin = crv__lanes_lift(p, shape, at->P, at->n);
    crv__v3 tangent, bitangent;
    crv__lanes_tangents(at->n, &tangent, &bitangent);
    const int32_t rays = p->normal_rays > 0 ? p->normal_rays : 1;
    vf occlusion = vf_zero();
    for (int32_t i = 0; i < p->directions; i++) {
        const crv__v3 t = crv__lanes_slice_tangent(at, i, tangent, bitangent);
        const vf jitter = crv__lanes_stratum(at, i);
        for (int32_t k = 0; k < rays; k++) {
            const vf stratum = (vf_set((float)k) + jitter) / vf_set((float)rays);
            occlusion = occlusion
                        + crv__lanes_march(f, shape, at, origin,
                                           crv__lanes_raised(at->n, t, stratum));
        }
    }
    return vf_set(1) - occlusion / vf_set((float)(p->directions * rays));
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    return crv__march_within(f, at);
}

CRV__ESTIMATE_KERNEL(raymarch)
