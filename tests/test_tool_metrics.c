/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "common/metrics.h"

/* Sums of a few hundred doubles: far below this. */
static const double rounding = 1e-12;

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.15g is not %.15g within %g", value, expected, tolerance);
}

static void fill(float *pixels, size_t count, float value)
{
    for (size_t i = 0; i < count; i++)
        pixels[i] = value;
}

enum { WIDTH = 16, HEIGHT = 13, COUNT = WIDTH * HEIGHT };

/* Eighths and quarters: exact in binary. */
static void fill_pattern(float a[COUNT], float b[COUNT])
{
    for (int i = 0; i < COUNT; i++) {
        a[i] = (float)(i % 7) / 8.0f;
        b[i] = (float)(i % 5) / 4.0f;
    }
}

static void test_identical(void **state)
{
    float a[COUNT], b[COUNT];
    metrics m;

    (void)state;
    fill_pattern(a, b);
    assert_true(metrics_compare(a, a, NULL, WIDTH, HEIGHT, &m));
    assert_int_equal(m.pixels, COUNT);
    assert_near(m.rmse, 0.0, 0.0);
    assert_near(m.mae, 0.0, 0.0);
    assert_near(m.max_error, 0.0, 0.0);
    assert_near(m.bias, 0.0, 0.0);
    assert_near(m.error_q01, 0.0, 0.0);
    assert_near(m.error_q99, 0.0, 0.0);
    assert_true(isinf(m.psnr_db) && m.psnr_db > 0.0);
    assert_near(m.ssim, 1.0, rounding);
    assert_int_equal(m.ssim_windows, (WIDTH - 10) * (HEIGHT - 10));
}

/* SSIM of constant pictures is its luminance term, (2 a b + C1)/(a^2 + b^2 + C1). */
static void test_constant_offset(void **state)
{
    float a[COUNT], b[COUNT];
    metrics m;

    (void)state;
    fill(a, COUNT, 0.25f);
    fill(b, COUNT, 0.75f);
    assert_true(metrics_compare(a, b, NULL, WIDTH, HEIGHT, &m));
    assert_near(m.rmse, 0.5, rounding);
    assert_near(m.mae, 0.5, rounding);
    assert_near(m.bias, -0.5, rounding);
    assert_near(m.error_q01, -0.5, rounding);
    assert_near(m.error_q99, -0.5, rounding);
    assert_near(m.psnr_db, 20.0 * log10(2.0), rounding);
    assert_near(m.max_error, 0.5, rounding);
    assert_near(m.ssim, (0.375 + 1e-4) / (0.625 + 1e-4), rounding);
    assert_near(m.mean_a, 0.25, rounding);
    assert_near(m.mean_b, 0.75, rounding);
}

static void test_one_pixel(void **state)
{
    float a[16], b[16];
    metrics m;

    (void)state;
    fill(a, 16, 0.5f);
    fill(b, 16, 0.5f);
    b[1 * 4 + 3] = 0.25f;
    assert_true(metrics_compare(a, b, NULL, 4, 4, &m));
    assert_near(m.rmse, 0.25 / 4.0, rounding);
    assert_near(m.mae, 0.25 / 16.0, rounding);
    assert_int_equal(m.max_x, 3);
    assert_int_equal(m.max_y, 1);
    /* Smaller than a window. */
    assert_int_equal(m.ssim_windows, 0);
    assert_true(isnan(m.ssim));
}

/* One window, an impulse of height p in the first picture and q in the second at its
 * centre, zero elsewhere. With the centre's weight w the means are p w and q w, variances
 * and covariance w (1 - w) times p^2, q^2 and p q: SSIM by hand. w is the square of
 * 1 / (1 + 2 sum of exp(-r^2 / 4.5), r = 1 to 5). */
static void test_ssim_by_hand(void **state)
{
    float a[11 * 11] = {0.0f}, b[11 * 11] = {0.0f};
    const double c1 = 1e-4, c2 = 9e-4, p = 1.0, q = 0.5;
    double sum = 1.0, w, between;
    metrics m;

    (void)state;
    a[5 * 11 + 5] = 1.0f;
    b[5 * 11 + 5] = 0.5f;
    for (int r = 1; r <= 5; r++)
        sum += 2.0 * exp(-(double)(r * r) / 4.5);
    w = 1.0 / (sum * sum);
    between = w * (1.0 - w);
    assert_true(metrics_compare(a, b, NULL, 11, 11, &m));
    assert_int_equal(m.ssim_windows, 1);
    assert_near(m.ssim,
                (2.0 * p * q * w * w + c1) * (2.0 * p * q * between + c2)
                    / (((p * p + q * q) * w * w + c1) * ((p * p + q * q) * between + c2)),
                rounding);
}

