/* SPDX-License-Identifier: MIT */
/*
 * What every method must hold, whatever its estimate: loops over the registry, so that a
 * new method is covered by being listed.
 */
#include "fixture.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const double ONE = 1;

static fixture spheres(int32_t width, int32_t height)
{
    crv_camera camera = crv_camera_perspective(width, height, 0.8f);
    return fixture_make(fixture_spheres, &ONE, &camera, width, height);
}

/* The share of pixels that differ by more than the tolerance. */
static double share_beyond(const float *a, const float *b, int32_t count,
                           double tolerance)
{
    int32_t beyond = 0;
    for (int32_t i = 0; i < count; i++)
        beyond += !(fabs((double)a[i] - (double)b[i]) <= tolerance);
    return (double)beyond / count;
}

static double mean(const float *a, int32_t count)
{
    double sum = 0;
    for (int32_t i = 0; i < count; i++)
        sum += (double)a[i];
    return sum / count;
}

/* A parallel-for that runs tasks last to first: an order that OpenMP never takes. */
static void run_backwards(void *user, uint32_t count, void (*task)(void *, uint32_t),
                          void *data)
{
    (void)user;
    for (uint32_t i = count; i-- > 0;)
        task(data, i);
}

/* On a device they are the driver's: the same picture again. */
static void threads_do_not_matter(const char *method)
{
    const int count = fixture_on_vulkan() ? 1 : 3;
    fixture f = spheres(301, 173);
    for (int32_t k = -1; k < crv_filter_count(); k++) {
        crv_options options = fixture_options(method);
        options.filter = crv_filter_at(k);
        float *one = fixture_compute(&f, &options, &(fixture_run){.threads = 1});
        const fixture_run others[] = {
            {.threads = 2}, {.threads = 7}, {.parallel = {run_backwards, NULL}}};
        for (int i = 0; i < count; i++) {
            float *other = fixture_compute(&f, &options, &others[i]);
            assert_memory_equal(one, other,
                                (size_t)f.width * (size_t)f.height * sizeof(float));
            free(other);
        }
        free(one);
    }
    fixture_free(&f);
}

static void scale_does_not_matter(const char *method)
{
    const int32_t width = 160, height = 90;
    static const double SCALES[] = {1e-3, 1e3};
    fixture f = spheres(width, height);
    crv_options options = fixture_options(method);
    options.radius = 0.5f;
    float *one = fixture_compute(&f, &options, NULL);
    for (int i = 0; i < 2; i++) {
        fixture scaled =
            fixture_make(fixture_spheres, &SCALES[i], &f.camera, width, height);
        options.radius = (float)(0.5 * SCALES[i]);
        float *other = fixture_compute(&scaled, &options, NULL);
        /* 1e-3 is no power of two, so depth rounds differently: a few samples at the very
         * edge of the radius, and pixels at silhouettes whose nearer neighbour is a tie,
         * change. */
        assert_true(share_beyond(one, other, width * height, 1e-3) < 0.002);
        free(other);
        fixture_free(&scaled);
    }
    free(one);
    fixture_free(&f);
}

/* Turns a square picture by a quarter, counter-clockwise. */
static void rotate(const float *in, float *out, int32_t size, int32_t channels)
{
    for (int32_t y = 0; y < size; y++) {
        for (int32_t x = 0; x < size; x++)
            memcpy(out + (ptrdiff_t)((size - 1 - x) * size + y) * channels,
                   in + (ptrdiff_t)(y * size + x) * channels,
                   (size_t)channels * sizeof(float));
    }
}

static int reads(const char *key, const crv_method *method)
{
    return crv_option_applies(crv_option_find(key), method, NULL);
}

