/* SPDX-License-Identifier: MIT */
/*
 * Radiance and irradiance of skies, against integrals in closed form.
 */
#include "test_scene_support.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Directions all over the sphere, axes and diagonals included. */
enum { DIRECTIONS = 60 };
static void get_direction(int i, double d[3])
{
    static const double special[10][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0},
                                          {0, 0, 1}, {0, 0, -1}, {1, 1, 0}, {0, 1, 1},
                                          {1, 0, 1}, {-1, 1, -1}};
    if (i < 10) {
        memcpy(d, special[i], sizeof special[i]);
    } else {
        d[0] = cos(2.4 * i);
        d[2] = sin(2.4 * i);
        d[1] = 3.0 * (2.0 * (i - 9.5) / (DIRECTIONS - 10) - 1.0);
    }
    const double length = sqrt(dot(d, d));
    for (int k = 0; k < 3; k++)
        d[k] /= length;
}

typedef void (*sky_function)(const scene_lighting *l, const float d[3], float rgb[3]);

static void evaluate(sky_function f, const scene_lighting *l, const double d[3],
                     double out[3])
{
    const float direction[3] = {(float)d[0], (float)d[1], (float)d[2]};
    float rgb[3];
    f(l, direction, rgb);
    for (int c = 0; c < 3; c++)
        out[c] = (double)rgb[c];
}

static void assert_near(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance))
        fail_msg("%.9g is not %.9g", found, expected);
}

/* Floats hold 7 digits. */
#define ROUNDING 2e-6

/* All kinds can be skies of one radiance: whatever faces them gets pi times that. */
static void test_even_sky(void **state)
{
    static const float even[3] = {0.25f, 1.0f, 3.0f};
    static const int32_t sizes[][2] = {{1, 1}, {7, 3}, {64, 32}, {2, 129}};
    (void)state;
    for (int kind = 0; kind < 2 + 4; kind++) {
        scene_lighting l = scene_lighting_default();
        float *picture = NULL;
        l.sky = kind == 0 ? SCENE_SKY_CONSTANT : SCENE_SKY_GRADIENT;
        memcpy(l.constant, even, sizeof even);
        memcpy(l.zenith, even, sizeof even);
        memcpy(l.horizon, even, sizeof even);
        memcpy(l.ground, even, sizeof even);
        if (kind >= 2) {
            const int32_t *size = sizes[kind - 2];
            picture = malloc((size_t)size[0] * (size_t)size[1] * sizeof even);
            assert_non_null(picture);
            for (int32_t i = 0; i < size[0] * size[1]; i++)
                memcpy(picture + 3 * i, even, sizeof even);
            assert_int_equal(
                scene_sky_from_equirect(picture, size[0], size[1], "even", &l, NULL), 0);
            assert_int_equal(l.sky, SCENE_SKY_ENVIRONMENT);
        }
        for (int i = 0; i < 2 * DIRECTIONS; i++) {
            double d[3], radiance[3], irradiance[3];
            get_direction(i % DIRECTIONS, d);
            /* The second time the harmonics alone. */
            if (i >= DIRECTIONS)
                l.picture = NULL;
            evaluate(scene_sky_radiance, &l, d, radiance);
            evaluate(scene_sky_irradiance, &l, d, irradiance);
            for (int c = 0; c < 3; c++) {
                assert_near(radiance[c], (double)even[c], ROUNDING * (double)even[c]);
                assert_near(irradiance[c], PI * (double)even[c],
                            PI * ROUNDING * (double)even[c]);
            }
        }
        free(picture);
    }
}

/* Up, the zenith's share is that of the integral of 2 h sqrt(h), 4/5. Sideways the half
 * above the horizon weighs heights by sqrt(1 - h^2): a beta function. */
