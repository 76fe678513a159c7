/* SPDX-License-Identifier: MIT */
#include "core/noise.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

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

static float below_one(double x)
{
    return (float)fmin(x, 1 - 1e-6);
}

/* In (-1, 1), of a number in [0, 1]. */
static double jitter(double b)
{
    return fmin(fmax(2 * b - 1, -1 + 1e-6), 1 - 1e-6);
}

/* Rotation, jitter and sector offset of a texel, each in [0, 1). */
typedef struct triple {
    double alpha, beta, sector;
} triple;

/* The rank-th of `count` points of a Hammersley set. */
static triple hammersley(uint32_t rank, uint32_t count)
{
    return (triple){(rank + 0.5) / count, radical_inverse(rank, 2) + 0.5 / count,
                    radical_inverse(rank, 3) + 0.5 / count};
}

/*
 * The texel (x, y) of a tile whose size is a power of two, 4 at least. In the field of
 * four elements, of which w is the third,
 *
 *     x + w y,   x + w^2 y,   x + y
 *
 * are Latin squares each two of which are orthogonal. They choose the quarters of the
 * three intervals; the next digit of each is the quarter of another one. The rest is that
 * of the block in the tile.
 */
static triple latin(uint32_t x, uint32_t y, uint32_t size)
{
    static const uint32_t TIMES_W[4] = {0, 2, 3, 1}, TIMES_W2[4] = {0, 3, 1, 2};
    const uint32_t row = y & 3, column = x & 3, blocks = size / 4 * (size / 4);
    const double a = column ^ TIMES_W[row], b = column ^ TIMES_W2[row], c = column ^ row;
    const triple rest = hammersley(ordered_rank(x / 4, y / 4, size / 4), blocks);
    return (triple){(4 * a + b + rest.alpha) / 16, (4 * b + a + rest.beta) / 16,
                    (4 * c + a + fmod(rest.sector, 1)) / 16};
}

static bool is_power_of_two(uint32_t size)
{
    return (size & (size - 1)) == 0;
}

/* A shuffled set of ranks. */
static void rank_texels(uint32_t *rank, uint32_t count, uint32_t seed)
{
    for (uint32_t i = 0; i < count; i++) { /* Fisher-Yates, inside out */
        uint32_t j = hash(seed, i + 3) % (i + 1);
        rank[i] = rank[j];
        rank[j] = i;
    }
}

/* The i-th texel of a tile; of a size that is no power of two, by its shuffled ranks. */
static triple triple_of(uint32_t i, uint32_t size, uint32_t seed, const uint32_t *rank)
{
    if (!is_power_of_two(size))
        return hammersley(rank[i], size * size);
    const uint32_t x = (i % size + (seed ? hash(seed, 1) : 0)) % size,
                   y = (i / size + (seed ? hash(seed, 2) : 0)) % size;
    return size >= 4 ? latin(x, y, size)
                     : hammersley(ordered_rank(x, y, size), size * size);
}

void crv__noise_fill(crv__noise_texel *tile, int32_t size, double sector_rad,
                     int32_t seed, uint32_t *scratch)
{
    const uint32_t edge = (uint32_t)size, count = edge * edge;
    const double shift_alpha = seed ? hash((uint32_t)seed, 4) / 4294967296.0 : 0;
    const double shift_beta = seed ? hash((uint32_t)seed, 5) / 4294967296.0 : 0;
    const double shift_sector = seed ? hash((uint32_t)seed, 6) / 4294967296.0 : 0;
    if (!is_power_of_two(edge))
        rank_texels(scratch, count, (uint32_t)seed);
    for (uint32_t i = 0; i < count; i++) {
        const triple t = triple_of(i, edge, (uint32_t)seed, scratch);
        const double a = fmod(t.alpha + shift_alpha, 1);
        const double beta = jitter(fmod(t.beta + shift_beta, 1));
        const double sector = fmod(t.sector + shift_sector, 1);
        tile[i] = (crv__noise_texel){
            .cos_alpha = (float)cos(a * sector_rad),
            .sin_alpha = (float)sin(a * sector_rad),
            .beta = (float)beta,
            .sector_offset = below_one(sector),
        };
    }
}

/* The additive recurrence on the powers of 1/g, g the real root of g^4 = g + 1. */
void crv__noise_advance(const crv__noise_texel *tile, int32_t size, double sector_rad,
                        uint32_t index, crv__noise_texel *out)
{
    const double g = 1.2207440846057596;
    const double turn = fmod(index / g, 1) * sector_rad;
    const double shift_beta = fmod(index / (g * g), 1),
                 shift_sector = fmod(index / (g * g * g), 1);
    const double c = cos(turn), s = sin(turn);
    const size_t count = (size_t)size * (size_t)size;
    memmove(out, tile, count * sizeof *out);
    for (size_t i = 0; index > 0 && i < count; i++) {
        const double x = (double)tile[i].cos_alpha, y = (double)tile[i].sin_alpha;
        const double b = fmod(0.5 + 0.5 * (double)tile[i].beta + shift_beta, 1);
        out[i].cos_alpha = (float)(x * c - y * s);
        out[i].sin_alpha = (float)(x * s + y * c);
        out[i].beta = (float)jitter(b);
        out[i].sector_offset =
            below_one(fmod((double)tile[i].sector_offset + shift_sector, 1));
    }
}