static void a_quarter_turn_does_not_matter(const char *method)
{
    enum { SIZE = 128 };
    fixture f = spheres(SIZE, SIZE), turned = spheres(SIZE, SIZE);
    rotate(f.depth, turned.depth, SIZE, 1);
    rotate(f.normals, turned.normals, SIZE, 3);
    for (int i = 0; i < SIZE * SIZE; i++) {
        float *n = turned.normals + 3 * i, nx = n[0];
        n[0] = -n[1];
        n[1] = nx;
    }
    crv_options options = fixture_options(method);
    options.filter = NULL;
    options.radius = 0.5f;
    /* One noise texel and a multiple of four directions turn into themselves; what is
     * left is samples on the border of two texels, rounded to either. Patterns of points,
     * rays whose height and slices whose jitter change with the direction have no such
     * symmetry: two draws
     * of 256 differ by their sampling error, at most 1/sqrt(4 * 256) = 0.03 each (2010).
     */
    options.noise_size = 1;
    options.samples = 256;
    options.directions = 32;
    options.normal_rays = 8;
    options.steps = 16;
    const int is_random = reads("samples", options.method)
                          || reads("normal_rays", options.method)
                          || reads("border", options.method);
    static float expected[SIZE * SIZE];
    float *upright = fixture_compute(&f, &options, NULL);
    float *other = fixture_compute(&turned, &options, NULL);
    rotate(upright, expected, SIZE, 1);
    const double beyond =
        share_beyond(expected, other, SIZE * SIZE, is_random ? 0.1 : 1e-3);
    const double shift = mean(expected, SIZE * SIZE) - mean(other, SIZE * SIZE);
    if (!(beyond < (is_random ? 0.01 : 0.005) && fabs(shift) < 0.002))
        fail_msg("%s: %g of the pixels differ, the mean by %g", method, beyond, shift);
    free(upright);
    free(other);
    fixture_free(&f);
    fixture_free(&turned);
}

/* Little work, where much is not needed. */
static crv_options few_samples(const char *method)
{
    crv_options options = fixture_options(method);
    options.directions = 4;
    options.steps = 4;
    options.normal_rays = 1;
    options.samples = 4;
    return options;
}

static void resolution_does_not_matter(const char *method)
{
    static const int32_t WIDTHS[] = {320, 640, 1280, 1920};
    /* An emulated GPU takes a minute for the larger ones. */
    const int count = fixture_on_vulkan() ? 2 : 4;
    double means[4];
    for (int i = 0; i < count; i++) {
        fixture f = spheres(WIDTHS[i], WIDTHS[i] * 9 / 16);
        crv_options options = few_samples(method);
        options.radius = 2;
        options.falloff = CRV_FALLOFF_NONE; /* where the method has it: more to see */
        float *a = fixture_compute(&f, &options, NULL);
        means[i] = mean(a, f.width * f.height);
        printf("%s: mean accessibility %.4f at %d x %d\n", method, means[i], f.width,
               f.height);
        assert_true(fabs(means[i] - means[0]) < 0.01);
        free(a);
        fixture_free(&f);
    }
    assert_true(means[0] < 0.995); /* there is something to see */
}

/* The top left part of a fixture. */
static fixture cut(const fixture *f, int32_t width, int32_t height)
{
    fixture part = {.width = width, .height = height, .camera = f->camera};
    part.depth = malloc((size_t)(width * height) * sizeof(float));
    part.normals = malloc((size_t)(width * height) * 3 * sizeof(float));
    for (int32_t y = 0; y < height; y++) {
        memcpy(part.depth + y * width, f->depth + y * f->width,
               (size_t)width * sizeof(float));
        memcpy(part.normals + y * width * 3, f->normals + y * f->width * 3,
               (size_t)width * 3 * sizeof(float));
    }
    return part;
}

/* Lengths at which something new begins: little, or a block of 16 lanes. */
static bool is_edge(int32_t length)
{
    return length <= 5 || length % 16 <= 1;
}

/* Up to four blocks of 16 lanes, or two workgroups of 16 pixels: every width and every
 * height, with the edges of the other. */
static void every_size_runs(const char *method)
{
    const int32_t largest = fixture_on_vulkan() ? 35 : 67;
    fixture whole = spheres(largest, largest);
    crv_options options = few_samples(method);
    for (int32_t i = 0; i < largest * largest; i++) {
        const int32_t width = i % largest + 1, height = i / largest + 1;
        if (!is_edge(width) && !is_edge(height))
            continue;
        fixture f = cut(&whole, width, height);
        const fixture_run run = {.threads = 1, .without_normals = i & 1};
        float *a = fixture_compute(&f, &options, &run);
        for (int32_t k = 0; k < f.width * f.height; k++)
            assert_true(a[k] >= 0 && a[k] <= 1);
        free(a);
        fixture_free(&f);
    }
    fixture_free(&whole);
}

/* A piece of a larger picture, computed alone with a guard band, equals the piece cut
 * out. */
