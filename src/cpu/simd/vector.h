/* SPDX-License-Identifier: MIT */
/*
 * The vocabulary of the kernels: vectors of CRV__LANES floats (vf), as many 32-bit
 * integers (vi), and masks of as many lanes (vm). A kernel is compiled once per
 * instruction set, with CRV__SIMD_NAME and CRV__SIMD_HEADER defined (kernels.cmake).
 *
 * + - * / and the bit operations are the compiler's own on vf and vi. Everything is
 * rounded as the scalar code is, but for the vf_rsqrt family and where vf_fma is written:
 * positions of samples come out to the bit. Comparisons with a NaN are false.
 *
 * Each set brings, beside the types:
 *   vf_set vi_set            all lanes alike
 *   vf_load vf_store         CRV__LANES floats at any address
 *   vf_lt vf_le vi_lt vi_eq  comparisons; > and >= by swapping the arguments
 *   vm_and vm_or vm_not vm_any
 *   vf_select vi_select      first where the mask is set, else second
 *   vf_min vf_max            the second argument where either is a NaN
 *   vi_min vi_max
 *   vf_sqrt vf_floor vf_fma  exact; fma rounds twice where the set has none
 *   vf_rsqrt                 1/sqrt, relative error < 1e-6; not for denormal numbers
 *   vf_rsqrt_rough           relative error < 4e-4; at 0 infinite or a NaN
 *   vf_rsqrt_fair            relative error < 7e-5; not for denormal numbers
 *   vf_rcp_rough             1/a, relative error < 4e-4
 *   vi_rcp                   1/n likewise, n from 1 to 32; of others finite
 *   vi_trunc vi_round vf_of  conversions; the value must fit
 *   vi_floor                 rounded down; negative or INT32_MAX where it does not fit or
 *                            is a NaN
 *   vi_ceil                  rounded up, likewise
 *   vi_count_bits            how many bits are set
 *   vm_count                 how many lanes are set
 *   vi_largest               the largest lane
 *   vf_max_within            (a, b, q, limit): the larger of a >= 0 and, if q < limit, b;
 *                            at q = limit either. If b is the NaN that an operation made
 *                            out of numbers: a
 *   vf_min_abs               the smaller of |a| and b >= 0; b if a is a NaN
 *   vf_least_abs             the smaller of |a| and |b|; not of NaNs
 *   vf_most_abs              the larger of them, likewise
 *   vi_from_bit              all bits from the n-th on; none from n = 32 on; n >= 0
 *   vi_below                 0 <= a < n, n > 0
 *   vf_gather                base[index]; 0 and no access where the mask is clear, though
 *                            base[0] may be read
 *   vf_split4 vf_join4       4 * CRV__LANES consecutive floats to and from the four
 *                            vectors of every fourth
 */
#ifndef CRV_CPU_SIMD_VECTOR_H
#define CRV_CPU_SIMD_VECTOR_H

#include <stdint.h>

/* Under sanitizers functions stay functions: to instrument them wherever they are inlined
 * takes compilers ten times as long. */
#ifdef CRV__SANITIZED
#define CRV__INLINE static inline __attribute__((unused))
#else
#define CRV__INLINE static inline __attribute__((always_inline, unused))
#endif
#define CRV__NOINLINE static __attribute__((noinline))

#include CRV__SIMD_HEADER /* "cpu/simd/SET.h" */

/* The name of something that is compiled once per set. */
#define CRV__JOIN_(a, b) crv__##a##_##b
#define CRV__JOIN(a, b)  CRV__JOIN_(a, b)
#define CRV__NAME(name)  CRV__JOIN(name, CRV__SIMD_NAME)

/* The vector 0, 1, 2, ... */
CRV__INLINE vi vi_iota(void)
{
    static const int32_t COUNT[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                      8, 9, 10, 11, 12, 13, 14, 15};
    return vi_load(COUNT);
}

/* a + b, a - b and a * b where they may not fit: modulo 2^32, as + - * on vi do in fact
 * but not in C. */
typedef uint32_t crv__vu __attribute__((vector_size(4 * CRV__LANES)));

CRV__INLINE vi vi_add(vi a, vi b)
{
    return (vi)((crv__vu)a + (crv__vu)b);
}

CRV__INLINE vi vi_sub(vi a, vi b)
{
    return (vi)((crv__vu)a - (crv__vu)b);
}

CRV__INLINE vi vi_mul(vi a, vi b)
{
    return (vi)((crv__vu)a * (crv__vu)b);
}

/* Set in the first n lanes. */
CRV__INLINE vm vm_first(int32_t n)
{
    return vi_lt(vi_iota(), vi_set(n));
}

CRV__INLINE vm vm_none(void)
{
    return vm_first(0);
}

CRV__INLINE vf vf_zero(void)
{
    return vf_set(0);
}

/* 1/a, relative error < 3e-7. */
CRV__INLINE vf vf_rcp(vf a)
{
    const vf rough = vf_rcp_rough(a);
    return rough * vf_fma(-a, rough, vf_set(2));
}

/* a where the mask is set, else 0. */
CRV__INLINE vf vf_where(vm mask, vf a)
{
    return vf_select(mask, a, vf_zero());
}

CRV__INLINE vf vf_abs(vf a)
{
    return vf_of_bits(vf_bits(a) & vi_set(0x7fffffff));
}

CRV__INLINE vf vf_clamp01(vf a)
{
    return vf_min(vf_max(a, vf_zero()), vf_set(1)); /* a NaN becomes 0 */
}

/* The first n floats, the other lanes 0. */
CRV__INLINE vf vf_load_n(const float *from, int32_t n)
{
    if (n >= CRV__LANES)
        return vf_load(from);
    float lanes[CRV__LANES] = {0};
    for (int32_t i = 0; i < n; i++)
        lanes[i] = from[i];
    return vf_load(lanes);
}

CRV__INLINE void vf_store_n(float *to, vf a, int32_t n)
{
    if (n >= CRV__LANES) {
        vf_store(to, a);
        return;
    }
    float lanes[CRV__LANES];
    vf_store(lanes, a);
    for (int32_t i = 0; i < n; i++)
        to[i] = lanes[i];
}

/* e^a, relative error < 2e-7 * (1 + |a|); 0 below -87, a <= 0. Range reduction to powers
 * of two and the Taylor series of degree 6 on |x| <= ln 2 / 2. */
CRV__INLINE vf vf_exp(vf a)
{
    const vf floor_power = vf_floor(a * vf_set(1.44269504f) + vf_set(0.5f));
    const vf x = vf_fma(floor_power, vf_set(-0.693145752f),
                        vf_fma(floor_power, vf_set(-1.42860677e-6f), a));
    vf sum = vf_set(1.0f / 720);
    sum = vf_fma(sum, x, vf_set(1.0f / 120));
    sum = vf_fma(sum, x, vf_set(1.0f / 24));
    sum = vf_fma(sum, x, vf_set(1.0f / 6));
    sum = vf_fma(sum, x, vf_set(0.5f));
    sum = vf_fma(sum, x, vf_set(1));
    sum = vf_fma(sum, x, vf_set(1));
    const vm tiny = vf_lt(a, vf_set(-87));
    const vi power = vi_trunc(vf_select(tiny, vf_zero(), floor_power));
    return vf_select(tiny, vf_zero(), sum * vf_of_bits((power + vi_set(127)) << 23));
}

#endif
