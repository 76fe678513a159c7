/* SPDX-License-Identifier: MIT */
/* simd.h: what the test of the kernels is made of: random frames and options, and runs
 * between guard bytes. */
#ifndef TESTS_SIMD_H
#define TESTS_SIMD_H

#include "crevice/crevice.h"

/* ---- random numbers: the same on every machine ---- */

typedef struct simd_random {
    uint64_t state;
} simd_random;

/* Numbers that belong to (seed, stream, index). */
simd_random simd_random_make(uint64_t seed, uint64_t stream, uint64_t index);
uint32_t simd_bits(simd_random *r);
/* In [0, 1). */
double simd_unit(simd_random *r);
/* In [low, high], evenly. */
int32_t simd_int(simd_random *r, int32_t low, int32_t high);
double simd_float(simd_random *r, double low, double high);
/* In [low, high], evenly in the logarithm. */
double simd_log(simd_random *r, double low, double high);
/* 1 with probability 1 / n. */
int simd_chance(simd_random *r, int32_t n);

/* ---- a case ---- */

/* What the depth buffer holds. */
typedef enum simd_scene {
    SIMD_SMOOTH,   /* a tilted, wavy surface */
    SIMD_BOXES,    /* rectangles at all depths: silhouettes, background */
    SIMD_NOISE,    /* every pixel at its own depth within a few radii */
    SIMD_FLAT,     /* one depth: every comparison of depths is a tie */
    SIMD_NONSENSE, /* NaN, infinities, negative, zero, tiny and huge depth in between */
    SIMD_SCENES
} simd_scene;

typedef struct simd_case {
    crv_options options;
    crv_gbuffer_desc desc;
    crv_camera camera;
    float *depth[CRV_MAX_LAYERS]; /* packed, desc.layers of them */
    float *normals;               /* packed; NULL: reconstructed */
    float *input;                 /* the accessibility to filter; NULL: run the method */
    int32_t exact;                /* 0 or 1: as in crv_context_desc; made as 1 */
    uint64_t layout;              /* of strides and the order of tiles */
} simd_case;

/* A case of up to size x size px. filter_only: an input for the filter. NULL where memory
 * is out. */
simd_case *simd_case_make(simd_random *r, const crv_method *method,
                          const crv_filter *filter, int filter_only, int32_t size,
                          simd_scene scene);
void simd_case_free(simd_case *c);

/* Prints what differs from the defaults. */
void simd_case_print(const simd_case *c);

/* ---- a run ---- */

/*
 * Computes a case with one instruction set, the tiles in an order of its own. Every
 * memory block and every byte between the result's pixels is guarded. Returns the
 * result, packed, and behind it the bent normals if the options ask for them, or NULL
 * after a line about what went wrong. The caller frees it.
 */
float *simd_run(const simd_case *c, crv_isa isa);

/* Nanoseconds of processor time a pixel of the result, the best of several runs; 0 after
 * a line about what went wrong. */
double simd_time(const simd_case *c, crv_isa isa);

#endif
