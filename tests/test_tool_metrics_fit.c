/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "common/metrics_fit.h"

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.15g is not %.15g within %g", value, expected, tolerance);
}

enum { COUNT = 500 };

/* What single precision loses of a value of at most 1, and what it makes of parameters
 * that the values determine well. */
static const double value_rounding = 6e-8, parameter_rounding = 1e-6;

/* Values from 0.1 to 1 in no order. */
static void fill_source(float a[COUNT])
{
    for (int i = 0; i < COUNT; i++)
        a[i] = 0.1f + 0.9f * (float)(i * 211 % COUNT) / (float)(COUNT - 1);
}

static void make(const float a[COUNT], double intensity, double power, float b[COUNT])
{
    for (int i = 0; i < COUNT; i++)
        b[i] = (float)pow(fmax(0.0, 1.0 - intensity * (1.0 - (double)a[i])), power);
}

static void fit(const float a[COUNT], const float b[COUNT], metrics_fit *out)
{
    assert_true(metrics_fit_curves(a, b, NULL, COUNT, 1, out));
    assert_near(out->power.intensity, 1.0, 0.0);
    assert_near(out->intensity.power, 1.0, 0.0);
}

static void test_identical(void **state)
{
    float a[COUNT];
    metrics_fit f;

    (void)state;
    fill_source(a);
    fit(a, a, &f);
    assert_near(f.power.power, 1.0, parameter_rounding);
    assert_near(f.intensity.intensity, 1.0, parameter_rounding);
    assert_near(f.both.intensity, 1.0, parameter_rounding);
    assert_near(f.both.power, 1.0, parameter_rounding);
    assert_near(f.power.rmse, 0.0, value_rounding);
    assert_near(f.intensity.rmse, 0.0, value_rounding);
    assert_near(f.both.rmse, 0.0, value_rounding);
}

static void test_power_is_found(void **state)
{
    const double powers[] = {0.02, 0.3, 1.7, 4.0, 60.0};
    float a[COUNT], b[COUNT];
    metrics_fit f;

    (void)state;
    fill_source(a);
    for (size_t i = 0; i < sizeof powers / sizeof powers[0]; i++) {
        make(a, 1.0, powers[i], b);
        fit(a, b, &f);
        assert_near(f.power.power / powers[i], 1.0, 10.0 * parameter_rounding);
        assert_near(f.power.rmse, 0.0, value_rounding);
        assert_near(f.both.rmse, 0.0, value_rounding);
    }
}

/* Some below 1, and some that make pixels black, which then tell nothing but that. */
static void test_intensity_is_found(void **state)
{
    const double intensities[] = {0.05, 0.6, 1.1, 2.5, 30.0};
    float a[COUNT], b[COUNT];
    metrics_fit f;

    (void)state;
    fill_source(a);
    for (size_t i = 0; i < sizeof intensities / sizeof intensities[0]; i++) {
        make(a, intensities[i], 1.0, b);
        fit(a, b, &f);
        assert_near(f.intensity.intensity / intensities[i], 1.0, parameter_rounding);
        assert_near(f.intensity.rmse, 0.0, value_rounding);
        assert_near(f.both.rmse, 0.0, value_rounding);
    }
}

static void test_both_are_found(void **state)
{
    const double curves[][2] = {
        {0.5, 3.0}, {2.0, 0.4}, {1.3, 1.4}, {6.0, 2.0}, {0.8, 0.1}};
    float a[COUNT], b[COUNT];
    metrics_fit f;

    (void)state;
    fill_source(a);
    for (size_t i = 0; i < sizeof curves / sizeof curves[0]; i++) {
        make(a, curves[i][0], curves[i][1], b);
        fit(a, b, &f);
        /* The two make up for each other in part: less well determined than one. */
        assert_near(f.both.intensity / curves[i][0], 1.0, 1e-4);
        assert_near(f.both.power / curves[i][1], 1.0, 1e-4);
        assert_near(f.both.rmse, 0.0, value_rounding);
        assert_true(f.both.rmse <= f.power.rmse && f.both.rmse <= f.intensity.rmse);
    }
}

/* Expected values: a separate program in another language, nested grids in double
 * precision over the same ranges, zoomed in until they no longer move. */
static void test_nothing_fits(void **state)
{
    /* Where those grids stop, and the square of that at a minimum. */
    const double parameter = 1e-5, minimum = 1e-9;
    float a[60], b[60];
    metrics_fit f;

    (void)state;
    for (int j = 0; j < 60; j++) {
        double open = (5 + j * 37 % 59) / 64.0;
        double curve = pow(fmin(fmax(1.0 - 1.3 * (1.0 - open), 0.0), 1.0), 1.4);
        a[j] = (float)open;
        b[j] = (float)fmax(nearbyint(curve * 64.0 + (j * 11 % 7 - 3)) / 64.0, 0.0);
    }
    assert_true(metrics_fit_curves(a, b, NULL, 10, 6, &f));
    assert_near(f.power.power, 2.07685740983915, parameter);
    assert_near(f.power.rmse, 0.0393245520476921, minimum);
    assert_near(f.intensity.intensity, 1.54666050745296, parameter);
    assert_near(f.intensity.rmse, 0.0406643861329087, minimum);
    assert_near(f.both.intensity, 1.31435539021307, parameter);
    assert_near(f.both.power, 1.37749664801304, parameter);
    assert_near(f.both.rmse, 0.030032097450803, minimum);
}

