/* SPDX-License-Identifier: MIT */
/* Groups of bitmask's sectors and their directions: what the bent normals of its kernels
 * share. See methods/bitmask.c. */
#ifndef CRV_CPU_KERNELS_SECTORS_H
#define CRV_CPU_KERNELS_SECTORS_H

#include "cpu/kernels/slice.h"

enum { SECTORS = 32, GROUPS = 8, GROUP_SECTORS = SECTORS / GROUPS };

/* How many bits are set, four at a time: each of the eight counts where its bits were. */
CRV__INLINE vi crv__group_counts(vi bits)
{
    const vi pairs = vi_set(0x55555555), fours = vi_set(0x33333333);
    const vi twos = vi_sub(bits, bits >> 1 & pairs);
    return (twos & fours) + (twos >> 2 & fours);
}

CRV__INLINE vf crv__group_count(vi counts, int32_t g)
{
    return vf_of(counts >> GROUP_SECTORS * g & vi_set(0xf));
}

/* Sine and cosine of at most 1.2 in either direction, within 1e-5. */
CRV__INLINE void crv__small_angle(vf x, vf *sine, vf *cosine)
{
    const vf one = vf_set(1), x2 = x * x;
    vf s = vf_fma(x2, vf_set(-1.0f / 5040), vf_set(1.0f / 120));
    s = vf_fma(x2, s, vf_set(-1.0f / 6));
    *sine = x * vf_fma(x2, s, one);
    vf c = vf_fma(x2, vf_set(1.0f / 40320), vf_set(-1.0f / 720));
    c = vf_fma(x2, c, vf_set(1.0f / 24));
    c = vf_fma(x2, c, vf_set(-0.5f));
    *cosine = vf_fma(x2, c, one);
}

/* group_direction() of the scalar code, of all groups. */
CRV__INLINE void crv__group_directions(const crv__params *p, vf cos_tangent,
                                       vf sin_tangent, crv__v2 to[GROUPS])
{
    static const float MEANS[GROUPS / 2] = {0.08f, 0.2455f, 0.43203f, 0.69591f};
    const vf one = vf_set(1), half = vf_set(0.5f);
    if (p->weighting == CRV_WEIGHTING_UNIFORM) {
        for (int32_t g = 0; g < GROUPS; g++) {
            const vf u = vf_set(((float)g + 0.5f) / GROUPS);
            to[g].V = one - u * (one - cos_tangent);
            to[g].T = vf_sqrt(vf_max(one - to[g].V * to[g].V, vf_zero()));
        }
        return;
    }
    const vf tangent =
        crv__lanes_segment(cos_tangent, sin_tangent) + cos_tangent * sin_tangent;
    const vf t = vf_set(0.63661977f) * tangent - one;
    const vf bend = t * (vf_set(0.13f) + vf_set(0.1f) * t);
    /* Of half the tangent's angle. */
    const vf sine = vf_sqrt(half * (one - cos_tangent)),
             cosine = vf_sqrt(half * (one + cos_tangent));
    for (int32_t g = 0; g < GROUPS / 2; g++) {
        const float v = MEANS[g];
        vf s, c;
        crv__small_angle(half * tangent * vf_set(v) * (one - bend * vf_set(1 - v * v)),
                         &s, &c);
        to[GROUPS / 2 + g] = (crv__v2){sine * c + cosine * s, cosine * c - sine * s};
        to[GROUPS / 2 - 1 - g] = (crv__v2){sine * c - cosine * s, cosine * c + sine * s};
    }
}

/* O and K of a slice whose groups have these weights of blocked sectors. */
CRV__INLINE crv__lanes_vectors crv__group_vectors(const crv__params *p, vf cos_tangent,
                                                  vf sin_tangent, vf total,
                                                  const vf blocked[GROUPS])
{
    const vf measure = total * vf_set(1.0f / SECTORS), all = vf_set(GROUP_SECTORS);
    crv__v2 to[GROUPS], O = {vf_zero(), vf_zero()}, K = O;
    crv__group_directions(p, cos_tangent, sin_tangent, to);
    for (int32_t g = 0; g < GROUPS; g++) {
        K.T = vf_fma(blocked[g], to[g].T, K.T);
        K.V = vf_fma(blocked[g], to[g].V, K.V);
        O.T = vf_fma(all - blocked[g], to[g].T, O.T);
        O.V = vf_fma(all - blocked[g], to[g].V, O.V);
    }
    return (crv__lanes_vectors){.open = {O.T * measure, O.V * measure},
                                .blocked = {K.T * measure, K.V * measure}};
}

#endif
