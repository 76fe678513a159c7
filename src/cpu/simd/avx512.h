/* SPDX-License-Identifier: MIT */
/* 16 lanes: AVX-512 F, BW, DQ and VL. See vector.h. */
#ifndef CRV_CPU_SIMD_AVX512_H
#define CRV_CPU_SIMD_AVX512_H

#include <immintrin.h>

#define CRV__LANES           16
#define CRV__FMA_ROUNDS_ONCE 1

typedef float vf __attribute__((vector_size(64)));
typedef int32_t vi __attribute__((vector_size(64)));
typedef __mmask16 vm;

CRV__INLINE vf vf_set(float a)
{
    return _mm512_set1_ps(a);
}

CRV__INLINE vi vi_set(int32_t a)
{
    return (vi)_mm512_set1_epi32(a);
}

CRV__INLINE vf vf_load(const float *from)
{
    return _mm512_loadu_ps(from);
}

CRV__INLINE void vf_store(float *to, vf a)
{
    _mm512_storeu_ps(to, a);
}

CRV__INLINE vi vi_load(const int32_t *from)
{
    return (vi)_mm512_loadu_si512(from);
}

CRV__INLINE vi vf_bits(vf a)
{
    return (vi)a;
}

CRV__INLINE vf vf_of_bits(vi a)
{
    return (vf)a;
}

CRV__INLINE vm vf_lt(vf a, vf b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}

CRV__INLINE vm vf_le(vf a, vf b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
}

CRV__INLINE vm vi_lt(vi a, vi b)
{
    return _mm512_cmplt_epi32_mask((__m512i)a, (__m512i)b);
}

CRV__INLINE vm vi_eq(vi a, vi b)
{
    return _mm512_cmpeq_epi32_mask((__m512i)a, (__m512i)b);
}

CRV__INLINE vm vm_and(vm a, vm b)
{
    return (vm)(a & b);
}

CRV__INLINE vm vm_or(vm a, vm b)
{
    return (vm)(a | b);
}

CRV__INLINE vm vm_not(vm a)
{
    return (vm)~a;
}

CRV__INLINE int vm_any(vm a)
{
    return a != 0;
}

CRV__INLINE vf vf_select(vm mask, vf a, vf b)
{
    return _mm512_mask_blend_ps(mask, b, a);
}

CRV__INLINE vi vi_select(vm mask, vi a, vi b)
{
    return (vi)_mm512_mask_blend_epi32(mask, (__m512i)b, (__m512i)a);
}

CRV__INLINE vi vi_min(vi a, vi b)
{
    return (vi)_mm512_min_epi32((__m512i)a, (__m512i)b);
}

CRV__INLINE vi vi_max(vi a, vi b)
{
    return (vi)_mm512_max_epi32((__m512i)a, (__m512i)b);
}

CRV__INLINE vf vf_min(vf a, vf b)
{
    return _mm512_min_ps(a, b);
}

CRV__INLINE vf vf_max(vf a, vf b)
{
    return _mm512_max_ps(a, b);
}

CRV__INLINE vf vf_sqrt(vf a)
{
    return _mm512_sqrt_ps(a);
}

CRV__INLINE vf vf_floor(vf a)
{
    return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}

CRV__INLINE vf vf_fma(vf a, vf b, vf c)
{
    return _mm512_fmadd_ps(a, b, c);
}

CRV__INLINE vf vf_rsqrt_rough(vf a)
{
    return _mm512_rsqrt14_ps(a);
}

/* 14 bits. */
CRV__INLINE vf vf_rsqrt_fair(vf a)
{
    return vf_rsqrt_rough(a);
}

CRV__INLINE vf vf_rcp_rough(vf a)
{
    return _mm512_rcp14_ps(a);
}

CRV__INLINE vf vf_rsqrt(vf a)
{
    const vf r = _mm512_rsqrt14_ps(a);
    return r * vf_fma(a * r, r * vf_set(-0.5f), vf_set(1.5f));
}

CRV__INLINE vi vi_trunc(vf a)
{
    return (vi)_mm512_cvttps_epi32(a);
}

CRV__INLINE vi vi_round(vf a)
{
    return (vi)_mm512_cvtps_epi32(a);
}