static void test_gradient(void **state)
{
    scene_lighting l = scene_lighting_default();
    const double beta = 0.5 * tgamma(0.75) * tgamma(1.5) / tgamma(2.25) / (PI / 4.0);
    const struct {
        double direction[3], zenith, horizon, ground;
    } cases[] = {{{0, 1, 0}, 0.8, 0.2, 0},
                 {{0, -1, 0}, 0, 0, 1},
                 {{1, 0, 0}, 0.5 * beta, 0.5 * (1.0 - beta), 0.5},
                 {{0, 0, -1}, 0.5 * beta, 0.5 * (1.0 - beta), 0.5}};
    double rgb[3];
    (void)state;
    l.sky = SCENE_SKY_GRADIENT;
    for (int c = 0; c < 3; c++) {
        l.zenith[c] = c == 0 ? 3.0f : 0.0f;
        l.horizon[c] = c == 1 ? 5.0f : 0.0f;
        l.ground[c] = c == 2 ? 7.0f : 0.0f;
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        evaluate(scene_sky_irradiance, &l, cases[i].direction, rgb);
        /* The integral is a sum over 256 heights. */
        assert_near(rgb[0], 3 * PI * cases[i].zenith, 1e-4);
        assert_near(rgb[1], 5 * PI * cases[i].horizon, 1e-4);
        assert_near(rgb[2], 7 * PI * cases[i].ground, 1e-4);
    }
    evaluate(scene_sky_radiance, &l, (const double[3]){sqrt(1.0 - 0.0625), 0.25, 0}, rgb);
    assert_near(rgb[0], 1.5, 1e-5); /* sqrt(1/4) of the zenith, half of the horizon */
    assert_near(rgb[1], 2.5, 1e-5);
    evaluate(scene_sky_radiance, &l, (const double[3]){0, -1, 0}, rgb);
    assert_near(rgb[2], 7.0, ROUNDING);
}

/* The light that the pictures always had: half of each between sky and ground. */
static void test_painted(void **state)
{
    const scene_lighting l = scene_lighting_default();
    double rgb[3];
    (void)state;
    assert_int_equal(l.sky, SCENE_SKY_PAINTED);
    evaluate(scene_sky_irradiance, &l, (const double[3]){0, 1, 0}, rgb);
    assert_near(rgb[2], PI * 0.46, 1e-5);
    evaluate(scene_sky_irradiance, &l, (const double[3]){0, -1, 0}, rgb);
    assert_near(rgb[0], PI * 0.17, 1e-5);
    evaluate(scene_sky_irradiance, &l, (const double[3]){1, 0, 0}, rgb);
    assert_near(rgb[1], PI * 0.5 * (0.36 + 0.15), 1e-5);
}

enum { SKY_WIDTH = 256, SKY_HEIGHT = 128, SKY_PIXELS = SKY_WIDTH * SKY_HEIGHT };

/* The direction of a point of the picture, from the convention's words: azimuth 0, in
 * the middle, is -Z, a quarter to the right of it is +X, the upper edge is +Y. */
static void direction_of_pixel(int x, int y, int width, int height, double d[3])
{
    double azimuth = 2.0 * PI * ((x + 0.5) / width - 0.5);
    double elevation = PI * (0.5 - (y + 0.5) / height);
    d[0] = cos(elevation) * sin(azimuth);
    d[1] = sin(elevation);
    d[2] = -cos(elevation) * cos(azimuth);
}

/* A sky of radiance max(0, d.a) in red. Its irradiance is known, as is the part of it
 * that harmonics up to order 2 hold: band l has A_l^2 (2 l + 1) / (4 pi) P_l(cos). */
static void test_cosine_lobe(void **state)
{
    float *picture = calloc(3 * SKY_PIXELS, sizeof *picture);
    (void)state;
    assert_non_null(picture);
    for (int lobe = 0; lobe < 12; lobe++) {
        scene_lighting l = scene_lighting_default();
        double axis[3];
        get_direction(lobe, axis);
        for (int i = 0; i < SKY_PIXELS; i++) {
            double d[3];
            direction_of_pixel(i % SKY_WIDTH, i / SKY_WIDTH, SKY_WIDTH, SKY_HEIGHT, d);
            picture[3 * i] = (float)fmax(0.0, dot(d, axis));
        }
        assert_int_equal(
            scene_sky_from_equirect(picture, SKY_WIDTH, SKY_HEIGHT, "lobe", &l, NULL), 0);
        for (int i = 0; i < DIRECTIONS; i++) {
            double n[3], rgb[3];
            get_direction(i, n);
            const double c = fmin(fmax(dot(n, axis), -1.0), 1.0);
            const double angle = acos(c);
            const double bands = PI / 4 + PI / 3 * c + 5 * PI / 128 * (3 * c * c - 1);
            evaluate(scene_sky_irradiance, &l, n, rgb);
            /* Pixels 1.4 degrees wide stand for their centres. */
            assert_near(rgb[0], fmax(bands, 0.0), 2e-3);
            /* What order 2 leaves out: band 4 is (pi / 24)^2 9 / (4 pi) = 0.012, all
             * others together less than that. */
            assert_near(rgb[0], 2.0 / 3.0 * ((PI - angle) * c + sin(angle)), 0.025);
            assert_true(rgb[0] >= 0.0 && rgb[1] == 0.0 && rgb[2] == 0.0);
        }
    }
    free(picture);
}

