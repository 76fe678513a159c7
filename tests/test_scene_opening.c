/* SPDX-License-Identifier: MIT */
/*
 * The sky's light through an opening, against integrals over the directions that are open
 * beside a wall.
 */
#include "test_scene_support.h"

#include <string.h>

/* The hemisphere around n, open from the tangent t up to the angle psi. Of V (n.w) / pi:
 * the integral, the mean, and the integrals of P_1 and P_2 of the cosine to the mean. */
typedef struct wall {
    double A, mean[3], first, second;
} wall;

enum { STEPS = 300 };

/* The midpoint of the cell, and its share of the integral. */
static double sample_wall(const double t[3], const double n[3], double psi, int i,
                          double w[3])
{
    const double up = psi * (i % STEPS + 0.5) / STEPS;
    const double along = PI * ((double)(i / STEPS) + 0.5) / STEPS - PI / 2;
    const double side[3] = {t[1] * n[2] - t[2] * n[1], t[2] * n[0] - t[0] * n[2],
                            t[0] * n[1] - t[1] * n[0]};
    for (int k = 0; k < 3; k++)
        w[k] = cos(along) * (cos(up) * t[k] + sin(up) * n[k]) + sin(along) * side[k];
    return dot(n, w) / PI * cos(along) * (psi / STEPS) * (PI / STEPS);
}

static wall integrate(const double t[3], const double n[3], double psi)
{
    wall out = {0};
    double w[3], b[3];
    for (int i = 0; i < STEPS * STEPS; i++) {
        const double share = sample_wall(t, n, psi, i, w);
        out.A += share;
        for (int k = 0; k < 3; k++)
            out.mean[k] += share * w[k];
    }
    for (int k = 0; k < 3; k++)
        b[k] = out.mean[k] / sqrt(dot(out.mean, out.mean));
    for (int i = 0; i < STEPS * STEPS; i++) {
        const double share = sample_wall(t, n, psi, i, w), c = dot(w, b);
        out.first += share * c;
        out.second += share * (1.5 * c * c - 0.5);
    }
    return out;
}

/* An orthonormal pair that is not along the axes. */
static const double tangent[3] = {0.36, 0.48, -0.8}, normal[3] = {0.8, -0.6, 0.0};

static void get_light(const scene_lighting *l, const double direction[3], double A,
                      double rgb[3])
{
    const double length = sqrt(dot(direction, direction));
    const float open[3] = {(float)A, (float)A, (float)A};
    float b[3], out[3];
    for (int k = 0; k < 3; k++)
        b[k] = (float)(direction[k] / length);
    scene_sky_open_irradiance(l, b, open, out);
    for (int c = 0; c < 3; c++)
        rgb[c] = (double)out[c];
}

static void assert_near(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance))
        fail_msg("%.9g is not %.9g, within %.2g", found, expected, tolerance);
}

/* By which the weights of bands 1 and 2 may differ from those beside a wall: as
 * sky_opening.c says. Floats and the sum over the cells add less than ROUNDING. */
#define FIRST    0.0015
#define SECOND   0.0005
#define ROUNDING 1e-4

static double angle_of(int i, int count)
{
    return PI * (i + 1) / count;
}

/* A sky that is linear in the direction needs nothing but A and the mean. */
static void test_linear_sky(void **state)
{
    static const double slope[3] = {0.5, -0.3, 0.6};
    scene_lighting l = scene_lighting_default();
    (void)state;
    l.sky = SCENE_SKY_ENVIRONMENT;
    memset(l.environment, 0, sizeof l.environment);
    for (int c = 0; c < 3; c++) {
        l.environment[0][c] = (float)sqrt(4 * PI);
        /* y, z, x: the c-th colour has the c-th slope. */
        l.environment[c == 0 ? 3 : c][c] = (float)(slope[c] * sqrt(4 * PI / 3));
    }
    for (int i = 0; i < 16; i++) {
        const wall open = integrate(tangent, normal, angle_of(i, 16));
        double rgb[3];
        get_light(&l, open.mean, open.A, rgb);
        for (int c = 0; c < 3; c++)
            assert_near(rgb[c], PI * (open.A + slope[c] * open.mean[c]),
                        PI * open.A * FIRST + ROUNDING);
    }
}

