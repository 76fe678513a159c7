/* SPDX-License-Identifier: MIT */
/* What the papers say of their estimators' sums and of their noise; the figures are
 * printed. */
#include "fixture.h"
#include "quadrature.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double as_sum_of_groove(const char *method, int32_t offset_px,
                               const crv_options *options)
{
    const int32_t guard = 202, size = 2 * guard + 1;
    crv_camera camera = crv_camera_orthographic(size, size, (float)(size / 200.0));
    camera.cx_px -= (float)offset_px;
    const double depth = 10;
    fixture f = fixture_make(fixture_groove, &depth, &camera, size, size);
    const fixture_run run = {.guard_left = guard,
                             .guard_top = guard,
                             .guard_right = guard,
                             .guard_bottom = guard};
    assert_string_equal(options->method->name, method);
    float *result = fixture_compute(&f, options, &run);
    const double a = (double)result[0];
    free(result);
    fixture_free(&f);
    return a;
}

/* At a part of its intensity alchemy is not clamped at 0, and all of its sum is seen. */
static void alchemy_and_vo_meet_their_own_sums(void **state)
{
    (void)state;
    const double strength = 0.25, tolerance = 0.005;
    for (int k = 1; k <= 10; k++) {
        const int32_t offset_px = (int32_t)lround(0.1 * k * 200 * sqrt(0.5));
        const quadrature_site site = {offset_px / 200.0, 10, 1};
        crv_options options = fixture_options("alchemy");
        options.filter = NULL;
        options.radius = 1;
        options.samples = 4096;
        options.noise_size = 1;
        options.intensity = (float)strength;
        const quadrature_alchemy numbers = {strength, (double)options.alchemy_bias,
                                            (double)options.alchemy_eps};
        const double alchemy = as_sum_of_groove("alchemy", offset_px, &options);
        const double sum = quadrature_of_alchemy(&site, &numbers);
        const double error = (alchemy - sum) / strength;
        options = fixture_options("vo");
        options.filter = NULL;
        options.radius = 1;
        options.samples = 4096;
        options.noise_size = 1;
        const double vo = as_sum_of_groove("vo", offset_px, &options);
        const double vo_error = vo - quadrature_of_vo(&site);
        printf("c %.2f: alchemy %.4f, its sum %.4f, error at full intensity %+.4f; vo "
               "%.4f, error %+.4f\n",
               0.1 * k, alchemy, sum, error, vo, vo_error);
        assert_true(fabs(error) < tolerance);
        assert_true(fabs(vo_error) < tolerance);
    }
}

enum { WIDTH = 120, HEIGHT = 68, PIXELS = WIDTH * HEIGHT };

static fixture spheres(void)
{
    static const double ONE = 1;
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    return fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT);
}

static crv_options few_samples(const char *method, int32_t samples)
{
    crv_options options = fixture_options(method);
    options.filter = NULL;
    options.radius = 1;
    options.samples = samples;
    options.steps = 1;     /* of containment: the paper's estimator, */
    options.thickness = 0; /* and its depth buffer */
    return options;
}

/* All that a method may spend, so that what is left is its bias. */
static crv_options converged(crv_options options)
{
    options.filter = NULL;
    options.directions = 32;
    options.steps = 32;
    options.normal_rays = 4;
    options.samples = 1024;
    options.noise_size = 1;
    return options;
}

/* The standard deviation of every pixel over many draws of the noise. */
enum { DRAWS = 256 };

static void deviations(const fixture *f, crv_options options, double out[PIXELS])
{
    static double sum[PIXELS], squares[PIXELS];
    memset(sum, 0, sizeof sum);
    memset(squares, 0, sizeof squares);
    for (int draw = 0; draw < DRAWS; draw++) {
        options.seed = 1 + draw;
        float *a = fixture_compute(f, &options, NULL);
        for (int i = 0; i < PIXELS; i++) {
            sum[i] += (double)a[i];
            squares[i] += (double)a[i] * (double)a[i];
        }
        free(a);
    }
    for (int i = 0; i < PIXELS; i++) {
        const double mean = sum[i] / DRAWS;
        out[i] = sqrt(fmax(0, squares[i] / DRAWS - mean * mean) * DRAWS / (DRAWS - 1.0));
    }
}

static double root_mean_square(const double *values)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += values[i] * values[i];
    return sqrt(sum / PIXELS);
}

/* 2010, section 4: the volume has a smaller variance than containment tests, since a pipe
 * knows how much of its length is open where a point only knows whether it is. */
