/* SPDX-License-Identifier: MIT */
/* The rotation fit on synthetic pairs, without files or G-buffers. */
#include <math.h>

#include "passes/normal_fit.h"
#include "test_io_support.h"

enum { COUNT = 4000 };

static const double pi = 3.14159265358979323846;
static float from[COUNT][3], to[COUNT][3];
static uint32_t seed;

static double uniform(void)
{
    seed = seed * 1664525u + 1013904223u;
    return ((double)(seed >> 8) + 0.5) / 16777216.0;
}

static void random_direction(double out[3])
{
    const double z = 2.0 * uniform() - 1.0, phi = 2.0 * pi * uniform();
    const double s = sqrt(1.0 - z * z);
    out[0] = s * cos(phi);
    out[1] = s * sin(phi);
    out[2] = z;
}

/* Rodrigues' formula: independent of the quaternions of the code under test. */
static void rotation_about(const double axis[3], double angle, double r[9])
{
    const double c = cos(angle), s = sin(angle);
    const double cross[9] = {0,        -axis[2], axis[1], axis[2], 0,
                             -axis[0], -axis[1], axis[0], 0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r[3 * i + j] =
                (i == j ? c : 0.0) + (1.0 - c) * axis[i] * axis[j] + s * cross[3 * i + j];
}

static void turn(const double r[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = r[3 * i] * v[0] + r[3 * i + 1] * v[1] + r[3 * i + 2] * v[2];
}

/* The angle of the rotation between two rotations, in degrees, from the chord. */
static double difference(const double a[9], const double b[9])
{
    double square = 0.0;
    for (int i = 0; i < 9; i++)
        square += (a[i] - b[i]) * (a[i] - b[i]);
    return 2.0 * asin(fmin(1.0, sqrt(square / 8.0))) * 180.0 / pi;
}

typedef struct recipe {
    double noise;     /* added to each component of `to` */
    double outliers;  /* share of pairs that have nothing to do with each other */
    double flattened; /* all directions times this along z: 0 is a plane */
    double floor;     /* share of pairs that are one and the same direction */
    bool mirrored;
} recipe;

static void make_pairs(const recipe *how, const double r[9])
{
    for (int i = 0; i < COUNT; i++) {
        double v[3], w[3];
        random_direction(v);
        if (uniform() < how->floor) {
            v[0] = v[2] = 0.0;
            v[1] = 1.0;
        }
        v[2] *= how->flattened;
        double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int c = 0; c < 3; c++)
            v[c] /= length;
        turn(r, v, w);
        if (uniform() < how->outliers)
            random_direction(w);
        for (int c = 0; c < 3; c++)
            w[c] += how->noise * (2.0 * uniform() - 1.0);
        length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        if (how->mirrored)
            v[2] = -v[2];
        for (int c = 0; c < 3; c++) {
            from[i][c] = (float)v[c];
            to[i][c] = (float)(w[c] / length);
        }
    }
}

static void fit_and_expect(const recipe *how, double tolerance)
{
    const io__normal_pairs pairs = {(const float(*)[3])from, (const float(*)[3])to,
                                    COUNT};
    for (int round = 0; round < 20; round++) {
        double axis[3], truth[9], found[9];
        seed = 100u + (uint32_t)round;
        random_direction(axis);
        /* Half turns included: there a quaternion's real part vanishes. */
        rotation_about(axis, round == 0 ? pi : 2.0 * pi * uniform(), truth);
        make_pairs(how, truth);
        assert_int_equal(io__normal_fit(&pairs, how->mirrored, found), 0);
        if (!(difference(truth, found) < tolerance))
            fail_msg("round %d: off by %g degrees", round, difference(truth, found));
    }
}

static void test_exact(void **state)
{
    (void)state;
    const recipe how = {.flattened = 1.0};
    fit_and_expect(&how, 1e-4); /* floats: 6e-8 rad each */
}

static void test_noise_and_outliers(void **state)
{
    (void)state;
    /* Noise of 0.1 uniform is 3.3 degrees a component. 2400 good pairs, of which each
     * sees two thirds of a rotation, leave 3.3 / sqrt(1600) = 0.083 degrees an axis, 0.14
     * in all. Three times that, and a fifth for the weights' loss of efficiency. */
    const recipe how = {.noise = 0.1, .outliers = 0.4, .flattened = 1.0};
    fit_and_expect(&how, 0.5);
}

static void test_mirrored(void **state)
{
    (void)state;
    const recipe how = {.flattened = 1.0, .mirrored = true};
    fit_and_expect(&how, 1e-4);
    /* And the unmirrored fit of the same pairs must look bad. */
    const io__normal_pairs pairs = {(const float(*)[3])from, (const float(*)[3])to,
                                    COUNT};
    double found[9];
    assert_int_equal(io__normal_fit(&pairs, false, found), 0);
    assert_true(io__normal_deviation(&pairs, false, found) > 0.3);
}

static void test_plane_of_directions(void **state)
{
    (void)state;
    const recipe how = {.flattened = 0.0};
    fit_and_expect(&how, 1e-4); /* a plane of directions still fixes a rotation */
}

static void test_floor_dominates(void **state)
{
    (void)state;
    /* Most pixels show an exact floor, the rest is noisy: the rest must still fix the
     * turn about the floor's normal. 400 of them, each within 1.2 degrees. */
    const recipe how = {.noise = 0.02, .flattened = 1.0, .floor = 0.9};
    fit_and_expect(&how, 0.2);
}

static void test_all_parallel(void **state)
{
    (void)state;
    const io__normal_pairs pairs = {(const float(*)[3])from, (const float(*)[3])to,
                                    COUNT};
    const recipe how = {.flattened = 1.0, .floor = 1.0};
    double axis[3], truth[9], found[9];
    seed = 5;
    random_direction(axis);
    rotation_about(axis, 1.0, truth);
    make_pairs(&how, truth);
    assert_int_equal(io__normal_fit(&pairs, false, found), 0);
    assert_true(io__normal_deviation(&pairs, false, found) < 1e-5);
}

static void test_deviation(void **state)
{
    (void)state;
    static const float x[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const float y[3][3] = {{1, 0, 0}, {0, 0.8f, 0.6f}, {1, 0, 0}};
    const io__normal_pairs pairs = {x, y, 3}, none = {x, y, 0};
    const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double r[9];
    /* 0, acos(0.8), 90 degrees. */
    assert_true(fabs(io__normal_deviation(&pairs, false, identity) - acos(0.8)) < 1e-6);
    assert_true(io__normal_deviation(&none, false, identity) < 0.0);
    assert_int_equal(io__normal_fit(&none, false, r), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),
        cmocka_unit_test(test_noise_and_outliers),
        cmocka_unit_test(test_mirrored),
        cmocka_unit_test(test_plane_of_directions),
        cmocka_unit_test(test_floor_dominates),
        cmocka_unit_test(test_all_parallel),
        cmocka_unit_test(test_deviation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
