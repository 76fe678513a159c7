/* SPDX-License-Identifier: MIT */
/* Pixels of any type as floats: core/texels.c in loops that the compiler turns into
 * vectors. */
#ifndef CRV_CPU_KERNELS_TEXELS_H
#define CRV_CPU_KERNELS_TEXELS_H

#include "core/conversions.h"
#include "cpu/simd/vector.h"

/* An integer with the bits of a float, and the other way. */
CRV__INLINE uint32_t crv__float_bits(float v)
{
    uint32_t bits;
    __builtin_memcpy(&bits, &v, sizeof bits);
    return bits;
}

CRV__INLINE float crv__float_of_bits(uint32_t bits)
{
    float v;
    __builtin_memcpy(&v, &bits, sizeof v);
    return v;
}

/* The bits of a half where a float has them are the number, denormal or not, but for the
 * bias of the exponent; infinite and NaN have all bits of the exponent in both. */
CRV__INLINE float crv__half(uint16_t half)
{
    const float magnitude =
        crv__float_of_bits((uint32_t)(half & 0x7fff) << 13) * 0x1p112f;
    const uint32_t special = (half & 0x7c00) == 0x7c00 ? 0x7f800000u : 0;
    return crv__float_of_bits(crv__float_bits(magnitude) | special
                              | (uint32_t)(half & 0x8000) << 16);
}

CRV__INLINE ptrdiff_t crv__texel_size(crv_texel type)
{
    return type == CRV_TEXEL_DOUBLE  ? 8
           : type == CRV_TEXEL_FLOAT ? 4
           : type == CRV_TEXEL_UINT8 ? 1
                                     : 2;
}

/* One loop for numbers that lie side by side, one for those that do not. */
#define CRV__TAKE(ctype, number)                                                         \
    {                                                                                    \
        ctype v;                                                                         \
        if (stride == (ptrdiff_t)sizeof v) {                                             \
            for (int32_t i = 0; i < count; i++) {                                        \
                __builtin_memcpy(&v, at + i * (ptrdiff_t)sizeof v, sizeof v);            \
                out[i * step] = number;                                                  \
            }                                                                            \
        } else {                                                                         \
            for (int32_t i = 0; i < count; i++) {                                        \
                __builtin_memcpy(&v, at + i * stride, sizeof v);                         \
                out[i * step] = number;                                                  \
            }                                                                            \
        }                                                                                \
        break;                                                                           \
    }

/* count numbers, `stride` bytes from one to the next, to every step-th of out. */
CRV__INLINE void crv__texels_take(const char *at, crv_texel type, ptrdiff_t stride,
                                  int32_t count, float *restrict out, int32_t step)
{
    switch (type) {
    case CRV_TEXEL_FLOAT:
        CRV__TAKE(float, v)
    case CRV_TEXEL_DOUBLE:
        CRV__TAKE(double, (float)v)
    case CRV_TEXEL_HALF:
        CRV__TAKE(uint16_t, crv__half(v))
    case CRV_TEXEL_UINT8:
        CRV__TAKE(uint8_t, (float)v)
    case CRV_TEXEL_UINT16:
        CRV__TAKE(uint16_t, (float)v)
    case CRV_TEXEL_INT16:
        CRV__TAKE(int16_t, (float)v)
    }
}
#undef CRV__TAKE

/* Whether the row holds floats that can be read where they are. */
CRV__INLINE bool crv__row_is_plain(const crv__texel_row *row)
{
    return row->type == CRV_TEXEL_FLOAT && row->scale == 1 && row->offset == 0
           && (uintptr_t)row->at % sizeof(float) == 0
           && row->stride % (ptrdiff_t)sizeof(float) == 0;
}

CRV__INLINE void crv__texels_scale(const crv__texel_row *row, float *numbers,
                                   int32_t count)
{
    const float scale = row->scale, offset = row->offset;
    if (scale == 1 && offset == 0)
        return;
    for (int32_t i = 0; i < count; i++)
        numbers[i] = numbers[i] * scale + offset;
}

#endif