static void vao_varies_less_than_containment(void **state)
{
    (void)state;
    static double of_vao[PIXELS], of_containment[PIXELS];
    fixture f = spheres();
    for (int32_t n = 4; n <= 16; n *= 2) {
        crv_options options = few_samples("containment", n);
        options.falloff = CRV_FALLOFF_CUBIC; /* what vao estimates */
        deviations(&f, options, of_containment);
        deviations(&f, few_samples("vao", n), of_vao);
        const double vao = root_mean_square(of_vao);
        const double containment = root_mean_square(of_containment);
        printf("%d samples: standard deviation of vao %.4f, of containment %.4f\n", n,
               vao, containment);
        assert_true(vao < containment);
    }
    fixture_free(&f);
}

/* 2010: each of n independent tests has a variance of A (1 - A) <= 1/4, so that their
 * mean deviates by less than 1 / sqrt(4 n). */
static void containment_deviates_less_than_independent_tests(void **state)
{
    (void)state;
    static double deviation[PIXELS];
    static const crv_falloff FALLOFFS[] = {CRV_FALLOFF_NONE, CRV_FALLOFF_LINEAR};
    fixture f = spheres();
    for (int32_t n = 4; n <= 64; n *= 4) {
        for (int k = 0; k < 2; k++) {
            crv_options options = few_samples("containment", n);
            options.falloff = FALLOFFS[k];
            deviations(&f, options, deviation);
            double largest = 0;
            for (int i = 0; i < PIXELS; i++)
                largest = fmax(largest, deviation[i]);
            const double bound = 1 / sqrt(4.0 * n);
            printf("containment, %d samples, falloff %d: standard deviation %.4f, of the "
                   "worst pixel %.4f; bound %.4f\n",
                   n, (int)FALLOFFS[k], root_mean_square(deviation), largest, bound);
            assert_true(root_mean_square(deviation) < bound);
            /* Measured from 256 draws, a deviation is uncertain by 1 / sqrt(512) = 4.4 %;
             * of 8160 pixels some are off by more than three times that. */
            assert_true(largest < 1.15 * bound);
        }
    }
    fixture_free(&f);
}

static double rms_difference(const float *a, const float *b, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sqrt(sum / count);
}

/* Over eight draws of the noise. */
static double rms_error(const fixture *f, crv_options options, const float *reference)
{
    double sum = 0;
    for (int draw = 0; draw < 8; draw++) {
        options.seed = 1 + draw;
        float *a = fixture_compute(f, &options, NULL);
        const double error = rms_difference(a, reference, PIXELS);
        sum += error * error / 8;
        free(a);
    }
    return sqrt(sum);
}

/* 2010, section 5: dividing by the chords that were sampled cancels most of the error
 * that the random lengths bring in. */
static void the_weighted_normaliser_errs_less(void **state)
{
    (void)state;
    fixture f = spheres();
    const crv_options much = converged(few_samples("vao", 1024));
    float *reference = fixture_compute(&f, &much, NULL);
    for (int32_t n = 4; n <= 32; n *= 2) {
        crv_options options = few_samples("vao", n);
        const double weighted = rms_error(&f, options, reference);
        options.normaliser = CRV_NORMALISER_ANALYTIC;
        const double analytic = rms_error(&f, options, reference);
        printf("vao, %d samples: RMS error weighted %.4f, analytic %.4f\n", n, weighted,
               analytic);
        assert_true(weighted < analytic);
    }
    free(reference);
    fixture_free(&f);
}

/* 2010, Figure 11: half of the sphere is always behind a wall. */
static void ssao_darkens_a_wall_by_half(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    for (int tilt = 0; tilt <= 60; tilt += 30) {
        const double wall[3] = {tilt * 3.14159265358979 / 180, 10, 0.4};
        const crv_camera camera = crv_camera_perspective(SIZE, SIZE, 0.1f);
        fixture f = fixture_make(fixture_plane, wall, &camera, SIZE, SIZE);
        for (int rescale = 0; rescale < 2; rescale++) {
            crv_options options = fixture_options("ssao");
            options.radius = 0.1f;
            options.samples = 64;
            options.rescale = rescale;
            options.filter = NULL;
            float *a = fixture_compute(&f, &options, NULL);
            double sum = 0;
            int count = 0;
            /* Away from the border, beyond which nothing occludes. */
            for (int i = 0; i < SIZE * SIZE; i++) {
                if (i % SIZE > 16 && i % SIZE < 48 && i / SIZE > 16 && i / SIZE < 48) {
                    sum += (double)a[i];
                    count++;
                }
            }
            printf("ssao, wall at %d degrees%s: %.4f\n", tilt,
                   rescale ? ", rescaled" : "", sum / count);
            /* Points come in pairs, one behind the wall; a texel is 1/6 radius high at
             * 60 degrees, and points fall on its wrong side about as often as not. */
            assert_true(fabs(sum / count - (rescale ? 1 : 0.5))
                        < (rescale ? 0.05 : 0.01));
            free(a);
        }
        fixture_free(&f);
    }
}

