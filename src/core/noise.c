/* SPDX-License-Identifier: MIT */
#include "core/noise.h"

#include <math.h>

/* Van der Corput's radical inverse. */
static double radical_inverse(uint32_t i, uint32_t base)
{
    double value = 0, digit = 1.0 / base;
    for (; i; i /= base, digit /= base)
        value += digit * (i % base);
    return value;
}

/* The rank of (x, y) in a recursive ordered-dither matrix of this size, a power of two.
 */
static uint32_t ordered_rank(uint32_t x, uint32_t y, uint32_t size)
{
    static const uint32_t QUAD[2][2] = {{0, 2}, {3, 1}};
    uint32_t rank = 0;
    for (uint32_t bit = 1; bit < size; bit <<= 1)
        rank = rank * 4 + QUAD[(y & bit) != 0][(x & bit) != 0];
    return rank;
}

/* PCG-style hash: one well-mixed word of two. */
static uint32_t hash(uint32_t a, uint32_t b)
{
    uint32_t h = a * 747796405u + b * 2891336453u + 1u;
    h = ((h >> ((h >> 28) + 4u)) ^ h) * 277803737u;
    return (h >> 22) ^ h;
}

static void rank_texels(uint32_t *rank, uint32_t size, uint32_t seed)
{
    const uint32_t count = size * size;
    if ((size & (size - 1)) == 0) {
        const uint32_t shift_x = seed ? hash(seed, 1) : 0,
                       shift_y = seed ? hash(seed, 2) : 0;
        for (uint32_t i = 0; i < count; i++)
            rank[i] = ordered_rank((i % size + shift_x) % size,
                                   (i / size + shift_y) % size, size);
        return;
    }
    for (uint32_t i = 0; i < count; i++) { /* Fisher-Yates, inside out */
        uint32_t j = hash(seed, i + 3) % (i + 1);
        rank[i] = rank[j];
        rank[j] = i;
    }
}

void crv__noise_fill(crv__noise_texel *tile, int32_t size, double sector_rad,
                     int32_t seed, uint32_t *scratch)
{
    const uint32_t edge = (uint32_t)size, count = edge * edge;
    const double shift_alpha = seed ? hash((uint32_t)seed, 4) / 4294967296.0 : 0;
    const double shift_beta = seed ? hash((uint32_t)seed, 5) / 4294967296.0 : 0;
    const double shift_sector = seed ? hash((uint32_t)seed, 6) / 4294967296.0 : 0;
    rank_texels(scratch, edge, (uint32_t)seed);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t rank = scratch[i];
        double a = fmod((rank + 0.5) / count + shift_alpha, 1);
        double b = fmod(radical_inverse(rank, 2) + 0.5 / count + shift_beta, 1);
        double beta = fmin(fmax(2 * b - 1, -1 + 1e-6), 1 - 1e-6);
        const double sector =
            fmod(radical_inverse(rank, 3) + 0.5 / count + shift_sector, 1);
        tile[i] = (crv__noise_texel){
            .cos_alpha = (float)cos(a * sector_rad),
            .sin_alpha = (float)sin(a * sector_rad),
            .beta = (float)beta,
            .sector_offset = (float)fmin(sector, 1 - 1e-6),
        };
    }
}
