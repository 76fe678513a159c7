/* SPDX-License-Identifier: MIT */
/* What the kernels of one instruction set are to the backend. */
#ifndef CRV_CPU_KERNELS_KERNEL_H
#define CRV_CPU_KERNELS_KERNEL_H

#include "core/frame.h"

/* Accessibility of the pixels x0 to x1 - 1 of row y, intensity applied, in [0, 1],
 * background 1, to out[0 .. x1 - x0). */
typedef void (*crv__estimate_kernel)(const crv__frame *frame, int32_t x0, int32_t x1,
                                     int32_t y, float *out);

/* One pass of a filter over the same pixels; as crv__filter.filter for each that is not
 * background. */
typedef void (*crv__filter_kernel)(const crv__frame *frame, const crv__plane *input,
                                   int32_t pass, int32_t x0, int32_t x1, int32_t y,
                                   float *out);

typedef struct crv__named_estimate {
    const char *name;
    crv__estimate_kernel run;
} crv__named_estimate;

typedef struct crv__named_filter {
    const char *name;
    crv__filter_kernel run;
} crv__named_filter;

typedef struct crv__kernels {
    const crv__named_estimate *estimates; /* end with a NULL name */
    const crv__named_filter *filters;
} crv__kernels;

#endif
