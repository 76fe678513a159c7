/* SPDX-License-Identifier: MIT */
#include "radius.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HALF_BITS = 16, BINS = 1 << HALF_BITS };

/* The bin that holds the element of this rank, counting from 0; *rank becomes its rank
 * within the bin. */
static uint32_t bin_of_rank(const size_t *bins, size_t *rank)
{
    uint32_t bin = 0;
    while (*rank >= bins[bin])
        *rank -= bins[bin++];
    return bin;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The median of the finite values: positive floats are in the order of their bits, so
 * that it is found half the bits at a time by counting, many times as fast as by sorting.
 * False if memory is out; *median is 0 if there is no finite value. */
static bool find_median(const float *values, size_t count, double *median)
{
    size_t *bins = calloc(BINS, sizeof *bins), rank = 0;
    if (!bins)
        return false;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i])) {
            bins[bits_of(values[i]) >> HALF_BITS]++;
            rank++;
        }
    *median = 0.0;
    if (rank > 0) {
        rank /= 2;
        uint32_t bits = bin_of_rank(bins, &rank) << HALF_BITS;
        memset(bins, 0, BINS * sizeof *bins);
        for (size_t i = 0; i < count; i++)
            if (bits_of(values[i]) >> HALF_BITS == bits >> HALF_BITS)
                bins[bits_of(values[i]) & (BINS - 1)]++;
        bits |= bin_of_rank(bins, &rank);
        float value;
        memcpy(&value, &bits, sizeof value);
        *median = (double)value;
    }
    free(bins);
    return true;
}

/* The median of the finite depths, 0 if there is none. */
static int median_depth(estimator *e, double *out, report *r)
{
    float *depth = NULL;
    const int result = estimate_depth(e, &depth, r);
    if (result != EXIT_DONE)
        return result;
    const bool done =
        find_median(depth, (size_t)e->desc.width * (size_t)e->desc.height, out);
    free(depth);
    return done ? EXIT_DONE : report_no_memory(r);
}

static double two_digits(double value)
{
    const double unit = pow(10.0, floor(log10(value)) - 1.0);
    return round(value / unit) * unit;
}

int radius_suggest(estimator *e, const io_frame *frame, float *out, report *r)
{
    double median = 0.0;
    const int result = median_depth(e, &median, r);
    double height = frame->image.display_height / (double)frame->camera.fy_px;
    const crv_option *option = crv_option_find("radius");
    *out = 0.0f;
    if (result != EXIT_DONE || median <= 0.0)
        return result;
    if (frame->camera.projection == CRV_PERSPECTIVE)
        height *= median;
    /* Within what the option takes, however odd the depth. */
    *out = (float)fmin(fmax(two_digits(0.05 * height), option->min), option->max);
    return EXIT_DONE;
}