/* Errors of -1, -0.98, ... 1, shuffled: 101 of them, so 1 and 99 percent are the second
 * and the last but one. With one more of 1 in 102 they fall between: at 1.01 and 99.99
 * counted from 0, that is -0.98 + 0.01 * 0.02, and 0.98 + 0.99 * 0.02. */
static void test_quantiles(void **state)
{
    /* Steps of 0.02 are not exact in single precision. */
    const double single = 1e-7;
    float a[102], b[102];
    metrics m;

    (void)state;
    for (int i = 0; i < 101; i++) {
        int place = i * 37 % 101;
        b[i] = (float)(i % 4) / 4.0f;
        a[i] = b[i] + (float)(place - 50) / 50.0f;
    }
    assert_true(metrics_compare(a, b, NULL, 101, 1, &m));
    assert_near(m.error_q01, -0.98, single);
    assert_near(m.error_q99, 0.98, single);
    assert_near(m.bias, 0.0, single);
    a[101] = 1.0f;
    b[101] = 0.0f;
    assert_true(metrics_compare(a, b, NULL, 102, 1, &m));
    assert_near(m.error_q01, -0.9798, single);
    assert_near(m.error_q99, 0.9998, single);
    assert_near(m.bias, 1.0 / 102.0, single);
}

/* Expected values: a separate program in another language that forms each window's
 * two-dimensional weights and central moments, as the paper writes them. */
static void test_pattern(void **state)
{
    float a[COUNT], b[COUNT];
    metrics m;

    (void)state;
    fill_pattern(a, b);
    assert_true(metrics_compare(a, b, NULL, WIDTH, HEIGHT, &m));
    assert_near(m.rmse, 0.4524406304018921, rounding);
    assert_near(m.mae, 0.36959134615384615, rounding);
    assert_near(m.psnr_db, 6.888768023339875, rounding);
    assert_near(m.ssim, 0.2829265439073499, rounding);
    assert_near(m.mean_a, 0.3719951923076923, rounding);
    assert_near(m.mean_b, 0.4963942307692308, rounding);
    assert_near(m.bias, -0.12439903846153846, rounding);
    assert_near(m.error_q01, -1.0, 0.0);
    assert_near(m.error_q99, 0.75, 0.0);
    assert_near(m.max_error, 1.0, 0.0);
    assert_int_equal(m.max_x, 14);
    assert_int_equal(m.max_y, 0);
}

/* Masked pixels, NaN among them, count nowhere, and neither do windows that hold one. */
static void test_mask(void **state)
{
    float a[COUNT], b[COUNT];
    uint8_t mask[COUNT];
    metrics m;

    (void)state;
    fill_pattern(a, b);
    for (int i = 0; i < COUNT; i++)
        mask[i] = i != 0 && i != COUNT - 1;
    a[0] = NAN;
    b[COUNT - 1] = INFINITY;
    assert_int_equal(metrics_count_not_finite(a, mask, WIDTH, HEIGHT), 0);
    assert_int_equal(metrics_count_not_finite(a, NULL, WIDTH, HEIGHT), 1);
    assert_int_equal(metrics_count_not_finite(b, NULL, WIDTH, HEIGHT), 1);
    assert_true(metrics_compare(a, b, mask, WIDTH, HEIGHT, &m));
    assert_int_equal(m.pixels, COUNT - 2);
    assert_near(m.rmse, 0.45463163900510273, rounding);
    assert_near(m.mae, 0.3731796116504854, rounding);
    assert_near(m.bias, -0.12560679611650485, rounding);
    assert_near(m.error_q01, -1.0, 0.0);
    assert_near(m.error_q99, 0.75, 0.0);
    assert_near(m.ssim, 0.27237972984026404, rounding);
    assert_int_equal(m.ssim_windows, 16);
}

static void test_nothing_to_compare(void **state)
{
    float a[4] = {0.0f};
    uint8_t mask[4] = {0};
    metrics m;

    (void)state;
    assert_true(metrics_compare(a, a, mask, 2, 2, &m));
    assert_int_equal(m.pixels, 0);
    assert_true(isnan(m.rmse) && isnan(m.ssim) && isnan(m.max_error));
    assert_true(isnan(m.bias) && isnan(m.error_q01) && isnan(m.error_q99));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_identical), cmocka_unit_test(test_constant_offset),
        cmocka_unit_test(test_one_pixel), cmocka_unit_test(test_ssim_by_hand),
        cmocka_unit_test(test_quantiles), cmocka_unit_test(test_pattern),
        cmocka_unit_test(test_mask),      cmocka_unit_test(test_nothing_to_compare),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
