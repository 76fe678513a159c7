/* SPDX-License-Identifier: MIT */
/* methods/ssao.c for the lanes of a vector. */
#include "cpu/kernels/outside.h"

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const vf one = vf_set(1);
    vf inside = vf_zero();
    for (int32_t i = 0; i < p->samples; i++) {
        vf x, y;
        crv__lanes_point(at, i, &x, &y);
        const crv__v3 q = {at->P.x + x, at->P.y + y,
                           at->P.z + vf_set(f->pattern[4 * i + 2] * p->radius)};
        const vm in = crv__lanes_inside(f, shape, q, at->active, INFINITY);
        inside = inside + vf_where(in, one);
    }
    const vf samples = vf_set((float)p->samples);
    const vf share = (samples - inside) / samples;
    return p->rescale ? vf_min(share + share, one) : share;
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    return crv__lanes_within(p, at->P, vf_set(p->radius * 1.0001f), at->active);
}

CRV__ESTIMATE_KERNEL(ssao, f->params->radius)
