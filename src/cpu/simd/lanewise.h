/* SPDX-License-Identifier: MIT */
/* The words that are the same in every set whose masks are vectors, all bits of a lane:
 * the compiler's own operators. Included at the end of those sets. See vector.h.
 */
#ifndef CRV_CPU_SIMD_LANEWISE_H
#define CRV_CPU_SIMD_LANEWISE_H

CRV__INLINE vi vf_bits(vf a)
{
    return (vi)a;
}

CRV__INLINE vf vf_of_bits(vi a)
{
    return (vf)a;
}

CRV__INLINE vm vi_lt(vi a, vi b)
{
    return a < b;
}

CRV__INLINE vm vi_eq(vi a, vi b)
{
    return a == b;
}

CRV__INLINE vm vm_and(vm a, vm b)
{
    return a & b;
}

CRV__INLINE vm vm_or(vm a, vm b)
{
    return a | b;
}

CRV__INLINE vm vm_not(vm a)
{
    return ~a;
}

CRV__INLINE int32_t vm_count(vm mask)
{
    int32_t count = 0;
    for (int32_t i = 0; i < CRV__LANES; i++)
        count -= mask[i];
    return count;
}

CRV__INLINE int32_t vi_largest(vi a)
{
    int32_t largest = a[0];
    for (int32_t i = 1; i < CRV__LANES; i++)
        largest = a[i] > largest ? a[i] : largest;
    return largest;
}

CRV__INLINE vf vi_rcp(vi n)
{
    return vf_rcp_rough(vf_of(vi_max(n, vi_set(1))));
}

CRV__INLINE vf vf_max_within(vf a, vf b, vf q, vf limit)
{
    return vf_max(vf_select(vf_lt(q, limit), b, vf_set(0)), a);
}

CRV__INLINE vf vf_min_abs(vf a, vf b)
{
    return vf_min(vf_of_bits(vf_bits(a) & vi_set(0x7fffffff)), b);
}

CRV__INLINE vf vf_least_abs(vf a, vf b)
{
    return vf_min_abs(a, vf_of_bits(vf_bits(b) & vi_set(0x7fffffff)));
}

CRV__INLINE vf vf_most_abs(vf a, vf b)
{
    const vi magnitude = vi_set(0x7fffffff);
    return vf_max(vf_of_bits(vf_bits(a) & magnitude), vf_of_bits(vf_bits(b) & magnitude));
}

CRV__INLINE vf vf_rsqrt_fair(vf a)
{
    return vf_rsqrt(a);
}

#endif
