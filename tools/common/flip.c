/* SPDX-License-Identifier: MIT */
/*
 * FLIP of grey pictures. Grey has no opponent colour: Cx, Cz, a* and b* are zero, and of
 * the contrast sensitivity filters only the achromatic one is seen. All filters that
 * remain are products of a function of x and one of y, so rows are filtered first and
 * kept as long as a column reads them.
 */
#include "flip.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RADIUS_MAX = 70, TAPS_MAX = 2 * RADIUS_MAX + 1 };

typedef struct kernel {
    int32_t radius;
    double taps[TAPS_MAX]; /* from -radius to radius */
} kernel;

/* One-dimensional factors: contrast sensitivity; the feature detectors' Gaussian and its
 * first and second derivative. */
enum { CONTRAST, SMOOTH, EDGE, POINT, KERNELS };

/* Products of one of those along x and one along y. */
enum { SEEN, EDGE_X, EDGE_Y, POINT_X, POINT_Y, PRODUCTS };

static const struct {
    int x, y;
} products[PRODUCTS] = {[SEEN] = {CONTRAST, CONTRAST},
                        [EDGE_X] = {EDGE, SMOOTH},
                        [EDGE_Y] = {SMOOTH, EDGE},
                        [POINT_X] = {POINT, SMOOTH},
                        [POINT_Y] = {SMOOTH, POINT}};

typedef struct side {
    const float *values;
    const uint8_t *mask;
    double *line;           /* one row of luminance, its ends repeated */
    double *rows[KERNELS];  /* the last `ring` filtered rows each */
    double *sums[PRODUCTS]; /* one row */
    int32_t next;           /* the first row that has not been filtered */
} side;

typedef struct evaluation {
    int32_t width, height, support, ring;
    kernel kernels[KERNELS];
    double largest_colour; /* compressed distance of the two colours farthest apart */
} evaluation;

/* Positive taps are made to sum to 1, negative ones to -1. */
static void normalise(kernel *k)
{
    double positive = 0.0, negative = 0.0;
    const int32_t count = 2 * k->radius + 1;
    for (int32_t i = 0; i < count; i++) {
        positive += fmax(k->taps[i], 0.0);
        negative += fmax(-k->taps[i], 0.0);
    }
    for (int32_t i = 0; i < count; i++)
        k->taps[i] /= k->taps[i] > 0.0 ? positive : fmax(negative, 1e-300);
}

static void make_kernels(double ppd, evaluation *e)
{
    const double pi = 3.14159265358979323846;
    /* Section 4.1: the achromatic filter has b1 = 0.0047; the radius is that of the
     * widest filter of all, b1 = 0.04 of the blue-yellow one. */
    const double b_achromatic = 0.0047, b_widest = 0.04;
    /* Section 4.2: features are w = 0.082 degrees wide. */
    const double sigma = 0.5 * 0.082 * ppd;
    const int32_t contrast_radius =
        (int32_t)ceil(3.0 * sqrt(b_widest / (2.0 * pi * pi)) * ppd);
    const int32_t feature_radius = (int32_t)ceil(3.0 * sigma);
    assert(contrast_radius <= RADIUS_MAX && feature_radius <= RADIUS_MAX);
    for (int32_t q = 0; q < KERNELS; q++)
        e->kernels[q].radius = q == CONTRAST ? contrast_radius : feature_radius;
    for (int32_t i = 0; i <= 2 * contrast_radius; i++) {
        const double degrees = (i - contrast_radius) / ppd;
        e->kernels[CONTRAST].taps[i] = exp(-pi * pi * degrees * degrees / b_achromatic);
    }
    for (int32_t i = 0; i <= 2 * feature_radius; i++) {
        const double x = i - feature_radius;
        const double gaussian = exp(-x * x / (2.0 * sigma * sigma));
        e->kernels[SMOOTH].taps[i] = gaussian;
        e->kernels[EDGE].taps[i] = -x * gaussian;
        e->kernels[POINT].taps[i] = (x * x / (sigma * sigma) - 1.0) * gaussian;
    }
    for (int32_t q = 0; q < KERNELS; q++)
        normalise(&e->kernels[q]);
    e->support = contrast_radius > feature_radius ? contrast_radius : feature_radius;
    e->ring = 2 * e->support + 1;
}

