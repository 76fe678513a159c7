/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "common/heatmap.h"

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.15g is not %.15g within %g", value, expected, tolerance);
}

/* Of linear sRGB: the middle row of the matrix to XYZ in IEC 61966-2-1. */
static double luminance(const float colour[3])
{
    return 0.2126729 * (double)colour[0] + 0.7151522 * (double)colour[1]
           + 0.0721750 * (double)colour[2];
}

/* The inverse of L* = 116 Y^(1/3) - 16. */
static double luminance_of_lightness(double lightness)
{
    return pow((lightness + 16.0) / 116.0, 3.0);
}

/* Matrices to sRGB and back, as they are printed, are inverse to each other within this.
 */
static const double printed_digits = 2e-6;

/* Expected values: CIELAB (97, 0, 0), (35, 3, -38) and (35, 28, 40) by another program,
 * with the inverse of the standard's matrix from sRGB. */
static void test_ends_and_middle(void **state)
{
    const double blue[3] = {0.00647083, 0.08918469, 0.27470854};
    const double orange[3] = {0.23694131, 0.04787221, 0.00494601};
    float colour[3];

    (void)state;
    heatmap_colour(0.0, colour);
    for (int i = 0; i < 3; i++)
        assert_near((double)colour[i], 0.9244030, printed_digits);
    heatmap_colour(-1.0, colour);
    for (int i = 0; i < 3; i++)
        assert_near((double)colour[i], blue[i], printed_digits);
    heatmap_colour(1.0, colour);
    for (int i = 0; i < 3; i++)
        assert_near((double)colour[i], orange[i], printed_digits);
}

static void test_past_the_ends(void **state)
{
    float end[3], past[3];

    (void)state;
    for (int side = -1; side <= 1; side += 2) {
        heatmap_colour(side, end);
        heatmap_colour(side * 1e30, past);
        for (int i = 0; i < 3; i++)
            assert_near((double)past[i], (double)end[i], 0.0);
    }
}

/* Lightness falls by equal steps on both sides alike, from 97 to 35. */
static void test_lightness(void **state)
{
    enum { STEPS = 200 };
    double former = 1.0;

    (void)state;
    for (int i = 0; i <= STEPS; i++) {
        double t = (double)i / STEPS;
        double expected = luminance_of_lightness(97.0 - 62.0 * t);
        float above[3], below[3];

        heatmap_colour(t, above);
        heatmap_colour(-t, below);
        assert_near(luminance(above), expected, printed_digits);
        assert_near(luminance(below), expected, printed_digits);
        assert_true(luminance(above) < former && luminance(below) < former);
        former = fmin(luminance(above), luminance(below));
    }
}

/* What people without red or green receptors see, after Vienot, Brettel and Mollon 1999:
 * red and green become this mixture, blue gets the difference times the last number. */
static void see(const float colour[3], const double eye[3], double out[2])
{
    double red = (double)colour[0], green = (double)colour[1], blue = (double)colour[2];

    out[0] = eye[0] * red + eye[1] * green;
    out[1] = blue + eye[2] * (red - green);
}

static void test_colour_blind(void **state)
{
    const double eyes[2][3] = {{0.11238, 0.88762, 0.00401}, {0.29275, 0.70725, -0.02234}};

    (void)state;
    for (int e = 0; e < 2; e++) {
        for (double t = 0.25; t <= 1.0; t += 0.25) {
            float above[3], below[3];
            double seen_above[2], seen_below[2];

            heatmap_colour(t, above);
            heatmap_colour(-t, below);
            see(above, eyes[e], seen_above);
            see(below, eyes[e], seen_below);
            /* Yellowish on one side, bluish on the other. */
            assert_true(seen_above[1] < seen_above[0] / (1.0 + 0.4 * t));
            assert_true(seen_below[1] > seen_below[0] * (1.0 + 0.4 * t));
        }
    }
}

/* Each error gets the colour of its part of the scale; what is left out gets grey. */
static void test_fill(void **state)
{
    const float a[6] = {0.5f, 0.75f, 0.25f, 0.625f, NAN, 1.0f};
    const float b[6] = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.0f};
    const uint8_t mask[6] = {1, 1, 1, 1, 0, 1};
    const double parts[6] = {0.0, 1.0, -1.0, 0.5, 0.0, 1.0};
    float red[6], green[6], blue[6], expected[3];

    (void)state;
    heatmap_fill(a, b, mask, 6, 0.25, red, green, blue);
    for (int i = 0; i < 6; i++) {
        heatmap_colour(parts[i], expected);
        for (int c = 0; c < 3 && !mask[i]; c++)
            expected[c] = heatmap_background;
        assert_near((double)red[i], (double)expected[0], 0.0);
        assert_near((double)green[i], (double)expected[1], 0.0);
        assert_near((double)blue[i], (double)expected[2], 0.0);
    }
    /* sRGB 0.5 in linear light is ((0.5 + 0.055) / 1.055)^2.4. */
    assert_near((double)heatmap_background, pow(0.555 / 1.055, 2.4), 1e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ends_and_middle),
        cmocka_unit_test(test_past_the_ends),
        cmocka_unit_test(test_lightness),
        cmocka_unit_test(test_colour_blind),
        cmocka_unit_test(test_fill),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