/* Of unrelated pictures; the best of both is at the end of the range, which is kept. */
static void test_range_is_kept(void **state)
{
    float a[208], b[208];
    metrics_fit f;

    (void)state;
    for (int i = 0; i < 208; i++) {
        a[i] = (float)(i % 7) / 8.0f;
        b[i] = (float)(i % 5) / 4.0f;
    }
    assert_true(metrics_fit_curves(a, b, NULL, 16, 13, &f));
    assert_near(f.power.power, 0.710646428857635, 1e-5);
    assert_near(f.power.rmse, 0.444851901005374, 1e-9);
    assert_near(f.intensity.intensity, 0.690143157580826, 1e-5);
    assert_near(f.intensity.rmse, 0.401089596901015, 1e-9);
    assert_near(f.both.power, METRICS_POWER_MAX, 1e-3);
    assert_near(f.both.intensity, 0.0109386903259984, 1e-5);
    assert_near(f.both.rmse, 0.383338056754326, 1e-7);
}

/* White stays white under every power and intensity. */
static void test_constant_pictures(void **state)
{
    float a[COUNT], b[COUNT];
    metrics_fit f;

    (void)state;
    for (int i = 0; i < COUNT; i++) {
        a[i] = 1.0f;
        b[i] = 0.25f;
    }
    fit(a, b, &f);
    assert_near(f.power.power, 1.0, 0.0);
    assert_near(f.intensity.intensity, 1.0, 0.0);
    assert_near(f.both.intensity, 1.0, 0.0);
    assert_near(f.both.power, 1.0, 0.0);
    assert_near(f.both.rmse, 0.75, 1e-12);
    /* 0.5 becomes 0.25 as a square, and by 1 - 1.5 * 0.5. */
    for (int i = 0; i < COUNT; i++)
        a[i] = 0.5f;
    fit(a, b, &f);
    assert_near(f.power.power, 2.0, parameter_rounding);
    assert_near(f.intensity.intensity, 1.5, parameter_rounding);
    assert_near(f.both.rmse, 0.0, value_rounding);
}

/* Values outside [0, 1] are no reason to fail: 1 - 0.5 (1 - A), never black here. */
static void test_wide_values(void **state)
{
    float a[COUNT], b[COUNT];
    metrics_fit f;

    (void)state;
    for (int i = 0; i < COUNT; i++) {
        a[i] = -0.5f + 0.005f * (float)i;
        b[i] = 0.5f + 0.5f * a[i];
    }
    fit(a, b, &f);
    assert_near(f.intensity.intensity, 0.5, parameter_rounding);
    assert_near(f.intensity.rmse, 0.0, value_rounding);
    assert_true(isfinite(f.power.rmse) && isfinite(f.power.power));
    assert_near(f.both.rmse, 0.0, value_rounding);
}

static void test_mask(void **state)
{
    float a[COUNT], b[COUNT];
    uint8_t mask[COUNT];
    metrics_fit f;

    (void)state;
    fill_source(a);
    make(a, 1.0, 2.0, b);
    for (int i = 0; i < COUNT; i++)
        mask[i] = i % 3 != 0;
    a[0] = NAN;
    b[3] = INFINITY;
    b[6] = 40.0f;
    assert_true(metrics_fit_curves(a, b, mask, COUNT, 1, &f));
    assert_near(f.power.power, 2.0, parameter_rounding);
    assert_near(f.power.rmse, 0.0, value_rounding);
    for (int i = 0; i < COUNT; i++)
        mask[i] = 0;
    assert_true(metrics_fit_curves(a, b, mask, COUNT, 1, &f));
    assert_true(isnan(f.power.rmse) && isnan(f.intensity.rmse) && isnan(f.both.rmse));
    assert_true(isnan(f.power.power) && isnan(f.intensity.intensity));
}

/* More pixels than the search looks at one by one. */
static void test_large_picture(void **state)
{
    enum { WIDTH = 200, HEIGHT = 100 };
    float *a = malloc(WIDTH * HEIGHT * sizeof *a),
          *b = malloc(WIDTH * HEIGHT * sizeof *b);
    metrics_fit f;

    (void)state;
    assert_non_null(a);
    assert_non_null(b);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        a[i] = (float)(i * 7919 % 20011) / 20011.0f;
        b[i] = (float)pow(fmax(0.0, 1.0 - 1.6 * (1.0 - (double)a[i])), 0.7);
    }
    assert_true(metrics_fit_curves(a, b, NULL, WIDTH, HEIGHT, &f));
    /* A power below 1 is steep at black, where single precision is coarse. */
    assert_near(f.both.intensity, 1.6, 1e-5);
    assert_near(f.both.power, 0.7, 1e-5);
    assert_near(f.both.rmse, 0.0, 1e-6);
    free(a);
    free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_identical),
        cmocka_unit_test(test_power_is_found),
        cmocka_unit_test(test_intensity_is_found),
        cmocka_unit_test(test_both_are_found),
        cmocka_unit_test(test_nothing_fits),
        cmocka_unit_test(test_range_is_kept),
        cmocka_unit_test(test_constant_pictures),
        cmocka_unit_test(test_wide_values),
        cmocka_unit_test(test_mask),
        cmocka_unit_test(test_large_picture),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
