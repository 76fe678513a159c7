/* SPDX-License-Identifier: MIT */
#include "vulkan_texels.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "fixture.h"

#define DEPTH  VK_IMAGE_ASPECT_DEPTH_BIT
#define COLOUR VK_IMAGE_ASPECT_COLOR_BIT
#define ROW(format, kind, size, ...)                                                     \
    {VK_FORMAT_##format, #format, TEXEL_##kind, size, __VA_ARGS__},
/* clang-format off */
static const texel_layout LAYOUTS[] = {
    ROW(D16_UNORM, UNSIGNED, 2, {16}, {0}, DEPTH)
    ROW(D16_UNORM_S8_UINT, UNSIGNED, 2, {16}, {0}, DEPTH)
    ROW(X8_D24_UNORM_PACK32, UNSIGNED, 4, {24}, {0}, DEPTH)
    ROW(D24_UNORM_S8_UINT, UNSIGNED, 4, {24}, {0}, DEPTH)
    ROW(D32_SFLOAT, FLOAT, 4, {32}, {0}, DEPTH)
    ROW(D32_SFLOAT_S8_UINT, FLOAT, 4, {32}, {0}, DEPTH)
    ROW(R8_UNORM, UNSIGNED, 1, {8}, {0}, COLOUR)
    ROW(R16_UNORM, UNSIGNED, 2, {16}, {0}, COLOUR)
    ROW(R16_SFLOAT, FLOAT, 2, {16}, {0}, COLOUR)
    ROW(R32_SFLOAT, FLOAT, 4, {32}, {0}, COLOUR)
    ROW(R8G8_UNORM, UNSIGNED, 2, {8, 8}, {0, 8}, COLOUR)
    ROW(R8G8_SNORM, SIGNED, 2, {8, 8}, {0, 8}, COLOUR)
    ROW(R16G16_UNORM, UNSIGNED, 4, {16, 16}, {0, 16}, COLOUR)
    ROW(R16G16_SNORM, SIGNED, 4, {16, 16}, {0, 16}, COLOUR)
    ROW(R16G16_SFLOAT, FLOAT, 4, {16, 16}, {0, 16}, COLOUR)
    ROW(R32G32_SFLOAT, FLOAT, 8, {32, 32}, {0, 32}, COLOUR)
    ROW(R8G8B8A8_UNORM, UNSIGNED, 4, {8, 8, 8, 8}, {0, 8, 16, 24}, COLOUR)
    ROW(R8G8B8A8_SNORM, SIGNED, 4, {8, 8, 8, 8}, {0, 8, 16, 24}, COLOUR)
    ROW(B8G8R8A8_UNORM, UNSIGNED, 4, {8, 8, 8, 8}, {16, 8, 0, 24}, COLOUR)
    ROW(A8B8G8R8_UNORM_PACK32, UNSIGNED, 4, {8, 8, 8, 8}, {0, 8, 16, 24}, COLOUR)
    ROW(A8B8G8R8_SNORM_PACK32, SIGNED, 4, {8, 8, 8, 8}, {0, 8, 16, 24}, COLOUR)
    ROW(A2R10G10B10_UNORM_PACK32, UNSIGNED, 4, {10, 10, 10, 2}, {20, 10, 0, 30}, COLOUR)
    ROW(A2B10G10R10_UNORM_PACK32, UNSIGNED, 4, {10, 10, 10, 2}, {0, 10, 20, 30}, COLOUR)
    ROW(A2B10G10R10_SNORM_PACK32, SIGNED, 4, {10, 10, 10, 2}, {0, 10, 20, 30}, COLOUR)
    ROW(B10G11R11_UFLOAT_PACK32, FLOAT, 4, {11, 11, 10}, {0, 11, 22}, COLOUR)
    ROW(R16G16B16A16_UNORM, UNSIGNED, 8, {16, 16, 16, 16}, {0, 16, 32, 48}, COLOUR)
    ROW(R16G16B16A16_SNORM, SIGNED, 8, {16, 16, 16, 16}, {0, 16, 32, 48}, COLOUR)
    ROW(R16G16B16A16_SFLOAT, FLOAT, 8, {16, 16, 16, 16}, {0, 16, 32, 48}, COLOUR)
    ROW(R32G32B32A32_SFLOAT, FLOAT, 16, {32, 32, 32, 32}, {0, 32, 64, 96}, COLOUR)
};
/* clang-format on */

const texel_layout *texel_layout_of(VkFormat format)
{
    for (size_t i = 0; i < sizeof LAYOUTS / sizeof *LAYOUTS; i++) {
        if (LAYOUTS[i].format == format)
            return &LAYOUTS[i];
    }
    fail_msg("VkFormat %d is not known here", (int)format);
    return NULL;
}

static void put_bits(const texel_layout *t, int k, uint32_t value, void *texel)
{
    unsigned char *bytes = texel;
    for (int i = 0; i < t->bits[k]; i++) {
        const int at = t->shift[k] + i;
        bytes[at / 8] |= (unsigned char)((value >> i & 1) << (at % 8));
    }
}

static uint32_t get_bits(const texel_layout *t, int k, const void *texel)
{
    const unsigned char *bytes = texel;
    uint32_t value = 0;
    for (int i = 0; i < t->bits[k]; i++) {
        const int at = t->shift[k] + i;
        value |= (uint32_t)(bytes[at / 8] >> (at % 8) & 1) << i;
    }
    return value;
}

/* ---- small floats: 5 bits of exponent, biased by 15; a sign where there are 16 bits
 * ----
 */

static int mantissa_bits(int bits)
{
    return bits == 16 ? 10 : bits - 5;
}

static double put_small_float(const texel_layout *t, int k, double value, void *texel)
{
    const int bits = t->bits[k], m = mantissa_bits(bits);
    const double size = bits == 16 || value > 0 ? fabs(value) : 0;
    if (size == 0)
        return 0;
    if (isinf(size)) {
        put_bits(t, k, (31u << m) | (bits == 16 && value < 0 ? 1u << 15 : 0), texel);
        return value;
    }
    int exponent = ilogb(size) < -14 ? -14 : ilogb(size);
    const double held = rint(ldexp(size, m - exponent)); /* steps of the last place */
    const uint32_t most = 1u << m;
    uint32_t word = (uint32_t)held;
    if (word >= most) /* not subnormal; 2 * most carries into the exponent */
        word = word - most + ((uint32_t)(exponent + 15) << m);
    if (bits == 16 && value < 0)
        word |= 1u << 15;
    put_bits(t, k, word, texel);
    return copysign(ldexp(held, exponent - m), value);
}

static double get_small_float(const texel_layout *t, int k, const void *texel)
{
    const int bits = t->bits[k], m = mantissa_bits(bits);
    const uint32_t word = get_bits(t, k, texel), low = word & ((1u << m) - 1);
    const int exponent = (int)(word >> m & 31);
    const double size = exponent ? ldexp((double)(low + (1u << m)), exponent - 15 - m)
                                 : ldexp((double)low, -14 - m);
    return bits == 16 && word >> 15 ? -size : size;
}

/* ---- every kind ---- */

double texel_put(const texel_layout *t, int k, double value, void *texel)
{
    const int bits = t->bits[k];
    if (t->kind == TEXEL_FLOAT && bits < 32)
        return put_small_float(t, k, value, texel);
    if (t->kind == TEXEL_FLOAT) {
        const float number = (float)value;
        uint32_t word;
        memcpy(&word, &number, sizeof word);
        put_bits(t, k, word, texel);
        return (double)number;
    }
    const int whole_bits = t->kind == TEXEL_SIGNED ? bits - 1 : bits;
    const double most = (double)((1u << whole_bits) - 1);
    const long whole = lrint(value * most);
    put_bits(t, k, (uint32_t)whole, texel);
    return (double)whole / most;
}

double texel_get(const texel_layout *t, int k, const void *texel)
{
    const int bits = t->bits[k];
    const uint32_t word = get_bits(t, k, texel);
    if (t->kind == TEXEL_FLOAT && bits < 32)
        return get_small_float(t, k, texel);
    if (t->kind == TEXEL_UNSIGNED)
        return word / (double)((1u << bits) - 1);
    if (t->kind == TEXEL_SIGNED) {
        const int32_t half = (int32_t)(1u << (bits - 1));
        const int32_t whole =
            (int32_t)word >= half ? (int32_t)word - 2 * half : (int32_t)word;
        return fmax(-1, (double)whole / (half - 1));
    }
    float number;
    memcpy(&number, &word, sizeof number);
    return (double)number;
}

double texel_rounding(const texel_layout *t)
{
    if (t->kind == TEXEL_FLOAT) /* steps from 1/2 to 1; devices may cut off */
        return t->bits[0] == 32 ? 0 : ldexp(1, -1 - mantissa_bits(t->bits[0]));
    return 0.5 / ((1u << t->bits[0]) - 1);
}