static void a_crop_equals_the_cut(const char *method, const crv_filter *filter)
{
    enum { WIDTH = 320, HEIGHT = 200, X = 97, Y = 62, W = 130, H = 75, GUARD = 60 };
    fixture whole = spheres(WIDTH, HEIGHT);
    crv_camera camera = crv_camera_crop(&whole.camera, X - GUARD, Y - GUARD);
    fixture piece =
        fixture_make(fixture_spheres, &ONE, &camera, W + 2 * GUARD, H + 2 * GUARD);
    crv_options options = fixture_options(method);
    options.filter = filter;
    /* Projects to at most 50 px at the nearest depth of the scene: with the filter's
     * reach the guard band holds every texel that is read. */
    options.radius = 0.4f;
    const fixture_run run = {.guard_left = GUARD,
                             .guard_top = GUARD,
                             .guard_right = GUARD,
                             .guard_bottom = GUARD,
                             .origin_x = X,
                             .origin_y = Y};
    float *all = fixture_compute(&whole, &options, NULL);
    float *part = fixture_compute(&piece, &options, &run);
    static float cut[W * H];
    for (int32_t y = 0; y < H; y++)
        memcpy(cut + y * W, all + (Y + y) * WIDTH + X, W * sizeof(float));
    /* Equal but for the rounding of the principal point. */
    assert_true(share_beyond(cut, part, W * H, 1e-4) < 0.002);
    free(all);
    free(part);
    fixture_free(&whole);
    fixture_free(&piece);
}

static void crops_equal_cuts(const char *method)
{
    for (int32_t k = -1; k < crv_filter_count(); k++)
        a_crop_equals_the_cut(method, crv_filter_at(k));
}

/* A depth buffer as graphics hardware writes it, reversed with an infinite far plane (v =
 * near / d), standard with a finite one, and distance from the eye. */
static void depth_encodings_do_not_matter(const char *method)
{
    static const crv_depth_format FORMATS[] = {{CRV_DEPTH_REVERSED, 0.5f, INFINITY, 0},
                                               {CRV_DEPTH_HARDWARE, 0.5f, 50, 0},
                                               {CRV_DEPTH_RADIAL, 0, 0, INFINITY}};
    fixture f = spheres(160, 90), encoded = spheres(160, 90);
    const int32_t count = f.width * f.height;
    crv_options options = fixture_options(method);
    options.radius = 0.5f;
    float *planar = fixture_compute(&f, &options, NULL);
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < count; i++) {
            const double d = (double)f.depth[i];
            const double u =
                (i % 160 + 0.5 - (double)f.camera.cx_px) / (double)f.camera.fx_px;
            const double v =
                (i / 160 + 0.5 - (double)f.camera.cy_px) / (double)f.camera.fy_px;
            const double values[3] = {0.5 / d,
                                      isinf(d) ? 1 : 50 * (d - 0.5) / (d * (50 - 0.5)),
                                      d * sqrt(1 + u * u + v * v)};
            encoded.depth[i] = (float)values[k];
        }
        float *other =
            fixture_compute(&encoded, &options, &(fixture_run){.format = &FORMATS[k]});
        /* Rounding decides a few samples at edges of texels and of the radius. */
        assert_true(share_beyond(planar, other, count, 1e-3) < 0.005);
        free(other);
    }
    free(planar);
    fixture_free(&f);
    fixture_free(&encoded);
}

static void background_is_white_and_does_not_occlude(const char *method)
{
    static const float NOTHING[] = {NAN, INFINITY, -INFINITY, 0, -1};
    fixture f = spheres(96, 64);
    crv_options options = fixture_options(method);
    float *clean = fixture_compute(&f, &options, NULL);
    /* All the encodings of "nothing" instead of infinity change nothing. */
    for (int32_t i = 0, k = 0; i < f.width * f.height; i++) {
        if (isinf(f.depth[i]))
            f.depth[i] = NOTHING[k++ % 5];
    }
    float *mixed = fixture_compute(&f, &options, NULL);
    assert_memory_equal(clean, mixed, (size_t)f.width * (size_t)f.height * sizeof(float));
    for (int32_t i = 0; i < f.width * f.height; i++)
        assert_true(f.depth[i] > 0 || mixed[i] == 1);
    free(clean);
    free(mixed);
    for (int32_t i = 0; i < f.width * f.height; i++)
        f.depth[i] = NAN;
    float *empty = fixture_compute(&f, &options, NULL);
    for (int32_t i = 0; i < f.width * f.height; i++)
        assert_true(empty[i] == 1);
    free(empty);
    fixture_free(&f);
}

