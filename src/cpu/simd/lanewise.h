/* SPDX-License-Identifier: MIT */
/* The words that are the same in every set whose masks are vectors, all bits of a lane:
 * the compiler's own operators. Included by those sets behind their types. See vector.h.
 */
#ifndef CRV_CPU_SIMD_LANEWISE_H
#define CRV_CPU_SIMD_LANEWISE_H

typedef vi vm; /* all bits of a lane */

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

#endif
