/* SPDX-License-Identifier: MIT */
/*
 * samples.h: the texels that a method reads for one pixel, found by trying: something is
 * put in front of a part of an empty neighbourhood, and if that changes the pixel, a
 * texel of the part is read. So it holds for every method, whatever its noise and its
 * pattern. Sampling is exact (crv_context_desc.exact): where deinterleaved kernels read
 * depends on the depth of neighbours, too.
 */
#ifndef VIEW_SAMPLES_H
#define VIEW_SAMPLES_H

#include "buffers.h"
#include "crevice/crevice.h"

enum { SAMPLES_MAX = 512, SAMPLES_REACH_PX = 256 };

typedef struct sample {
    int32_t x, y; /* the texel, from the pixel (0, 0) inside the guard band */
    bool counts;  /* the pixel would be another without what is there */
} sample;

typedef struct samples {
    int32_t x, y; /* the pixel */
    int32_t count;
    bool is_whole; /* none lies beyond SAMPLES_REACH_PX, none was too many */
    sample list[SAMPLES_MAX];
} samples;

/* context: exact, on the CPU, with one thread, as the many runs are small. is_stale(user)
 * is asked now and then: true gives it up. False then, after a failure, and if the pixel
 * shows no surface. */
bool samples_find(crv_context *context, const buffers *b, const crv_options *options,
                  int32_t x, int32_t y, bool (*is_stale)(void *user), void *user,
                  samples *out);

#endif