CRV__INLINE vi vi_floor(vf a)
{
    return (vi)_mm512_cvt_roundps_epi32(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}

CRV__INLINE vi vi_ceil(vf a)
{
    return (vi)_mm512_cvt_roundps_epi32(a, _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC);
}

CRV__INLINE vm vi_below(vi a, vi n)
{
    return _mm512_cmplt_epu32_mask((__m512i)a, (__m512i)n);
}

CRV__INLINE vf vf_of(vi a)
{
    return _mm512_cvtepi32_ps((__m512i)a);
}

CRV__INLINE vf vf_gather(const float *base, vi index, vm mask)
{
    return _mm512_mask_i32gather_ps(_mm512_setzero_ps(), mask, (__m512i)index, base, 4);
}

CRV__INLINE void vf_split4(const float *from, vf out[4])
{
    const __m512i even =
        _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    const __m512i odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
    const vf a = vf_load(from), b = vf_load(from + 16), c = vf_load(from + 32),
             d = vf_load(from + 48);
    const vf ab0 = _mm512_permutex2var_ps(a, even, b),
             ab1 = _mm512_permutex2var_ps(a, odd, b),
             cd0 = _mm512_permutex2var_ps(c, even, d),
             cd1 = _mm512_permutex2var_ps(c, odd, d);
    out[0] = _mm512_permutex2var_ps(ab0, even, cd0);
    out[1] = _mm512_permutex2var_ps(ab1, even, cd1);
    out[2] = _mm512_permutex2var_ps(ab0, odd, cd0);
    out[3] = _mm512_permutex2var_ps(ab1, odd, cd1);
}

CRV__INLINE void vf_join4(float *to, const vf in[4])
{
    const __m512i low =
        _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    const __m512i high = _mm512_add_epi32(low, _mm512_set1_epi32(8));
    const vf even0 = _mm512_permutex2var_ps(in[0], low, in[2]),
             even1 = _mm512_permutex2var_ps(in[0], high, in[2]),
             odd0 = _mm512_permutex2var_ps(in[1], low, in[3]),
             odd1 = _mm512_permutex2var_ps(in[1], high, in[3]);
    vf_store(to, _mm512_permutex2var_ps(even0, low, odd0));
    vf_store(to + 16, _mm512_permutex2var_ps(even0, high, odd0));
    vf_store(to + 32, _mm512_permutex2var_ps(even1, low, odd1));
    vf_store(to + 48, _mm512_permutex2var_ps(even1, high, odd1));
}

/* Of nibbles by a table, then bytes by the products that add neighbours. */
CRV__INLINE vi vi_count_bits(vi a)
{
    const __m512i table = _mm512_broadcast_i32x4(
        _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
    const __m512i low = _mm512_set1_epi8(0xf), one = _mm512_set1_epi8(1);
    const __m512i above = _mm512_srli_epi32((__m512i)a, 4);
    const __m512i bytes =
        _mm512_add_epi8(_mm512_shuffle_epi8(table, _mm512_and_si512((__m512i)a, low)),
                        _mm512_shuffle_epi8(table, _mm512_and_si512(above, low)));
    return (vi)_mm512_madd_epi16(_mm512_maddubs_epi16(bytes, one), _mm512_set1_epi16(1));
}

CRV__INLINE vi vi_from_bit(vi n)
{
    return (vi)_mm512_sllv_epi32(_mm512_set1_epi32(-1), (__m512i)n);
}

/* From a table whose first number stands for 32. */
CRV__INLINE vf vi_rcp(vi n)
{
    static const float TABLE[32] = {
        1.0f / 32, 1.0f,      1.0f / 2,  1.0f / 3,  1.0f / 4,  1.0f / 5,  1.0f / 6,
        1.0f / 7,  1.0f / 8,  1.0f / 9,  1.0f / 10, 1.0f / 11, 1.0f / 12, 1.0f / 13,
        1.0f / 14, 1.0f / 15, 1.0f / 16, 1.0f / 17, 1.0f / 18, 1.0f / 19, 1.0f / 20,
        1.0f / 21, 1.0f / 22, 1.0f / 23, 1.0f / 24, 1.0f / 25, 1.0f / 26, 1.0f / 27,
        1.0f / 28, 1.0f / 29, 1.0f / 30, 1.0f / 31};
    return _mm512_permutex2var_ps(vf_load(TABLE), (__m512i)n, vf_load(TABLE + 16));
}

CRV__INLINE int32_t vm_count(vm mask)
{
    return __builtin_popcount(mask);
}

CRV__INLINE int32_t vi_largest(vi a)
{
    return _mm512_reduce_max_epi32((__m512i)a);
}

/* Where limit - q is negative, b is made so. Numbers from 0 on are in the order of their
 * bits, all others below them; and the ports that multiply are left alone. */
CRV__INLINE vf vf_max_within(vf a, vf b, vf q, vf limit)
{
    const __m512i sign = _mm512_set1_epi32(INT32_MIN);
    const __m512i within =
        _mm512_ternarylogic_epi32((__m512i)b, (__m512i)(limit - q), sign, 0xf8);
    return (vf)_mm512_max_epi32((__m512i)a, within);
}

CRV__INLINE vf vf_min_abs(vf a, vf b)
{
    return _mm512_range_ps(a, b, 2 << 2 | 2);
}

CRV__INLINE vf vf_least_abs(vf a, vf b)
{
    return _mm512_range_ps(a, b, 2 << 2 | 2);
}

CRV__INLINE vf vf_most_abs(vf a, vf b)
{
    return _mm512_range_ps(a, b, 2 << 2 | 3);
}

#endif
