/* SPDX-License-Identifier: MIT */
/* methods/raymarch.c for the lanes of a vector. */
#include "cpu/kernels/march.h"

CRV__INLINE vf estimate(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                        crv__v3 *bent)
{
    const crv__params *p = f->params;
    const crv__v3 origin = crv__lanes_lift(p, shape, at->P, at->n);
    crv__v3 tangent, bitangent;
    crv__lanes_tangents(at->n, &tangent, &bitangent);
    const int32_t rays = p->normal_rays > 0 ? p->normal_rays : 1;
    const int32_t all = p->directions * rays;
    vf occlusion = vf_zero();
    crv__lanes_sums sums = crv__lanes_no_sums();
    for (int32_t first = 0; first < all; first += CRV__MARCHES) {
        const int32_t count = all - first < CRV__MARCHES ? all - first : CRV__MARCHES;
        crv__v3 directions[CRV__MARCHES];
        vf weights[CRV__MARCHES];
        for (int32_t k = 0; k < count; k++) {
            const int32_t i = (first + k) / rays, ray = (first + k) % rays;
            const crv__v3 t = crv__lanes_slice_tangent(at, i, tangent, bitangent);
            const vf stratum =
                (vf_set((float)ray) + crv__lanes_stratum(at, i)) / vf_set((float)rays);
            directions[k] = crv__lanes_raised(at->n, t, stratum);
        }
        crv__lanes_march(f, shape, at, origin, count, directions, weights);
        for (int32_t k = 0; k < count; k++)
            occlusion = occlusion + weights[k];
        for (int32_t k = 0; bent && k < count; k++)
            crv__lanes_bent_add(&sums, directions[k], vf_set(1), weights[k]);
    }
    const vf A = vf_set(1) - occlusion / vf_set((float)all);
    if (bent)
        *bent = crv__lanes_bent_normal(&sums, at->n, A,
                                       vf_set(CRV__BENT_COSINE * (float)all));
    return A;
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    return estimate(f, shape, at, NULL);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    return crv__march_within(f, at);
}

CRV__ESTIMATE_KERNEL(raymarch, 1)

CRV__BENT_KERNEL(raymarch)
