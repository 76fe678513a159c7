/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "common/flip.h"

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.15g is not %.15g within %g", value, expected, tolerance);
}

/*
 * Expected values without a formula beside them: a separate program in another language,
 * written from the paper for colour pictures in double precision (all three channels,
 * whole matrices between the colour spaces, two-dimensional filters). It says 1 of pure
 * green against pure blue, as it must.
 */
static const double rounding = 1e-9; /* about 1e6 times that of a double */

static const double ppd = 0.7 * 3840.0 / 0.7 * 3.14159265358979323846 / 180.0;

static void fill(float *pixels, size_t count, float value)
{
    for (size_t i = 0; i < count; i++)
        pixels[i] = value;
}

enum { WIDTH = 16, HEIGHT = 13, COUNT = WIDTH * HEIGHT };

static void fill_pattern(float a[COUNT], float b[COUNT])
{
    for (int i = 0; i < COUNT; i++) {
        a[i] = (float)(i % 7) / 8.0f;
        b[i] = (float)(i % 5) / 4.0f;
    }
}

static double flip(const float *a, const float *b, int32_t width, int32_t height)
{
    double mean = -1.0;

    assert_true(flip_compare(a, b, NULL, width, height, ppd, NULL, NULL, &mean));
    return mean;
}

static void test_identical(void **state)
{
    float a[COUNT], b[COUNT];

    (void)state;
    fill_pattern(a, b);
    assert_near(flip(a, a, WIDTH, HEIGHT), 0.0, 0.0);
    assert_near(flip(b, b, WIDTH, HEIGHT), 0.0, 0.0);
}

/* No features: the colour part alone. Black and white are 100 apart in L*, 100^0.7 is
 * 25.1189, and c_max = 203.3017^0.7 = 41.2761, so p_c c_max = 16.5104 is passed: 0.95 +
 * 0.05 * (25.1189 - 16.5104) / (41.2761 - 16.5104) = 0.96738. */
static void test_constant_pictures(void **state)
{
    float a[COUNT], b[COUNT];

    (void)state;
    fill(a, COUNT, 0.0f);
    fill(b, COUNT, 1.0f);
    assert_near(flip(a, b, WIDTH, HEIGHT), 0.96738, 1e-5);
    assert_near(flip(a, b, WIDTH, HEIGHT), 0.967379762343006, rounding);
    assert_near(flip(b, a, WIDTH, HEIGHT), 0.967379762343006, rounding);
    fill(a, COUNT, 0.25f);
    fill(b, COUNT, 0.75f);
    assert_near(flip(a, b, WIDTH, HEIGHT), 0.895279167870044, rounding);
    /* A screen shows nothing below 0 and above 1. */
    fill(a, COUNT, -3.0f);
    fill(b, COUNT, 7.5f);
    assert_near(flip(a, b, WIDTH, HEIGHT), 0.967379762343006, rounding);
}

static void test_pattern(void **state)
{
    const double values[][2] = {{67.0, 0.449092442883154},
                                {30.0, 0.636014265606978},
                                {1.0, 0.751625941752674},
                                {500.0, 0.47858318723478}};
    float a[COUNT], b[COUNT];
    double mean;

    (void)state;
    fill_pattern(a, b);
    assert_near(flip(a, b, WIDTH, HEIGHT), 0.449102106181445, rounding);
    assert_near(flip(b, a, WIDTH, HEIGHT), 0.449102106181445, rounding);
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        assert_true(
            flip_compare(a, b, NULL, WIDTH, HEIGHT, values[i][0], NULL, NULL, &mean));
        assert_near(mean, values[i][1], rounding);
    }
}

/* An edge that moves by two pixels, and a bright dot: the feature part. */
static void test_features(void **state)
{
    enum { W = 64, H = 40 };
    float a[W * H], b[W * H];

    (void)state;
    for (int i = 0; i < W * H; i++) {
        a[i] = i % W < 32 ? 0.25f : 0.75f;
        b[i] = i % W < 34 ? 0.25f : 0.75f;
    }
    assert_near(flip(a, b, W, H), 0.0526340064304252, rounding);
    fill(a, W * H, 0.5f);
    fill(b, W * H, 0.5f);
    a[20 * W + 30] = 1.0f;
    assert_near(flip(a, b, W, H), 0.00168798294863839, rounding);
}

/* Larger than all filters, so that rows which have left their reach are given up. */
static void test_tall_picture(void **state)
{
    enum { W = 90, H = 70 };
    float a[W * H], b[W * H];

    (void)state;
    for (int i = 0; i < W * H; i++) {
        a[i] = (float)(i * 37 % 101) / 128.0f;
        b[i] = (i / W + i % W) / 12 % 2 == 0 ? a[i] : fminf(a[i] + 0.0625f, 1.0f);
    }
    assert_near(flip(a, b, W, H), 0.135489358101826, rounding);
}

/* What is left out is white in both and not in the mean, NaN or not. */
static void test_mask(void **state)
{
    float a[COUNT], b[COUNT];
    uint8_t mask[COUNT];
    double mean;

    (void)state;
    fill_pattern(a, b);
    for (int i = 0; i < COUNT; i++)
        mask[i] = i != 0 && i != COUNT - 1 && !(i / WIDTH == 4 && i % WIDTH < 6);
    a[0] = NAN;
    b[4 * WIDTH + 2] = INFINITY;
    assert_true(flip_compare(a, b, mask, WIDTH, HEIGHT, ppd, NULL, NULL, &mean));
    assert_near(mean, 0.449174576581287, rounding);
    for (int i = 0; i < COUNT; i++)
        mask[i] = 0;
    assert_true(flip_compare(a, b, mask, WIDTH, HEIGHT, ppd, NULL, NULL, &mean));
    assert_true(isnan(mean));
}

static void test_one_pixel(void **state)
{
    float black = 0.0f, white = 1.0f;

    (void)state;
    assert_near(flip(&black, &white, 1, 1), 0.967379762343006, rounding);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_identical),    cmocka_unit_test(test_constant_pictures),
        cmocka_unit_test(test_pattern),      cmocka_unit_test(test_features),
        cmocka_unit_test(test_tall_picture), cmocka_unit_test(test_mask),
        cmocka_unit_test(test_one_pixel),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
