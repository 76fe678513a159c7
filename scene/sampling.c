/* SPDX-License-Identifier: MIT */
/*
 * The first two dimensions of Sobol's sequence need no table: the first is the index with
 * its bits reversed, the second takes its direction numbers from Pascal's triangle modulo
 * 2. Scrambling (Owen 1995) flips every bit of a coordinate depending on the bits above
 * it; here by a hash in which carries only run one way (Laine and Karras 2011, with the
 * constants of Vegdahl 2021), on reversed bits.
 */
#include "sampling.h"

uint64_t sampling_mix(uint64_t x)
{
    /* The finaliser of splitmix64 (Steele, Lea, Flood 2014). */
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static uint32_t reversed_bits(uint32_t x)
{
    x = x << 16 | x >> 16;
    x = (x & 0x00ff00ffu) << 8 | (x & 0xff00ff00u) >> 8;
    x = (x & 0x0f0f0f0fu) << 4 | (x & 0xf0f0f0f0u) >> 4;
    x = (x & 0x33333333u) << 2 | (x & 0xccccccccu) >> 2;
    return (x & 0x55555555u) << 1 | (x & 0xaaaaaaaau) >> 1;
}

static uint32_t pascal_bits(uint32_t index)
{
    uint32_t bits = 0;
    for (uint32_t column = 1u << 31; index; index >>= 1, column ^= column >> 1)
        if (index & 1u)
            bits ^= column;
    return bits;
}

/* reversed: the coordinate's bits in reverse. The upper half of the key is a plain shift
 * of all points, which makes each of them exactly uniform. */
static double scrambled(uint32_t reversed, uint64_t key)
{
    uint32_t x = reversed, seed = (uint32_t)key;
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    x = reversed_bits(x) ^ (uint32_t)(key >> 32);
    return ((double)x + 0.5) * 0x1p-32;
}

sample_point sampling_owen_sobol(uint32_t index, uint64_t seed)
{
    uint64_t key = sampling_mix(seed);
    /* Reversed, the first coordinate is the index itself. */
    return (sample_point){
        scrambled(index, key),
        scrambled(reversed_bits(pascal_bits(index)), sampling_mix(key))};
}
