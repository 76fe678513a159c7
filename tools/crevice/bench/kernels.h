/* SPDX-License-Identifier: MIT */
/* kernels.h: loops that do one thing as fast as an instruction set allows. */
#ifndef TOOL_BENCH_KERNELS_H
#define TOOL_BENCH_KERNELS_H

#include "crevice/crevice.h"

enum { BENCH_PLACES = 64, BENCH_LANES_MAX = 16, BENCH_CHAINS = 12 };

/* Reads `width` pixels from `row` on, a vector of them at a time, each at all places:
 * offsets has BENCH_PLACES rows of BENCH_LANES_MAX, one for every lane; loads use the
 * first of a row. Returns a sum, so that no read can be left out. */
typedef float (*bench_read_kernel)(const float *row, const int32_t *offsets,
                                   int32_t width);

typedef struct bench_kernels {
    crv_isa isa;
    int32_t lanes;
    bench_read_kernel gather, load;
    /* `rounds` times BENCH_CHAINS vectors of a = a * factor + factor. */
    float (*fma)(float factor, int32_t rounds);
} bench_kernels;

/* The sets that were compiled in, ended by one of no lanes. */
extern const bench_kernels bench_kernels_list[];

#endif
