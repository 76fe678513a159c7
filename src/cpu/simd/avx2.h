/* SPDX-License-Identifier: MIT */
/* 8 lanes: AVX2 and FMA. See vector.h. */
#ifndef CRV_CPU_SIMD_AVX2_H
#define CRV_CPU_SIMD_AVX2_H

#include <immintrin.h>

#define CRV__LANES           8
#define CRV__FMA_ROUNDS_ONCE 1

typedef float vf __attribute__((vector_size(32)));
typedef int32_t vi __attribute__((vector_size(32)));
typedef vi vm; /* all bits of a lane */

CRV__INLINE vf vf_set(float a)
{
    return _mm256_set1_ps(a);
}

CRV__INLINE vi vi_set(int32_t a)
{
    return (vi)_mm256_set1_epi32(a);
}

CRV__INLINE vf vf_load(const float *from)
{
    return _mm256_loadu_ps(from);
}

CRV__INLINE void vf_store(float *to, vf a)
{
    _mm256_storeu_ps(to, a);
}

CRV__INLINE vi vi_load(const int32_t *from)
{
    return (vi)_mm256_loadu_si256((const __m256i *)(const void *)from);
}

CRV__INLINE vm vf_lt(vf a, vf b)
{
    return (vm)_mm256_cmp_ps(a, b, _CMP_LT_OQ);
}

CRV__INLINE vm vf_le(vf a, vf b)
{
    return (vm)_mm256_cmp_ps(a, b, _CMP_LE_OQ);
}

CRV__INLINE int vm_any(vm a)
{
    return _mm256_movemask_ps((vf)a) != 0;
}

CRV__INLINE vf vf_select(vm mask, vf a, vf b)
{
    return _mm256_blendv_ps(b, a, (vf)mask);
}

CRV__INLINE vi vi_select(vm mask, vi a, vi b)
{
    return (vi)vf_select(mask, (vf)a, (vf)b);
}

CRV__INLINE vi vi_min(vi a, vi b)
{
    return (vi)_mm256_min_epi32((__m256i)a, (__m256i)b);
}

CRV__INLINE vi vi_max(vi a, vi b)
{
    return (vi)_mm256_max_epi32((__m256i)a, (__m256i)b);
}

CRV__INLINE vf vf_min(vf a, vf b)
{
    return _mm256_min_ps(a, b);
}

CRV__INLINE vf vf_max(vf a, vf b)
{
    return _mm256_max_ps(a, b);
}

CRV__INLINE vf vf_sqrt(vf a)
{
    return _mm256_sqrt_ps(a);
}

CRV__INLINE vf vf_floor(vf a)
{
    return _mm256_floor_ps(a);
}

CRV__INLINE vf vf_fma(vf a, vf b, vf c)
{
    return _mm256_fmadd_ps(a, b, c);
}

CRV__INLINE vf vf_rsqrt_rough(vf a)
{
    return _mm256_rsqrt_ps(a);
}

CRV__INLINE vf vf_rcp_rough(vf a)
{
    return _mm256_rcp_ps(a);
}

CRV__INLINE vf vf_rsqrt(vf a)
{
    const vf r = _mm256_rsqrt_ps(a);
    return r * vf_fma(a * r, r * vf_set(-0.5f), vf_set(1.5f));
}

CRV__INLINE vi vi_trunc(vf a)
{
    return (vi)_mm256_cvttps_epi32(a);
}

CRV__INLINE vi vi_round(vf a)
{
    return (vi)_mm256_cvtps_epi32(a);
}

CRV__INLINE vi vi_floor(vf a)
{
    return (vi)_mm256_cvttps_epi32(_mm256_floor_ps(a));
}

CRV__INLINE vi vi_ceil(vf a)
{
    return (vi)_mm256_cvttps_epi32(_mm256_ceil_ps(a));
}

CRV__INLINE vm vi_below(vi a, vi n)
{
    const __m256i last = _mm256_sub_epi32((__m256i)n, _mm256_set1_epi32(1));
    return (vm)_mm256_cmpeq_epi32(_mm256_min_epu32((__m256i)a, last), (__m256i)a);
}

/* Of nibbles by a table, then bytes by the products that add neighbours. */
CRV__INLINE vi vi_count_bits(vi a)
{
    const __m256i table = _mm256_broadcastsi128_si256(
        _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
    const __m256i low = _mm256_set1_epi8(0xf), one = _mm256_set1_epi8(1);
    const __m256i above = _mm256_srli_epi32((__m256i)a, 4);
    const __m256i bytes =
        _mm256_add_epi8(_mm256_shuffle_epi8(table, _mm256_and_si256((__m256i)a, low)),
                        _mm256_shuffle_epi8(table, _mm256_and_si256(above, low)));
    return (vi)_mm256_madd_epi16(_mm256_maddubs_epi16(bytes, one), _mm256_set1_epi16(1));
}

CRV__INLINE vi vi_from_bit(vi n)
{
    return (vi)_mm256_sllv_epi32(_mm256_set1_epi32(-1), (__m256i)n);
}

CRV__INLINE vf vf_of(vi a)
{
    return _mm256_cvtepi32_ps((__m256i)a);
}

/* Loads and inserts: no slower than the set's own gather where that is di, and much
 * faster where it is not. */
CRV__INLINE vf vf_gather(const float *base, vi index, vm mask)
{
    const vi safe = index & mask;
    const vf read =
        _mm256_setr_ps(base[safe[0]], base[safe[1]], base[safe[2]], base[safe[3]],
                       base[safe[4]], base[safe[5]], base[safe[6]], base[safe[7]]);
    return (vf)((vi)read & mask);
}

CRV__INLINE void vf_split4(const float *from, vf out[4])
{
    /* Halves first, so that a transpose within 128 bits leaves the lanes in order. */
    vf row[4];
    for (int i = 0; i < 4; i++)
        row[i] = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from + 4 * i)),
                                      _mm_loadu_ps(from + 16 + 4 * i), 1);
    const vf low01 = _mm256_unpacklo_ps(row[0], row[1]),
             high01 = _mm256_unpackhi_ps(row[0], row[1]),
             low23 = _mm256_unpacklo_ps(row[2], row[3]),
             high23 = _mm256_unpackhi_ps(row[2], row[3]);
    out[0] = _mm256_shuffle_ps(low01, low23, 0x44);
    out[1] = _mm256_shuffle_ps(low01, low23, 0xee);
    out[2] = _mm256_shuffle_ps(high01, high23, 0x44);
    out[3] = _mm256_shuffle_ps(high01, high23, 0xee);
}

CRV__INLINE void vf_join4(float *to, const vf in[4])
{
    const vf low01 = _mm256_unpacklo_ps(in[0], in[1]),
             high01 = _mm256_unpackhi_ps(in[0], in[1]),
             low23 = _mm256_unpacklo_ps(in[2], in[3]),
             high23 = _mm256_unpackhi_ps(in[2], in[3]);
    const vf row[4] = {
        _mm256_shuffle_ps(low01, low23, 0x44), _mm256_shuffle_ps(low01, low23, 0xee),
        _mm256_shuffle_ps(high01, high23, 0x44), _mm256_shuffle_ps(high01, high23, 0xee)};
    for (int i = 0; i < 4; i++) {
        _mm_storeu_ps(to + 4 * i, _mm256_castps256_ps128(row[i]));
        _mm_storeu_ps(to + 16 + 4 * i, _mm256_extractf128_ps(row[i], 1));
    }
}

#include "lanewise.h"

#endif
