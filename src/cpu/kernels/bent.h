/* SPDX-License-Identifier: MIT */
/* methods/bent.h for the lanes of a vector. */
#ifndef CRV_CPU_KERNELS_BENT_H
#define CRV_CPU_KERNELS_BENT_H

#include "cpu/kernels/lanes.h"

#define CRV__BENT_COSINE  0.66666667f
#define CRV__BENT_UNIFORM 0.5f

/* O and K. */
typedef struct crv__lanes_sums {
    crv__v3 open, blocked;
} crv__lanes_sums;

CRV__INLINE crv__lanes_sums crv__lanes_no_sums(void)
{
    const crv__v3 zero = {vf_zero(), vf_zero(), vf_zero()};
    return (crv__lanes_sums){zero, zero};
}

/* crv__bent_add() */
CRV__INLINE void crv__lanes_bent_add(crv__lanes_sums *sums, crv__v3 direction, vf measure,
                                     vf blocked)
{
    const vf hit = measure * blocked;
    sums->open = crv__v3_add_scaled(sums->open, direction, measure - hit);
    sums->blocked = crv__v3_add_scaled(sums->blocked, direction, hit);
}

CRV__INLINE vf crv__lanes_blend(vf open, vf known, vf blocked, vf accessibility)
{
    return open + accessibility * (known - blocked - open);
}

/* crv__bent_normal() */
CRV__INLINE crv__v3 crv__lanes_bent_normal(const crv__lanes_sums *sums, crv__v3 n,
                                           vf accessibility, vf hemisphere)
{
    const crv__v3 O = sums->open, K = sums->blocked;
    const vf A = vf_clamp01(accessibility);
    const crv__v3 B = {crv__lanes_blend(O.x, n.x * hemisphere, K.x, A),
                       crv__lanes_blend(O.y, n.y * hemisphere, K.y, A),
                       crv__lanes_blend(O.z, n.z * hemisphere, K.z, A)};
    const vf least = vf_set(1e-4f) * hemisphere, squared = crv__v3_dot(B, B);
    const vm is_some = vf_lt(least * least, squared);
    const vf scale = vf_set(1) / vf_sqrt(squared);
    return (crv__v3){vf_select(is_some, B.x * scale, n.x),
                     vf_select(is_some, B.y * scale, n.y),
                     vf_select(is_some, B.z * scale, n.z)};
}

#endif
