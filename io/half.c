/* SPDX-License-Identifier: MIT */
/* half.c: half floats (IEEE 754 binary16) to floats and back. */
#include <math.h>
#include <string.h>

#include "internal.h"

float io__float_of_half(uint32_t half)
{
    const uint32_t sign = (half & 0x8000u) << 16, exponent = half >> 10 & 31u;
    const uint32_t fraction = half & 0x3ffu;
    uint32_t bits = sign | (exponent + 112u) << 23 | fraction << 13;
    float value;
    if (exponent == 31) /* infinity, NaN */
        bits = sign | 0x7f800000u | fraction << 13;
    if (exponent == 0) { /* zero, denormal */
        value = (float)fraction * 0x1p-24f;
        return sign ? -value : value;
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}

uint32_t io__half_of_float(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u) /* NaN */
        return sign | 0x7e00u;
    if (magnitude >= 0x47800000u) /* 2^16 */
        return sign | 0x7c00u;
    if (magnitude < 0x38800000u) /* 2^-14: steps of 2^-24 */
        return sign | (uint32_t)lrintf(fabsf(value) * 0x1p24f);
    const uint32_t rounded = magnitude + 0xfffu + (magnitude >> 13 & 1u);
    return sign | (rounded - 0x38000000u) >> 13;
}
