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

/* The finite value below which this share of them lies, 0.5 for the median: positive
 * floats are in the order of their bits, so that it is found half the bits at a time by
 * counting, many times as fast as by sorting. False if memory is out; *out is 0 if there
 * is no finite value. */
static bool find_quantile(const float *values, size_t count, double share, double *out)
{
    size_t *bins = calloc(BINS, sizeof *bins), rank = 0;
    if (!bins)
        return false;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i])) {
            bins[bits_of(values[i]) >> HALF_BITS]++;
            rank++;
        }
    *out = 0.0;
    if (rank > 0) {
        rank = (size_t)((double)rank * share);
        uint32_t bits = bin_of_rank(bins, &rank) << HALF_BITS;
        memset(bins, 0, BINS * sizeof *bins);
        for (size_t i = 0; i < count; i++)
            if (bits_of(values[i]) >> HALF_BITS == bits >> HALF_BITS)
                bins[bits_of(values[i]) & (BINS - 1)]++;
        bits |= bin_of_rank(bins, &rank);
        float value;
        memcpy(&value, &bits, sizeof value);
        *out = (double)value;
    }
    free(bins);
    return true;
}

/* The finite depths that these shares of them are nearer than; 0 if there is none. */
static int depths_of_shares(estimator *e, const double *shares, int count, double *out,
                            report *r)
{
    float *depth = NULL;
    const int result = estimate_depth(e, &depth, r);
    if (result != EXIT_DONE)
        return result;
    bool done = true;
    for (int i = 0; i < count && done; i++)
        done = find_quantile(depth, (size_t)e->desc.width * (size_t)e->desc.height,
                             shares[i], &out[i]);
    free(depth);
    return done ? EXIT_DONE : report_no_memory(r);
}

static double two_digits(double value)
{
    const double unit = pow(10.0, floor(log10(value)) - 1.0);
    return round(value / unit) * unit;
}

/* The height in scene units that the picture shows at this depth. */
static double height_at(const io_frame *frame, double depth)
{
    const double height = frame->image.display_height / (double)frame->camera.fy_px;
    return frame->camera.projection == CRV_PERSPECTIVE ? height * depth : height;
}

/* The radius that suits a view with this median depth; 0 if it shows nothing. */
static float usual_radius(const io_frame *frame, double median)
{
    const crv_option *option = crv_option_find("radius");
    if (median <= 0.0)
        return 0.0f;
    /* Within what the option takes, however odd the depth. */
    return (float)fmin(fmax(two_digits(0.05 * height_at(frame, median)), option->min),
                       option->max);
}

int radius_suggest(estimator *e, const io_frame *frame, float *out, report *r)
{
    const double share = 0.5;
    double median = 0.0;
    const int result = depths_of_shares(e, &share, 1, &median, r);
    *out = usual_radius(frame, median);
    return result;
}

int radius_check(estimator *e, const io_frame *frame, float radius, const char *input,
                 report *r)
{
    const double too_many_heights = 10.0;
    const double shares[] = {0.05, 0.5};
    double depths[2] = {0.0, 0.0};
    const int result = depths_of_shares(e, shares, 2, depths, r);
    const double near = depths[0], median = depths[1];
    if (result != EXIT_DONE || near <= 0.0)
        return result;
    const double usual = (double)usual_radius(frame, median);
    const double near_px =
        (double)radius / height_at(frame, near) * frame->image.display_height;
    const double heights = (double)radius / height_at(frame, median);
    if (near_px < 1.0)
        report_warning(r,
                       "%s: the radius %g is %.2g pixels wide on near surfaces, too "
                       "little to darken any; is depth in another unit? Without "
                       "--radius it would be %g",
                       input, (double)radius, near_px, usual);
    else if (heights > too_many_heights)
        report_warning(r,
                       "%s: the radius %g is %.2g times the height of the view at the "
                       "median depth; is depth in another unit? Without --radius it "
                       "would be %g",
                       input, (double)radius, heights, usual);
    return EXIT_DONE;
}