static void hostile_input_stays_in_range(const char *method)
{
    fixture f = spheres(64, 48);
    uint32_t state = 1;
    static const float ODD[] = {1e-30f, 1e30f, 3e38f, 1e-38f, NAN, 0.5f, 1, 5};
    for (int32_t i = 0; i < f.width * f.height; i++) {
        state = state * 1664525u + 1013904223u;
        if (state >> 30 == 0)
            f.depth[i] = ODD[state >> 20 & 7];
        if (state >> 28 == 5)
            f.normals[3 * i] = ODD[state >> 10 & 7];
        if (state >> 28 == 6)
            memset(f.normals + 3 * i, 0, 3 * sizeof(float));
    }
    static const float RADII[] = {1e-9f, 0.5f, 1e9f};
    for (int k = 0; k < 3 * 6; k++) {
        crv_options options = fixture_options(method);
        options.radius = RADII[k / 6];
        options.falloff = (crv_falloff)(k % 6);
        float *a = fixture_compute(&f, &options, NULL);
        for (int32_t i = 0; i < f.width * f.height; i++)
            assert_true(a[i] >= 0 && a[i] <= 1);
        free(a);
    }
    fixture_free(&f);
}

static void intensity_and_contrast_follow_their_formula(const char *method)
{
    fixture f = spheres(96, 64);
    crv_options options = fixture_options(method);
    options.filter = NULL;
    float *plain = fixture_compute(&f, &options, NULL);
    options.intensity = 1.5f;
    options.contrast = 2;
    float *strong = fixture_compute(&f, &options, NULL);
    for (int32_t i = 0; i < f.width * f.height; i++) {
        const double base = fmax(0, 1 - 1.5 * (1 - (double)plain[i]));
        assert_true(fabs((double)strong[i] - base * base) < 1e-5); /* float rounding */
    }
    free(plain);
    free(strong);
    fixture_free(&f);
}

static void seeds_differ_and_repeat(const char *method)
{
    fixture f = spheres(96, 64);
    const int32_t count = f.width * f.height;
    crv_options options = fixture_options(method);
    options.filter = NULL;
    float *first = fixture_compute(&f, &options, NULL);
    float *again = fixture_compute(&f, &options, NULL);
    options.seed = 7;
    float *other = fixture_compute(&f, &options, NULL);
    assert_memory_equal(first, again, (size_t)count * sizeof(float));
    assert_true(share_beyond(first, other, count, 1e-3) > 0.05);
    assert_true(fabs(mean(first, count) - mean(other, count)) < 0.01);
    free(first);
    free(again);
    free(other);
    fixture_free(&f);
}

/* One cmocka test for each property, over every method of the registry. */
static void for_every_method(void **state)
{
    void (*const *property)(const char *) = *state;
    assert_true(crv_method_count() > 0);
    for (int32_t m = 0; m < crv_method_count(); m++)
        (*property)(crv_method_at(m)->name);
}

/* test_conformance [--threads|--memory]: all properties; or the one that threads could
 * break; or those that read and write at every edge (the others compare numbers). */
int main(int argc, char **argv)
{
    static void (*const properties[])(const char *method) = {
        threads_do_not_matter,
        scale_does_not_matter,
        a_quarter_turn_does_not_matter,
        resolution_does_not_matter,
        every_size_runs,
        crops_equal_cuts,
        depth_encodings_do_not_matter,
        background_is_white_and_does_not_occlude,
        hostile_input_stays_in_range,
        intensity_and_contrast_follow_their_formula,
        seeds_differ_and_repeat,
    };
#define PROPERTY(i, name)                                                                \
    {                                                                                    \
        name, for_every_method, NULL, NULL, (void *)(uintptr_t)&properties[i]            \
    }
    const struct CMUnitTest tests[] = {
        PROPERTY(0, "threads do not matter"),
        PROPERTY(1, "scale does not matter"),
        PROPERTY(2, "a quarter turn does not matter"),
        PROPERTY(3, "resolution does not matter"),
        PROPERTY(4, "every size runs"),
        PROPERTY(5, "crops equal cuts"),
        PROPERTY(6, "depth encodings do not matter"),
        PROPERTY(7, "background is white and does not occlude"),
        PROPERTY(8, "hostile input stays in range"),
        PROPERTY(9, "intensity and contrast follow their formula"),
        PROPERTY(10, "seeds differ and repeat"),
    };
    if (argc > 1 && strcmp(argv[1], "--threads") == 0) {
        const struct CMUnitTest threads[] = {tests[0]};
        return cmocka_run_group_tests(threads, NULL, NULL);
    }
    if (argc > 1 && strcmp(argv[1], "--memory") == 0) {
        const struct CMUnitTest memory[] = {tests[4], tests[5], tests[7], tests[8]};
        return cmocka_run_group_tests(memory, NULL, NULL);
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
