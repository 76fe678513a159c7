/* SPDX-License-Identifier: MIT */
/* 4 lanes: Advanced SIMD of AArch64. See vector.h. */
#ifndef CRV_CPU_SIMD_NEON_H
#define CRV_CPU_SIMD_NEON_H

#include <arm_neon.h>

#define CRV__LANES           4
#define CRV__FMA_ROUNDS_ONCE 1

typedef float vf __attribute__((vector_size(16)));
typedef int32_t vi __attribute__((vector_size(16)));
typedef vi vm; /* all bits of a lane */

CRV__INLINE vf vf_set(float a)
{
    return vdupq_n_f32(a);
}

CRV__INLINE vi vi_set(int32_t a)
{
    return (vi)vdupq_n_s32(a);
}

CRV__INLINE vf vf_load(const float *from)
{
    return vld1q_f32(from);
}

CRV__INLINE void vf_store(float *to, vf a)
{
    vst1q_f32(to, a);
}

CRV__INLINE vi vi_load(const int32_t *from)
{
    return (vi)vld1q_s32(from);
}

CRV__INLINE vm vf_lt(vf a, vf b)
{
    return (vm)vcltq_f32(a, b);
}

CRV__INLINE vm vf_le(vf a, vf b)
{
    return (vm)vcleq_f32(a, b);
}

CRV__INLINE int vm_any(vm a)
{
    return vmaxvq_u32((uint32x4_t)a) != 0;
}

CRV__INLINE vf vf_select(vm mask, vf a, vf b)
{
    return vbslq_f32((uint32x4_t)mask, a, b);
}

CRV__INLINE vi vi_select(vm mask, vi a, vi b)
{
    return (a & mask) | (b & ~mask);
}

CRV__INLINE vi vi_min(vi a, vi b)
{
    return (vi)vminq_s32((int32x4_t)a, (int32x4_t)b);
}

CRV__INLINE vi vi_max(vi a, vi b)
{
    return (vi)vmaxq_s32((int32x4_t)a, (int32x4_t)b);
}

CRV__INLINE vf vf_min(vf a, vf b)
{
    return vf_select(vf_lt(a, b), a, b);
}

CRV__INLINE vf vf_max(vf a, vf b)
{
    return vf_select(vf_lt(b, a), a, b);
}

CRV__INLINE vf vf_sqrt(vf a)
{
    return vsqrtq_f32(a);
}

CRV__INLINE vf vf_floor(vf a)
{
    return vrndmq_f32(a);
}

CRV__INLINE vf vf_fma(vf a, vf b, vf c)
{
    return vfmaq_f32(c, a, b);
}

/* The estimate has 8 bits; one step doubles them. */
CRV__INLINE vf vf_rsqrt_rough(vf a)
{
    const vf r = vrsqrteq_f32(a);
    return r * vrsqrtsq_f32(a * r, r);
}

CRV__INLINE vf vf_rcp_rough(vf a)
{
    const vf r = vrecpeq_f32(a);
    return r * vrecpsq_f32(a, r);
}

CRV__INLINE vf vf_rsqrt(vf a)
{
    const vf r = vf_rsqrt_rough(a);
    return r * vrsqrtsq_f32(a * r, r);
}

CRV__INLINE vi vi_trunc(vf a)
{
    return (vi)vcvtq_s32_f32(a);
}

CRV__INLINE vi vi_round(vf a)
{
    return (vi)vcvtnq_s32_f32(a);
}

CRV__INLINE vi vi_floor(vf a)
{
    /* A NaN would become 0. */
    return (vi)vcvtmq_s32_f32(a) | ~vf_le(a, a);
}

CRV__INLINE vi vi_ceil(vf a)
{
    return (vi)vcvtpq_s32_f32(a) | ~vf_le(a, a);
}

CRV__INLINE vm vi_below(vi a, vi n)
{
    return (vm)vcltq_u32((uint32x4_t)a, (uint32x4_t)n);
}

CRV__INLINE vi vi_count_bits(vi a)
{
    return (vi)vpaddlq_u16(vpaddlq_u8(vcntq_u8((uint8x16_t)a)));
}

CRV__INLINE vi vi_from_bit(vi n)
{
    return (vi)vshlq_u32(vdupq_n_u32(UINT32_MAX), (int32x4_t)n);
}

CRV__INLINE vf vf_of(vi a)
{
    return vcvtq_f32_s32((int32x4_t)a);
}

CRV__INLINE vf vf_gather(const float *base, vi index, vm mask)
{
    const vi safe = index & mask;
    const vf read = {base[safe[0]], base[safe[1]], base[safe[2]], base[safe[3]]};
    return (vf)((vi)read & mask);
}

CRV__INLINE void vf_split4(const float *from, vf out[4])
{
    const float32x4x4_t all = vld4q_f32(from);
    for (int i = 0; i < 4; i++)
        out[i] = all.val[i];
}

CRV__INLINE void vf_join4(float *to, const vf in[4])
{
    const float32x4x4_t all = {{in[0], in[1], in[2], in[3]}};
    vst4q_f32(to, all);
}

#include "lanewise.h"

#endif
