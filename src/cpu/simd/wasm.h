/* SPDX-License-Identifier: MIT */
/* 4 lanes: the 128-bit vectors of WebAssembly. See vector.h. */
#ifndef CRV_CPU_SIMD_WASM_H
#define CRV_CPU_SIMD_WASM_H

#include <wasm_simd128.h>

#define CRV__LANES           4
#define CRV__FMA_ROUNDS_ONCE 0

typedef float vf __attribute__((vector_size(16)));
typedef int32_t vi __attribute__((vector_size(16)));
typedef vi vm; /* all bits of a lane */

CRV__INLINE vf vf_set(float a)
{
    return (vf)wasm_f32x4_splat(a);
}

CRV__INLINE vi vi_set(int32_t a)
{
    return (vi)wasm_i32x4_splat(a);
}

CRV__INLINE vf vf_load(const float *from)
{
    return (vf)wasm_v128_load(from);
}

CRV__INLINE void vf_store(float *to, vf a)
{
    wasm_v128_store(to, (v128_t)a);
}

CRV__INLINE vi vi_load(const int32_t *from)
{
    return (vi)wasm_v128_load(from);
}

CRV__INLINE vm vf_lt(vf a, vf b)
{
    return a < b;
}

CRV__INLINE vm vf_le(vf a, vf b)
{
    return a <= b;
}

CRV__INLINE int vm_any(vm a)
{
    return wasm_v128_any_true((v128_t)a);
}

CRV__INLINE vf vf_select(vm mask, vf a, vf b)
{
    return (vf)wasm_v128_bitselect((v128_t)a, (v128_t)b, (v128_t)mask);
}

CRV__INLINE vi vi_select(vm mask, vi a, vi b)
{
    return (vi)vf_select(mask, (vf)a, (vf)b);
}

/* pmin and pmax give their first argument if either is a NaN. */
CRV__INLINE vi vi_min(vi a, vi b)
{
    return (vi)wasm_i32x4_min((v128_t)a, (v128_t)b);
}

CRV__INLINE vi vi_max(vi a, vi b)
{
    return (vi)wasm_i32x4_max((v128_t)a, (v128_t)b);
}

CRV__INLINE vf vf_min(vf a, vf b)
{
    return (vf)wasm_f32x4_pmin((v128_t)b, (v128_t)a);
}

CRV__INLINE vf vf_max(vf a, vf b)
{
    return (vf)wasm_f32x4_pmax((v128_t)b, (v128_t)a);
}

CRV__INLINE vf vf_sqrt(vf a)
{
    return (vf)wasm_f32x4_sqrt((v128_t)a);
}

CRV__INLINE vf vf_floor(vf a)
{
    return (vf)wasm_f32x4_floor((v128_t)a);
}

CRV__INLINE vf vf_fma(vf a, vf b, vf c)
{
    return a * b + c;
}

/* There are no estimates. */
CRV__INLINE vf vf_rsqrt(vf a)
{
    return 1 / vf_sqrt(a);
}

CRV__INLINE vf vf_rsqrt_rough(vf a)
{
    return vf_rsqrt(a);
}

CRV__INLINE vf vf_rcp_rough(vf a)
{
    return 1 / a;
}

/* What does not fit becomes the nearest integer, a NaN 0. */
CRV__INLINE vi vi_trunc(vf a)
{
    return (vi)wasm_i32x4_trunc_sat_f32x4((v128_t)a);
}

CRV__INLINE vi vi_round(vf a)
{
    return vi_trunc((vf)wasm_f32x4_nearest((v128_t)a));
}

CRV__INLINE vi vi_floor(vf a)
{
    return vi_trunc(vf_floor(a)) | ~vf_le(a, a);
}

CRV__INLINE vi vi_ceil(vf a)
{
    return vi_trunc((vf)wasm_f32x4_ceil((v128_t)a)) | ~vf_le(a, a);
}

CRV__INLINE vm vi_below(vi a, vi n)
{
    return (vm)wasm_u32x4_lt((v128_t)a, (v128_t)n);
}

CRV__INLINE vi vi_count_bits(vi a)
{
    return (vi)wasm_u32x4_extadd_pairwise_u16x8(
        wasm_u16x8_extadd_pairwise_u8x16(wasm_i8x16_popcnt((v128_t)a)));
}

/* -2^n: the sign and the exponent of a float, and then as an integer. */
CRV__INLINE vi vi_from_bit(vi n)
{
    const vi power = (vi)wasm_i32x4_shl((v128_t)(n + 127), 23) | vi_set(INT32_MIN);
    return vi_trunc((vf)power) & (n < 32);
}

CRV__INLINE vf vf_of(vi a)
{
    return (vf)wasm_f32x4_convert_i32x4((v128_t)a);
}

CRV__INLINE vf vf_gather(const float *base, vi index, vm mask)
{
    const vi safe = index & mask;
    const vf read = {base[safe[0]], base[safe[1]], base[safe[2]], base[safe[3]]};
    return (vf)((vi)read & mask);
}

CRV__INLINE void simd_transpose(const v128_t in[4], v128_t out[4])
{
    const v128_t a = wasm_i32x4_shuffle(in[0], in[1], 0, 4, 1, 5),
                 b = wasm_i32x4_shuffle(in[0], in[1], 2, 6, 3, 7),
                 c = wasm_i32x4_shuffle(in[2], in[3], 0, 4, 1, 5),
                 d = wasm_i32x4_shuffle(in[2], in[3], 2, 6, 3, 7);
    out[0] = wasm_i32x4_shuffle(a, c, 0, 1, 4, 5);
    out[1] = wasm_i32x4_shuffle(a, c, 2, 3, 6, 7);
    out[2] = wasm_i32x4_shuffle(b, d, 0, 1, 4, 5);
    out[3] = wasm_i32x4_shuffle(b, d, 2, 3, 6, 7);
}

CRV__INLINE void vf_split4(const float *from, vf out[4])
{
    const v128_t rows[4] = {wasm_v128_load(from), wasm_v128_load(from + 4),
                            wasm_v128_load(from + 8), wasm_v128_load(from + 12)};
    v128_t columns[4];
    simd_transpose(rows, columns);
    for (int i = 0; i < 4; i++)
        out[i] = (vf)columns[i];
}

CRV__INLINE void vf_join4(float *to, const vf in[4])
{
    const v128_t columns[4] = {(v128_t)in[0], (v128_t)in[1], (v128_t)in[2],
                               (v128_t)in[3]};
    v128_t rows[4];
    simd_transpose(columns, rows);
    for (int i = 0; i < 4; i++)
        wasm_v128_store(to + 4 * i, rows[i]);
}

#include "lanewise.h"

#endif