static void fill_with_noise(float *picture, int pixels)
{
    uint32_t random = 5;
    for (int i = 0; i < 3 * pixels; i++)
        picture[i] = (float)((random = random * 1664525u + 1013904223u) >> 8) * 0x1p-22f;
}

/* Moved a quarter of its width to the right, a picture has in +X what was in -Z, and in
 * +Z what was in +X. */
static void test_quarter_turn(void **state)
{
    enum { W = 24, H = 11 };
    float picture[3 * W * H], turned[3 * W * H];
    scene_lighting a = scene_lighting_default(), b = a;
    (void)state;
    fill_with_noise(picture, W * H);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            memcpy(turned + 3 * (y * W + (x + W / 4) % W), picture + 3 * (y * W + x),
                   3 * sizeof *picture);
    assert_int_equal(scene_sky_from_equirect(picture, W, H, "a", &a, NULL), 0);
    assert_int_equal(scene_sky_from_equirect(turned, W, H, "b", &b, NULL), 0);
    for (int i = 0; i < 3 * DIRECTIONS; i++) {
        double d[3], e[3], before[3], after[3];
        sky_function f = i < DIRECTIONS ? scene_sky_irradiance : scene_sky_radiance;
        get_direction(i % DIRECTIONS, d);
        if (i >= 2 * DIRECTIONS)
            a.picture = b.picture = NULL;
        e[0] = -d[2];
        e[1] = d[1];
        e[2] = d[0];
        /* A picture has no value in the poles themselves. */
        if (f == scene_sky_radiance && a.picture && fabs(d[1]) > 0.999)
            continue;
        evaluate(f, &a, d, before);
        evaluate(f, &b, e, after);
        /* The harmonics are stored as floats; between pixels a float's rounding of the
         * direction is much of a noise. */
        for (int c = 0; c < 3; c++)
            assert_near(after[c], before[c], 1e-4);
    }
}

/* The background shows every pixel where it is. */
static void test_picture_is_shown(void **state)
{
    enum { W = 14, H = 9 };
    float picture[3 * W * H];
    scene_lighting l = scene_lighting_default();
    (void)state;
    fill_with_noise(picture, W * H);
    assert_int_equal(scene_sky_from_equirect(picture, W, H, "noise", &l, NULL), 0);
    assert_ptr_equal(l.picture, picture);
    for (int i = 0; i < W * H; i++) {
        double d[3], rgb[3];
        direction_of_pixel(i % W, i / W, W, H, d);
        evaluate(scene_sky_radiance, &l, d, rgb);
        for (int c = 0; c < 3; c++)
            assert_near(rgb[c], (double)picture[3 * i + c], 1e-4);
    }
}

static void test_bad_pictures(void **state)
{
    float picture[3 * 4 * 2];
    const scene_lighting before = scene_lighting_default();
    scene_lighting l = before;
    messages m;
    crv_logger log = catch_messages(&m);
    double rgb[3];
    (void)state;
    assert_int_equal(scene_sky_from_equirect(picture, 0, 2, "sky.exr", &l, &log), -1);
    assert_error_line(&m, "sky.exr");
    assert_int_equal(scene_sky_from_equirect(picture, 4, -1, "sky.exr", &l, NULL), -1);
    assert_int_equal(scene_sky_from_equirect(NULL, 4, 2, "sky.exr", &l, NULL), -1);
    assert_int_equal(
        scene_sky_from_equirect(picture, CRV_MAX_SIZE + 1, 1, "sky.exr", &l, NULL), -1);
    assert_memory_equal(&l, &before, sizeof l);
    for (int i = 0; i < 3 * 4 * 2; i++)
        picture[i] = 1.0f;
    picture[0] = NAN;
    picture[4] = -1.0f;
    picture[8] = INFINITY;
    picture[9] = FLT_MAX;
    log = catch_messages(&m);
    assert_int_equal(scene_sky_from_equirect(picture, 4, 2, "sky.exr", &l, &log), 0);
    assert_int_equal(m.errors, 0);
    assert_int_equal(m.warnings, 1);
    assert_non_null(strstr(m.warning, "sky.exr: 3 values"));
    for (int i = 0; i < DIRECTIONS; i++) {
        double d[3];
        get_direction(i, d);
        for (int k = 0; k < 2; k++) {
            evaluate(k ? scene_sky_radiance : scene_sky_irradiance, &l, d, rgb);
            for (int c = 0; c < 3; c++)
                assert_true(isfinite(rgb[c]) && rgb[c] >= 0.0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_even_sky),     cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_painted),      cmocka_unit_test(test_cosine_lobe),
        cmocka_unit_test(test_quarter_turn), cmocka_unit_test(test_picture_is_shown),
        cmocka_unit_test(test_bad_pictures)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