static double luminance(float value)
{
    const double v = fmin(fmax((double)value, 0.0), 1.0);
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static int32_t clamp(int32_t value, int32_t last)
{
    return value < 0 ? 0 : value > last ? last : value;
}

static void filter_row(const evaluation *e, side *s, int32_t y)
{
    const size_t w = (size_t)e->width, first = (size_t)y * w;
    const size_t place = (size_t)(y % e->ring) * w;
    for (size_t x = 0; x < w; x++) {
        const bool seen = !s->mask || s->mask[first + x];
        s->line[(size_t)e->support + x] = seen ? luminance(s->values[first + x]) : 1.0;
    }
    for (int32_t i = 0; i < e->support; i++) {
        s->line[i] = s->line[e->support];
        s->line[e->width + e->support + i] = s->line[e->width + e->support - 1];
    }
    for (int32_t q = 0; q < KERNELS; q++) {
        const kernel *k = &e->kernels[q];
        const double *in = s->line + (e->support - k->radius);
        double *out = s->rows[q] + place;

        memset(out, 0, w * sizeof *out);
        for (int32_t i = 0; i <= 2 * k->radius; i++)
            for (size_t x = 0; x < w; x++)
                out[x] += k->taps[i] * in[(size_t)i + x];
    }
}

/* The products along columns, around row y. */
static void filter_columns(const evaluation *e, side *s, int32_t y)
{
    const size_t w = (size_t)e->width;
    while (s->next < e->height && s->next <= y + e->support)
        filter_row(e, s, s->next++);
    for (int32_t q = 0; q < PRODUCTS; q++) {
        const kernel *k = &e->kernels[products[q].y];
        double *out = s->sums[q];

        memset(out, 0, w * sizeof *out);
        for (int32_t i = 0; i <= 2 * k->radius; i++) {
            const int32_t row = clamp(y + i - k->radius, e->height - 1);
            const double *in = s->rows[products[q].x] + (size_t)(row % e->ring) * w;
            for (size_t x = 0; x < w; x++)
                out[x] += k->taps[i] * in[x];
        }
    }
}

/* CIE L* of a luminance. */
static double lightness(double y)
{
    const double delta = 6.0 / 29.0;
    const double f =
        y > delta * delta * delta ? cbrt(y) : y / (3.0 * delta * delta) + 4.0 / 29.0;
    return 116.0 * f - 16.0;
}

static double colour_difference(const evaluation *e, double seen_a, double seen_b)
{
    const double knee = 0.4 * e->largest_colour; /* p_c; what p_t = 0.95 is mapped to */
    const double a = lightness(fmin(fmax(seen_a, 0.0), 1.0));
    const double b = lightness(fmin(fmax(seen_b, 0.0), 1.0));
    const double difference = pow(fabs(a - b), 0.7); /* q_c */
    if (difference < knee)
        return difference * 0.95 / knee;
    return 0.95 + 0.05 * (difference - knee) / (e->largest_colour - knee);
}

static double pixel(const evaluation *e, const side *a, const side *b, size_t x)
{
    const double edge = hypot(a->sums[EDGE_X][x], a->sums[EDGE_Y][x])
                        - hypot(b->sums[EDGE_X][x], b->sums[EDGE_Y][x]);
    const double point = hypot(a->sums[POINT_X][x], a->sums[POINT_Y][x])
                         - hypot(b->sums[POINT_X][x], b->sums[POINT_Y][x]);
    const double feature =
        sqrt(fmax(fabs(edge), fabs(point)) / sqrt(2.0)); /* q_f = 0.5 */
    return pow(colour_difference(e, a->sums[SEEN][x], b->sums[SEEN][x]), 1.0 - feature);
}

static size_t side_doubles(const evaluation *e)
{
    const size_t w = (size_t)e->width;
    return w + 2 * (size_t)e->support + (KERNELS * (size_t)e->ring + PRODUCTS) * w;
}

static double *lay_out(const evaluation *e, side *s, double *memory)
{
    const size_t w = (size_t)e->width;
    s->line = memory;
    memory += w + 2 * (size_t)e->support;
    for (int32_t q = 0; q < KERNELS; q++, memory += (size_t)e->ring * w)
        s->rows[q] = memory;
    for (int32_t q = 0; q < PRODUCTS; q++, memory += w)
        s->sums[q] = memory;
    return memory;
}

bool flip_compare(const float *a, const float *b, const uint8_t *mask, int32_t width,
                  int32_t height, double ppd, flip_watch watch, void *user, double *mean)
{
    evaluation e = {.width = width, .height = height};
    side first = {.values = a, .mask = mask}, second = {.values = b, .mask = mask};
    double sum = 0.0;
    int64_t count = 0;
    assert(ppd >= FLIP_PPD_MIN && ppd <= FLIP_PPD_MAX);
    make_kernels(ppd, &e);
    /* HyAB distance of Hunt-adjusted pure green and pure blue, to the power q_c = 0.7. */
    e.largest_colour = pow(203.30165461087745, 0.7);
    double *memory = calloc(2 * side_doubles(&e), sizeof *memory);
    if (!memory)
        return false;
    lay_out(&e, &second, lay_out(&e, &first, memory));
    for (int32_t y = 0; y < height; y++) {
        filter_columns(&e, &first, y);
        filter_columns(&e, &second, y);
        for (size_t x = 0; x < (size_t)width; x++) {
            if (mask && !mask[(size_t)y * (size_t)width + x])
                continue;
            sum += pixel(&e, &first, &second, x);
            count++;
        }
        if (watch)
            watch(user, y + 1);
    }
    free(memory);
    *mean = count > 0 ? sum / (double)count : NAN;
    return true;
}