/* So does one that is the same all around the bent normal, of A and two integrals. */
static void test_zonal_sky(void **state)
{
    static const double bands[3][3] = {{1, 0.9, 0}, {1, 0, 0.5}, {1, -0.4, 0.3}};
    static const double z[3] = {0, 0, 1};
    scene_lighting l = scene_lighting_default();
    (void)state;
    l.sky = SCENE_SKY_ENVIRONMENT;
    memset(l.environment, 0, sizeof l.environment);
    for (int c = 0; c < 3; c++) {
        l.environment[0][c] = (float)(bands[c][0] * sqrt(4 * PI));
        l.environment[2][c] = (float)(bands[c][1] * sqrt(4 * PI / 3));
        l.environment[6][c] = (float)(bands[c][2] * sqrt(4 * PI / 5));
    }
    for (int i = 0; i < 16; i++) {
        const wall open = integrate(tangent, normal, angle_of(i, 16));
        double rgb[3];
        get_light(&l, z, open.A, rgb);
        for (int c = 0; c < 3; c++)
            assert_near(rgb[c],
                        PI
                            * (bands[c][0] * open.A + bands[c][1] * open.first
                               + bands[c][2] * open.second),
                        PI * open.A
                                * (FIRST * fabs(bands[c][1]) + SECOND * fabs(bands[c][2]))
                            + ROUNDING);
    }
}

/* Bands 1 and 2 of what lights: of a sky that is the same all around the zenith. That of
 * the painted sky is linear, the zenith's light less the ground's. */
static void get_bands(const scene_lighting *l, double first[3], double second[3])
{
    enum { HEIGHTS = 20000 };
    static const float up[3] = {0, 1, 0}, down[3] = {0, -1, 0};
    float high[3], low[3];
    scene_sky_irradiance(l, up, high);
    scene_sky_irradiance(l, down, low);
    for (int c = 0; c < 3; c++) {
        first[c] = 0.75 / PI * (double)(high[c] - low[c]);
        second[c] = 0.0;
    }
    if (l->sky == SCENE_SKY_PAINTED)
        return;
    memset(first, 0, 3 * sizeof *first);
    for (int i = 0; i < HEIGHTS; i++) {
        const double y = 2.0 * (i + 0.5) / HEIGHTS - 1.0;
        const float d[3] = {(float)sqrt(1.0 - y * y), (float)y, 0.0f};
        float radiance[3];
        scene_sky_radiance(l, d, radiance);
        for (int c = 0; c < 3; c++) {
            first[c] += 1.5 * y * (double)radiance[c] * 2.0 / HEIGHTS;
            second[c] += 2.5 * (1.5 * y * y - 0.5) * (double)radiance[c] * 2.0 / HEIGHTS;
        }
    }
}

/* Of the other skies bands 1 and 2 are narrowed, what is beyond them is not. */
static void test_skies_around_the_zenith(void **state)
{
    scene_lighting l = scene_lighting_default();
    (void)state;
    for (int kind = SCENE_SKY_PAINTED; kind <= SCENE_SKY_GRADIENT; kind++) {
        double first[3], second[3];
        l.sky = (scene_sky)kind;
        get_bands(&l, first, second);
        for (int i = 0; i < 8; i++) {
            const wall open = integrate(tangent, normal, angle_of(i, 8));
            for (int k = 0; k <= 8; k++) {
                const double y = k / 4.0 - 1.0, b[3] = {sqrt(1.0 - y * y), y, 0.0};
                const double one = open.first - 2.0 / 3.0 * open.A,
                             two = open.second - 0.25 * open.A;
                double whole[3], rgb[3];
                get_light(&l, b, 1.0, whole);
                get_light(&l, b, open.A, rgb);
                for (int c = 0; c < 3; c++)
                    assert_near(
                        rgb[c],
                        open.A * whole[c] + PI * one * first[c] * y
                            + PI * two * second[c] * (1.5 * y * y - 0.5),
                        PI * open.A * (FIRST * fabs(first[c]) + SECOND * fabs(second[c]))
                            + ROUNDING);
            }
        }
    }
}

/* If all is open, the light is that of the bent normal's whole hemisphere, bit by bit;
 * if nothing is, there is none. Each colour has its own accessibility. */
static void test_ends(void **state)
{
    static const float open[3] = {1, 1, 1}, some[3] = {1, 0, 0.5f};
    scene_lighting l = scene_lighting_default();
    (void)state;
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            l.environment[i][c] = (float)((7 * i + 3 * c) % 5 - 2);
    for (int kind = SCENE_SKY_PAINTED; kind <= SCENE_SKY_ENVIRONMENT; kind++) {
        l.sky = (scene_sky)kind;
        for (int i = 0; i < 40; i++) {
            const double y = (i + 0.5) / 20 - 1, side = sqrt(1 - y * y);
            const float b[3] = {(float)(side * cos(2.4 * i)), (float)y,
                                (float)(side * sin(2.4 * i))};
            float whole[3], found[3];
            scene_sky_irradiance(&l, b, whole);
            scene_sky_open_irradiance(&l, b, open, found);
            assert_memory_equal(found, whole, sizeof whole);
            scene_sky_open_irradiance(&l, b, some, found);
            assert_memory_equal(found, whole, sizeof *whole);
            assert_true(found[1] == 0.0f);
            assert_true(found[2] >= 0.0f && isfinite(found[2]));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_sky), cmocka_unit_test(test_zonal_sky),
        cmocka_unit_test(test_skies_around_the_zenith), cmocka_unit_test(test_ends)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