/* 2010, interleaved sampling: sixteen rotations in a 4x4 tile, and a box of the same size
 * that joins them, for every method there is, at the few samples that it is meant for.
 * The picture is larger here, since the box blurs edges of the occlusion too. */
static void interleaving_lowers_every_error(void **state)
{
    (void)state;
    static const double ONE = 1;
    enum { WIDE = 2 * WIDTH, HIGH = 2 * HEIGHT };
    const crv_camera camera = crv_camera_perspective(WIDE, HIGH, 0.8f);
    fixture f = fixture_make(fixture_spheres, &ONE, &camera, WIDE, HIGH);
    for (int32_t m = 0; m < crv_method_count(); m++) {
        const char *method = crv_method_at(m)->name;
        crv_options options = fixture_options(method);
        assert_int_equal(crv_options_preset(&options, CRV_PRESET_LOW), CRV_OK);
        options.radius = 1;
        options.directions = 4;
        options.steps = 16;
        options.normal_rays = 1;
        options.noise_size = 4;
        options.filter = NULL;
        const crv_options much = converged(options);
        float *reference = fixture_compute(&f, &much, NULL);
        float *raw = fixture_compute(&f, &options, NULL);
        options.filter = crv_filter_find("box4");
        float *joined = fixture_compute(&f, &options, NULL);
        const double raw_error = rms_difference(raw, reference, WIDE * HIGH);
        const double joined_error = rms_difference(joined, reference, WIDE * HIGH);
        printf("%-11s RMS error: one pixel's samples %.4f, interleaved %.4f\n", method,
               raw_error, joined_error);
        assert_true(joined_error < raw_error);
        free(reference);
        free(raw);
        free(joined);
    }
    fixture_free(&f);
}

/* 2011, Figure 5: fewer samples where the radius projects to few pixels. */
static void bands_spare_samples_where_the_radius_is_small(void **state)
{
    (void)state;
    fixture f = spheres();
    crv_options options = few_samples("alchemy", 48);
    /* Plans with bands sample exactly; so must the others, to be compared by bits. */
    const fixture_run exactly = {.exact = 1};
    float *all = fixture_compute(&f, &options, &exactly);
    const crv_options much = converged(options);
    float *reference = fixture_compute(&f, &much, NULL);
    options.bands = 4;
    options.band_px = 24;
    float *banded = fixture_compute(&f, &options, &exactly);
    const double few = rms_error(&f, few_samples("alchemy", 12), reference);
    int32_t near = 0, far = 0, changed = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float radius_px = options.radius * f.camera.fx_px / f.depth[i];
        if (!(f.depth[i] < INFINITY))
            continue;
        if (radius_px >= options.band_px * 0.75f) { /* the last of four bands */
            near++;
            assert_true(banded[i] == all[i]);
        } else {
            far++;
            changed += banded[i] != all[i];
        }
    }
    const double error = rms_difference(banded, reference, PIXELS);
    printf("alchemy, 4 bands: %d pixels near, the same; of %d far ones %d change; RMS "
           "error %.4f, 12 samples everywhere %.4f, all 48 %.4f\n",
           near, far, changed, error, few, rms_difference(all, reference, PIXELS));
    assert_true(near > 200 && far > 200);
    assert_true(changed > far / 10); /* where there is something to see */
    assert_true(error < few);
    free(all);
    free(reference);
    free(banded);
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(alchemy_and_vo_meet_their_own_sums),
        cmocka_unit_test(vao_varies_less_than_containment),
        cmocka_unit_test(containment_deviates_less_than_independent_tests),
        cmocka_unit_test(the_weighted_normaliser_errs_less),
        cmocka_unit_test(ssao_darkens_a_wall_by_half),
        cmocka_unit_test(interleaving_lowers_every_error),
        cmocka_unit_test(bands_spare_samples_where_the_radius_is_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
