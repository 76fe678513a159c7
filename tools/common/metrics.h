/* SPDX-License-Identifier: MIT */
/* metrics.h: how far two pictures are apart. */
#ifndef TOOL_METRICS_H
#define TOOL_METRICS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct metrics {
    int64_t pixels; /* compared */
    double mean_a, mean_b;
    double rmse, mae;
    double bias; /* mean of the signed error a - b */
    /* 1 and 99 percent of the signed errors are below; between two errors in a line. */
    double error_q01, error_q99;
    double psnr_db; /* of a peak of 1; INFINITY for equal pictures */
    /* Wang, Bovik, Sheikh, Simoncelli 2004: 11x11 Gaussian windows of sigma 1.5, K1 0.01,
     * K2 0.03, dynamic range 1, over the windows that lie wholly inside the picture and
     * hold compared pixels only. NAN if there is none. */
    double ssim;
    int64_t ssim_windows;
    double max_error; /* largest |a - b|, first met from the top left */
    int32_t max_x, max_y;
} metrics;

/* a, b: width * height packed floats. mask: a byte for each pixel, nonzero to compare it,
 * or NULL for all; compared values must be finite. Without a pixel to compare, all
 * numbers are NAN. Returns false if memory ran out. */
bool metrics_compare(const float *a, const float *b, const uint8_t *mask, int32_t width,
                     int32_t height, metrics *out);

/* The number of values among those compared that are NaN or infinite. */
int64_t metrics_count_not_finite(const float *a, const uint8_t *mask, int32_t width,
                                 int32_t height);

#endif
