/* SPDX-License-Identifier: MIT */
/* Light between surfaces, and angles between directions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "common/metrics_angles.h"
#include "common/multi_bounce.h"

enum { STEPS = 100 };

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g within %g", value, expected, tolerance);
}

/* By hand from the paper's polynomials: p, q, r are 0.6878, -1.75585, 2.0679 for 1/2 and
 * 1.708, -4.1534, 3.4455 for 1. */
static void test_values(void **state)
{
    (void)state;
    assert_near((double)multi_bounce(0.5f, 0.5f), 0.680962, 1e-6);
    assert_near((double)multi_bounce(0.5f, 1.0f), 0.8979, 1e-6);
    assert_near((double)multi_bounce(0.2f, 1.0f), 0.536628, 1e-6);
}

/* Open stays open and closed stays closed, in whatever surroundings; black ones give
 * nothing back, but for the 2e-6 by which the fitted cubic exceeds A at 0.97. */
static void test_ends(void **state)
{
    (void)state;
    for (int i = 0; i <= STEPS; i++) {
        const float share = (float)i / STEPS;
        assert_near((double)multi_bounce(1.0f, share), 1.0, 0.0);
        assert_near((double)multi_bounce(0.0f, share), 0.0, 0.0);
        assert_near((double)multi_bounce(share, 0.0f), (double)share, 2e-6);
        assert_near((double)multi_bounce(share, -1.0f), (double)multi_bounce(share, 0.0f),
                    0.0);
        assert_near((double)multi_bounce(share, 7.0f), (double)multi_bounce(share, 1.0f),
                    0.0);
        assert_near((double)multi_bounce(share, NAN), (double)multi_bounce(share, 0.0f),
                    0.0);
    }
}

/* Brighter surroundings and opener surfaces get more, never less than A, never beyond 1.
 */
static void test_monotonic(void **state)
{
    (void)state;
    for (int i = 0; i <= STEPS; i++)
        for (int k = 0; k <= STEPS; k++) {
            const float a = (float)i / STEPS, rho = (float)k / STEPS;
            const float value = multi_bounce(a, rho);
            assert_true(value >= a && value <= 1.0f);
            assert_true(value >= multi_bounce(fmaxf(a - 0.01f, 0.0f), rho));
            assert_true(value >= multi_bounce(a, fmaxf(rho - 0.01f, 0.0f)));
        }
}

/* If all surroundings have the same A and rho, bounces are a geometric series: A / (1 -
 * rho (1 - A)), a furnace of 1 for rho = 1. The paper's fit is to real scenes, whose
 * deepest corners see less of what is bright: it stays within 0.024 of the series up to
 * rho = 0.6, and below it in a white furnace. */
static void test_series(void **state)
{
    (void)state;
    for (int i = 1; i <= STEPS; i++) {
        const double a = (double)i / STEPS;
        for (int k = 0; k <= 6; k++) {
            const double rho = k / 10.0, series = a / (1.0 - rho * (1.0 - a));
            assert_near((double)multi_bounce((float)a, (float)rho), series, 0.024);
        }
        assert_true(multi_bounce((float)a, 1.0f) <= 1.0f);
    }
}

static void test_parse(void **state)
{
    double rgb[3];
    (void)state;
    assert_true(multi_bounce_parse("0.5", rgb) && multi_bounce_is_albedo(rgb));
    assert_true(rgb[0] >= 0.5 && rgb[1] >= 0.5 && rgb[2] >= 0.5);
    assert_true(multi_bounce_parse("0.1,0.2,1", rgb) && multi_bounce_is_albedo(rgb));
    assert_true(rgb[0] < rgb[1] && rgb[1] < rgb[2]);
    assert_true(multi_bounce_parse("0,2,0", rgb) && !multi_bounce_is_albedo(rgb));
    assert_false(multi_bounce_parse("0.1,0.2", rgb));
    assert_false(multi_bounce_parse("DiffCol", rgb));
    assert_false(multi_bounce_parse("0,0,0,0", rgb));
}

/* Ten directions in a plane, 0 to 90 degrees from the other's; lengths do not matter. */
static void test_angles(void **state)
{
    float a[3][10], b[3][10] = {{0.0f}};
    const float *const pa[3] = {a[0], a[1], a[2]}, *const pb[3] = {b[0], b[1], b[2]};
    uint8_t mask[10];
    metrics_angles m;
    (void)state;
    memset(mask, 1, sizeof mask);
    for (int i = 0; i < 10; i++) {
        const double angle = 10.0 * i * acos(-1.0) / 180.0;
        a[0][i] = (float)(3.0 * cos(angle));
        a[1][i] = 0.0f;
        a[2][i] = (float)(-3.0 * sin(angle));
        b[0][i] = 0.25f;
    }
    assert_true(metrics_compare_angles(pa, pb, NULL, 10, &m));
    assert_int_equal(m.pixels, 10);
    /* Between the fifth and the sixth; at 8.55 of 0 to 9. */
    assert_near(m.median_deg, 45.0, 1e-5);
    assert_near(m.q95_deg, 85.5, 1e-5);
    /* Without the last three: the median is the fourth. One has no direction. */
    mask[7] = mask[8] = mask[9] = 0;
    assert_true(metrics_compare_angles(pa, pb, mask, 10, &m));
    assert_int_equal(m.pixels, 7);
    assert_near(m.median_deg, 30.0, 1e-5);
    b[0][3] = 0.0f;
    assert_true(metrics_compare_angles(pa, pb, mask, 10, &m));
    assert_int_equal(m.pixels, 6);
    assert_near(m.median_deg, 30.0, 1e-5); /* of 0 10 20 40 50 60 */
    memset(mask, 0, sizeof mask);
    assert_true(metrics_compare_angles(pa, pb, mask, 10, &m));
    assert_int_equal(m.pixels, 0);
    assert_true(isnan(m.median_deg) && isnan(m.q95_deg));
}

/* Rounding of a cosine would be 0.02 degrees. */
static void test_small_angles(void **state)
{
    const float a[3] = {1.0f, 1e-6f, 0.0f}, b[3] = {1.0f, 0.0f, 0.0f};
    const float *const pa[3] = {&a[0], &a[1], &a[2]}, *const pb[3] = {&b[0], &b[1],
                                                                      &b[2]};
    metrics_angles m;
    (void)state;
    assert_true(metrics_compare_angles(pa, pb, NULL, 1, &m));
    assert_near(m.median_deg, 1e-6 * 180.0 / acos(-1.0), 1e-10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),      cmocka_unit_test(test_ends),
        cmocka_unit_test(test_monotonic),   cmocka_unit_test(test_series),
        cmocka_unit_test(test_parse),       cmocka_unit_test(test_angles),
        cmocka_unit_test(test_small_angles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
