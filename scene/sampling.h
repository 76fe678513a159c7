/* SPDX-License-Identifier: MIT */
/*
 * sampling.h: well-spread random points in the unit square.
 */
#ifndef CREVICE_SCENE_SAMPLING_H
#define CREVICE_SCENE_SAMPLING_H

#include <stdint.h>

typedef struct sample_point {
    double u, v; /* in (0, 1) */
} sample_point;

/* A hash of 64 bits whose every bit depends on every bit of the input. */
uint64_t sampling_mix(uint64_t x);

/*
 * Point `index` of the Owen-scrambled Sobol sequence that belongs to this seed. The first
 * 2^k points, and every further run of 2^k that begins at a multiple of 2^k, have exactly
 * one in each of 2^k equal boxes of any shape 2^-a x 2^-(k-a). Each point by itself is
 * uniform over the seeds; sequences of different seeds are independent.
 */
sample_point sampling_owen_sobol(uint32_t index, uint64_t seed);

#endif
