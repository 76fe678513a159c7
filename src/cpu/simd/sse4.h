/* SPDX-License-Identifier: MIT */
/* 4 lanes: SSE4.1. See vector.h. */
#ifndef CRV_CPU_SIMD_SSE4_H
#define CRV_CPU_SIMD_SSE4_H

#include <smmintrin.h>

#define CRV__LANES           4
#define CRV__FMA_ROUNDS_ONCE 0

typedef float vf __attribute__((vector_size(16)));
typedef int32_t vi __attribute__((vector_size(16)));
typedef vi vm; /* all bits of a lane */

CRV__INLINE vf vf_set(float a)
{
    return _mm_set1_ps(a);
}

CRV__INLINE vi vi_set(int32_t a)
{
    return (vi)_mm_set1_epi32(a);
}

CRV__INLINE vf vf_load(const float *from)
{
    return _mm_loadu_ps(from);
}

CRV__INLINE void vf_store(float *to, vf a)
{
    _mm_storeu_ps(to, a);
}

CRV__INLINE vi vi_load(const int32_t *from)
{
    return (vi)_mm_loadu_si128((const __m128i *)(const void *)from);
}

CRV__INLINE vm vf_lt(vf a, vf b)
{
    return (vm)_mm_cmplt_ps(a, b);
}

CRV__INLINE vm vf_le(vf a, vf b)
{
    return (vm)_mm_cmple_ps(a, b);
}

CRV__INLINE int vm_any(vm a)
{
    return _mm_movemask_ps((vf)a) != 0;
}

CRV__INLINE vf vf_select(vm mask, vf a, vf b)
{
    return _mm_blendv_ps(b, a, (vf)mask);
}

CRV__INLINE vi vi_select(vm mask, vi a, vi b)
{
    return (vi)vf_select(mask, (vf)a, (vf)b);
}

CRV__INLINE vi vi_min(vi a, vi b)
{
    return (vi)_mm_min_epi32((__m128i)a, (__m128i)b);
}

CRV__INLINE vi vi_max(vi a, vi b)
{
    return (vi)_mm_max_epi32((__m128i)a, (__m128i)b);
}

CRV__INLINE vf vf_min(vf a, vf b)
{
    return _mm_min_ps(a, b);
}

CRV__INLINE vf vf_max(vf a, vf b)
{
    return _mm_max_ps(a, b);
}

CRV__INLINE vf vf_sqrt(vf a)
{
    return _mm_sqrt_ps(a);
}

CRV__INLINE vf vf_floor(vf a)
{
    return _mm_floor_ps(a);
}

CRV__INLINE vf vf_fma(vf a, vf b, vf c)
{
    return a * b + c;
}

CRV__INLINE vf vf_rsqrt_rough(vf a)
{
    return _mm_rsqrt_ps(a);
}

CRV__INLINE vf vf_rcp_rough(vf a)
{
    return _mm_rcp_ps(a);
}

CRV__INLINE vf vf_rsqrt(vf a)
{
    const vf r = _mm_rsqrt_ps(a);
    return r * vf_fma(a * r, r * vf_set(-0.5f), vf_set(1.5f));
}

CRV__INLINE vi vi_trunc(vf a)
{
    return (vi)_mm_cvttps_epi32(a);
}

CRV__INLINE vi vi_round(vf a)
{
    return (vi)_mm_cvtps_epi32(a);
}

CRV__INLINE vi vi_floor(vf a)
{
    return (vi)_mm_cvttps_epi32(_mm_floor_ps(a));
}

CRV__INLINE vi vi_ceil(vf a)
{
    return (vi)_mm_cvttps_epi32(_mm_ceil_ps(a));
}

CRV__INLINE vm vi_below(vi a, vi n)
{
    const __m128i last = _mm_sub_epi32((__m128i)n, _mm_set1_epi32(1));
    return (vm)_mm_cmpeq_epi32(_mm_min_epu32((__m128i)a, last), (__m128i)a);
}

/* Of nibbles by a table, then bytes by the products that add neighbours. */
CRV__INLINE vi vi_count_bits(vi a)
{
    const __m128i table = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
    const __m128i low = _mm_set1_epi8(0xf), one = _mm_set1_epi8(1);
    const __m128i above = _mm_srli_epi32((__m128i)a, 4);
    const __m128i bytes =
        _mm_add_epi8(_mm_shuffle_epi8(table, _mm_and_si128((__m128i)a, low)),
                     _mm_shuffle_epi8(table, _mm_and_si128(above, low)));
    return (vi)_mm_madd_epi16(_mm_maddubs_epi16(bytes, one), _mm_set1_epi16(1));
}

/* -2^n, where 2^n is a float's exponent; as an integer 2^31 is what does not fit. */
CRV__INLINE vi vi_from_bit(vi n)
{
    const __m128i power =
        _mm_slli_epi32(_mm_add_epi32((__m128i)n, _mm_set1_epi32(127)), 23);
    const __m128i bits = _mm_cvttps_epi32(_mm_castsi128_ps(power));
    const __m128i fits = _mm_cmplt_epi32((__m128i)n, _mm_set1_epi32(32));
    return (vi)_mm_and_si128(_mm_sub_epi32(_mm_setzero_si128(), bits), fits);
}

CRV__INLINE vf vf_of(vi a)
{
    return _mm_cvtepi32_ps((__m128i)a);
}

CRV__INLINE vf vf_gather(const float *base, vi index, vm mask)
{
    const vi safe = index & mask;
    const vf read =
        _mm_setr_ps(base[safe[0]], base[safe[1]], base[safe[2]], base[safe[3]]);
    return (vf)((vi)read & mask);
}

CRV__INLINE void vf_split4(const float *from, vf out[4])
{
    for (int i = 0; i < 4; i++)
        out[i] = vf_load(from + 4 * i);
    _MM_TRANSPOSE4_PS(out[0], out[1], out[2], out[3]);
}

CRV__INLINE void vf_join4(float *to, const vf in[4])
{
    vf a = in[0], b = in[1], c = in[2], d = in[3];
    _MM_TRANSPOSE4_PS(a, b, c, d);
    vf_store(to, a);
    vf_store(to + 4, b);
    vf_store(to + 8, c);
    vf_store(to + 12, d);
}

#include "lanewise.h"

#endif
