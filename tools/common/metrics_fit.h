/* SPDX-License-Identifier: MIT */
/*
 * metrics_fit.h: how near A comes to B when its strength is adjusted as the library's
 * options do, max(0, 1 - intensity (1 - A))^contrast. Where the rest is small, A differs
 * in strength only, and a user has a knob for that.
 */
#ifndef TOOL_METRICS_FIT_H
#define TOOL_METRICS_FIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Searched: the ranges of the library's options. */
#define METRICS_INTENSITY_MAX 100.0
#define METRICS_POWER_MIN     0.01
#define METRICS_POWER_MAX     100.0

typedef struct metrics_curve {
    double intensity, power;
    double rmse; /* after it */
} metrics_curve;

typedef struct metrics_fit {
    metrics_curve power;     /* best power at intensity 1 */
    metrics_curve intensity; /* best intensity at power 1 */
    metrics_curve both;
} metrics_fit;

/* a, b, mask: as in metrics.h. What cannot matter stays 1. All numbers are NAN without a
 * pixel to compare. Returns false if memory ran out. */
bool metrics_fit_curves(const float *a, const float *b, const uint8_t *mask,
                        int32_t width, int32_t height, metrics_fit *out);

/* What of a curve may change. */
enum { METRICS_INTENSITY = 1, METRICS_POWER = 2 };

/* Downhill from *curve to the nearest best one, whose rmse is set; unlike the search of
 * metrics_fit_curves() it takes little more than a pass over the values. what: bits of
 * the two above. Returns false if memory ran out. */
bool metrics_fit_near(const float *a, const float *b, size_t count, unsigned what,
                      metrics_curve *curve);

#endif
