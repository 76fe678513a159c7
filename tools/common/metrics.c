/* SPDX-License-Identifier: MIT */
#include "metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "quantile.h"

enum { WINDOW = 11 };

/* What a window is summed up in: weighted means, and how many pixels it must not hold. */
enum { SUM_A, SUM_B, SUM_AA, SUM_BB, SUM_AB, SUM_MASKED, SUM_COUNT };

int64_t metrics_count_not_finite(const float *a, const uint8_t *mask, int32_t width,
                                 int32_t height)
{
    const size_t count = (size_t)width * (size_t)height;
    int64_t found = 0;
    for (size_t i = 0; i < count; i++)
        found += (!mask || mask[i]) && !isfinite(a[i]);
    return found;
}

static bool compare_signed(const float *a, const float *b, const uint8_t *mask,
                           int32_t width, int32_t height, metrics *out)
{
    size_t count = (size_t)width * (size_t)height, n = 0;
    double *errors = malloc((count > 0 ? count : 1) * sizeof *errors);
    double sum = 0.0;
    if (!errors)
        return false;
    for (size_t i = 0; i < count; i++) {
        if (mask && !mask[i])
            continue;
        errors[n] = (double)a[i] - (double)b[i];
        sum += errors[n++];
    }
    quantile_sort(errors, n);
    out->bias = sum / (double)n;
    out->error_q01 = n > 0 ? quantile(errors, n, 0.01) : NAN;
    out->error_q99 = n > 0 ? quantile(errors, n, 0.99) : NAN;
    free(errors);
    return true;
}

static void compare_pixels(const float *a, const float *b, const uint8_t *mask,
                           int32_t width, int32_t height, metrics *out)
{
    double sum_a = 0.0, sum_b = 0.0, sum_error = 0.0, sum_square = 0.0;
    out->max_error = -1.0;
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            const size_t i = (size_t)y * (size_t)width + (size_t)x;
            const double error = fabs((double)a[i] - (double)b[i]);

            if (mask && !mask[i])
                continue;
            out->pixels++;
            sum_a += (double)a[i];
            sum_b += (double)b[i];
            sum_error += error;
            sum_square += error * error;
            if (error > out->max_error) {
                out->max_error = error;
                out->max_x = x;
                out->max_y = y;
            }
        }
    }
    const double n = (double)out->pixels;
    out->mean_a = sum_a / n;
    out->mean_b = sum_b / n;
    out->mae = sum_error / n;
    out->rmse = sqrt(sum_square / n);
    out->psnr_db = -20.0 * log10(out->rmse);
    if (out->pixels == 0)
        out->max_error = NAN;
}

static void make_window(double weights[WINDOW])
{
    const double sigma = 1.5;
    double sum = 0.0;
    for (int i = 0; i < WINDOW; i++) {
        const double r = i - WINDOW / 2;
        weights[i] = exp(-r * r / (2.0 * sigma * sigma));
        sum += weights[i];
    }
    for (int i = 0; i < WINDOW; i++)
        weights[i] /= sum;
}

/* Columns of the WINDOW rows from `y` on, into SUM_COUNT rows of `width` each. */
static void sum_columns(const float *a, const float *b, const uint8_t *mask,
                        int32_t width, int32_t y, const double weights[WINDOW],
                        double *columns)
{
    const size_t w = (size_t)width;
    memset(columns, 0, SUM_COUNT * w * sizeof *columns);
    for (int k = 0; k < WINDOW; k++) {
        const size_t row = ((size_t)y + (size_t)k) * w;
        for (size_t x = 0; x < w; x++) {
            const double va = (double)a[row + x], vb = (double)b[row + x];

            if (mask && !mask[row + x]) {
                columns[SUM_MASKED * w + x] += 1.0;
                continue;
            }
            columns[SUM_A * w + x] += weights[k] * va;
            columns[SUM_B * w + x] += weights[k] * vb;
            columns[SUM_AA * w + x] += weights[k] * va * va;
            columns[SUM_BB * w + x] += weights[k] * vb * vb;
            columns[SUM_AB * w + x] += weights[k] * va * vb;
        }
    }
}

static double ssim_of_window(const double s[SUM_COUNT])
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    /* Rounding must not make a variance negative. */
    const double variance_a = fmax(s[SUM_AA] - s[SUM_A] * s[SUM_A], 0.0);
    const double variance_b = fmax(s[SUM_BB] - s[SUM_B] * s[SUM_B], 0.0);
    const double covariance = s[SUM_AB] - s[SUM_A] * s[SUM_B];
    return (2.0 * s[SUM_A] * s[SUM_B] + c1) * (2.0 * covariance + c2)
           / ((s[SUM_A] * s[SUM_A] + s[SUM_B] * s[SUM_B] + c1)
              * (variance_a + variance_b + c2));
}

static bool compare_windows(const float *a, const float *b, const uint8_t *mask,
                            int32_t width, int32_t height, metrics *out)
{
    double weights[WINDOW], sum = 0.0;
    const size_t w = (size_t)width;
    double *columns = calloc(SUM_COUNT * w, sizeof *columns);
    if (!columns)
        return false;
    make_window(weights);
    for (int32_t y = 0; y + WINDOW <= height; y++) {
        sum_columns(a, b, mask, width, y, weights, columns);
        for (size_t x = 0; x + WINDOW <= w; x++) {
            double s[SUM_COUNT] = {0};
            for (size_t k = 0; k < WINDOW; k++) {
                for (size_t q = 0; q < SUM_MASKED; q++)
                    s[q] += weights[k] * columns[q * w + x + k];
                s[SUM_MASKED] += columns[SUM_MASKED * w + x + k];
            }
            if (s[SUM_MASKED] > 0.0)
                continue;
            sum += ssim_of_window(s);
            out->ssim_windows++;
        }
    }
    out->ssim = out->ssim_windows > 0 ? sum / (double)out->ssim_windows : NAN;
    free(columns);
    return true;
}

bool metrics_compare(const float *a, const float *b, const uint8_t *mask, int32_t width,
                     int32_t height, metrics *out)
{
    *out = (metrics){0};
    compare_pixels(a, b, mask, width, height, out);
    return compare_signed(a, b, mask, width, height, out)
           && compare_windows(a, b, mask, width, height, out);
}
