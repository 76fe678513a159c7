/* SPDX-License-Identifier: MIT */
/* The short way: crv_ao(), conversions of depth and of other types without a context. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 40, HEIGHT = 30, COUNT = WIDTH * HEIGHT };

static const double ONE = 1;

static fixture spheres(void)
{
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    return fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT);
}

static void keep_line(void *user, crv_log_level level, const char *line)
{
    (void)level;
    snprintf(user, 512, "%s", line);
}

/* One call gives the bits of the long way. */
static void short_way_is_the_long_way(void **state)
{
    (void)state;
    fixture f = spheres();
    const crv_const_image depth = crv_const_image_packed(f.depth, WIDTH, HEIGHT, 1);
    const crv_const_image normals = crv_const_image_packed(f.normals, WIDTH, HEIGHT, 3);
    float pixels[COUNT];
    const crv_image result = crv_image_packed(pixels, WIDTH, HEIGHT, 1);
    const crv_logger strict = fixture_strict_logger();
    for (int with_normals = 0; with_normals < 2; with_normals++) {
        crv_options options = fixture_options(with_normals ? "vao" : NULL);
        const fixture_run run = {.without_normals = !with_normals};
        float *expected = fixture_compute(&f, &options, &run);
        assert_int_equal(crv_ao(&depth, with_normals ? &normals : NULL, &f.camera,
                                with_normals ? &options : NULL, &result, &strict),
                         CRV_OK);
        if (!fixture_on_vulkan())
            assert_memory_equal(pixels, expected, sizeof pixels);
        free(expected);
    }
    fixture_free(&f);
}

static void short_way_refuses_with_a_line(void **state)
{
    (void)state;
    float pixels[COUNT] = {0};
    const crv_const_image depth = crv_const_image_packed(pixels, WIDTH, HEIGHT, 1);
    const crv_const_image wide = crv_const_image_packed(pixels, WIDTH + 1, 2, 1);
    const crv_image result = crv_image_packed(pixels, WIDTH, HEIGHT, 1);
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1);
    crv_options zeroed = {.struct_size = 0};
    char line[512] = "";
    const crv_logger logger = {keep_line, line};
    const crv_status bad = CRV_ERROR_INVALID_ARGUMENT;
    assert_int_equal(crv_ao(NULL, NULL, &camera, NULL, &result, &logger), bad);
    assert_non_null(strstr(line, "NULL"));
    assert_int_equal(crv_ao(&depth, NULL, NULL, NULL, &result, NULL), bad);
    assert_int_equal(crv_ao(&depth, NULL, &camera, NULL, NULL, NULL), bad);
    line[0] = 0;
    assert_int_equal(crv_ao(&wide, NULL, &camera, NULL, &result, &logger), bad);
    assert_non_null(strstr(line, "expected"));
    assert_int_equal(crv_ao(&depth, &depth, &camera, NULL, &result, &logger), bad);
    assert_int_equal(crv_ao(&depth, NULL, &camera, &zeroed, &result, &logger), bad);
    assert_non_null(strstr(line, "crv_options_init()"));
}

/* The numbers that a G-buffer would hold, for every encoding; in place, too. */
static void depth_converts_as_in_a_gbuffer(void **state)
{
    (void)state;
    const crv_depth_encoding encodings[] = {CRV_DEPTH_PLANAR,     CRV_DEPTH_RADIAL,
                                            CRV_DEPTH_HARDWARE,   CRV_DEPTH_GL,
                                            CRV_DEPTH_NORMALISED, CRV_DEPTH_LOGARITHMIC};
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1);
    float values[COUNT], expected[COUNT], planar[COUNT];
    for (int i = 0; i < COUNT; i++)
        values[i] = (float)(i % 97) / 96;
    values[5] = NAN;
    values[6] = -2;
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT);
    crv_context *context = fixture_context_open();
    crv_gbuffer *gbuffer = NULL;
    assert_int_equal(crv_gbuffer_create(context, &desc, &gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &camera), CRV_OK);
    for (size_t i = 0; i < sizeof encodings / sizeof encodings[0]; i++) {
        const crv_depth_format format = {
            .encoding = encodings[i], .z_near = 0.5f, .z_far = 20, .background = 0.8f};
        const crv_const_image from = crv_const_image_packed(values, WIDTH, HEIGHT, 1);
        const crv_image to = crv_image_packed(planar, WIDTH, HEIGHT, 1);
        const crv_image reference = crv_image_packed(expected, WIDTH, HEIGHT, 1);
        assert_int_equal(crv_gbuffer_set_depth(gbuffer, 0, &from, &format), CRV_OK);
        assert_int_equal(crv_gbuffer_get_depth(gbuffer, 0, &reference), CRV_OK);
        assert_int_equal(crv_depth_convert(&from, &format, &camera, &to, NULL), CRV_OK);
        assert_memory_equal(planar, expected, sizeof planar);
        memcpy(planar, values, sizeof planar);
        const crv_const_image same = crv_image_const(to);
        assert_int_equal(crv_depth_convert(&same, &format, &camera, &to, NULL), CRV_OK);
        assert_memory_equal(planar, expected, sizeof planar);
    }
    crv_gbuffer_destroy(gbuffer);
    fixture_context_close(context);
    const crv_const_image from = crv_const_image_packed(values, WIDTH, HEIGHT, 1);
    const crv_image small = crv_image_packed(planar, WIDTH, HEIGHT - 1, 1);
    const crv_status bad = CRV_ERROR_INVALID_ARGUMENT;
    assert_int_equal(crv_depth_convert(&from, NULL, &camera, &small, NULL), bad);
    assert_int_equal(crv_depth_convert(NULL, NULL, &camera, &small, NULL), bad);
    assert_int_equal(crv_depth_convert(&from, NULL, NULL, &small, NULL), bad);
}

static void other_types_become_floats(void **state)
{
    (void)state;
    /* IEEE 754-2008, table 3.5: 1, -2, the largest, the least normal and subnormal
     * numbers, infinity, NaN, -0. */
    static const uint16_t HALVES[8] = {0x3c00, 0xc000, 0x7bff, 0x0400,
                                       0x0001, 0x7c00, 0x7e01, 0x8000};
    static const float VALUES[8] = {1,        -2,       65504, 0x1p-14f,
                                    0x1p-24f, INFINITY, NAN,   -0.0f};
    float out[8];
    const crv_image to = crv_image_packed(out, 4, 2, 1);
    crv_texels from = crv_texels_packed(HALVES, CRV_TEXEL_HALF, 4, 2, 1);
    assert_int_equal(crv_image_convert(&from, &to, NULL), CRV_OK);
    for (int i = 0; i < 8; i++)
        assert_true(isnan(VALUES[i]) ? isnan(out[i]) : out[i] == VALUES[i]);

    /* The ends of a 16-bit depth buffer are 0 and 1 exactly: 1 is background. */
    static const uint16_t DEPTHS[8] = {0, 65535, 32768, 1, 2, 3, 4, 5};
    from = crv_texels_packed(DEPTHS, CRV_TEXEL_UINT16, 4, 2, 1);
    from.scale = 1 / 65535.0;
    assert_int_equal(crv_image_convert(&from, &to, NULL), CRV_OK);
    assert_true(out[0] == 0 && out[1] == 1 && out[2] == (float)(32768 / 65535.0));

    static const double DOUBLES[8] = {0.1, -1e300, 3, 4, 5, 6, 7, 8};
    from = crv_texels_packed(DOUBLES, CRV_TEXEL_DOUBLE, 4, 2, 1);
    assert_int_equal(crv_image_convert(&from, &to, NULL), CRV_OK);
    assert_true(out[0] == 0.1f && isinf(out[1]) && out[7] == 8);

    /* Normals of three in four bytes, the last row first. */
    static const uint8_t BYTES[2][4] = {{0, 255, 51, 9}, {255, 0, 102, 9}};
    float normals[2][3];
    const crv_image vectors = crv_image_packed(normals[0], 1, 2, 3);
    from = crv_texels_packed(BYTES[1], CRV_TEXEL_UINT8, 1, 2, 3);
    from.pixel_stride = 4;
    from.row_stride = -4;
    from.scale = 2 / 255.0;
    from.offset = -1;
    assert_int_equal(crv_image_convert(&from, &vectors, NULL), CRV_OK);
    assert_true(normals[0][0] == 1 && normals[0][1] == -1 && normals[1][1] == 1);
    assert_float_equal(normals[1][2], -0.6f, 1e-6); /* 2 * 51 / 255 - 1 */

    static const int16_t SIGNED[2] = {-32767, 5};
    from = crv_texels_packed(SIGNED, CRV_TEXEL_INT16, 2, 1, 1);
    const crv_image two = crv_image_packed(out, 2, 1, 1);
    assert_int_equal(crv_image_convert(&from, &two, NULL), CRV_OK);
    assert_true(out[0] == -32767 && out[1] == 5);

    const crv_status bad = CRV_ERROR_INVALID_ARGUMENT;
    assert_int_equal(crv_image_convert(NULL, &two, NULL), bad);
    assert_int_equal(crv_image_convert(&from, &to, NULL), bad);
    from.type = (crv_texel)17;
    assert_int_equal(crv_image_convert(&from, &two, NULL), bad);
}

/* Radius 0.5 at depth 2 with a focal length of 100 px is 25 px; edges15 reads 7. */
static void guard_band_is_the_projected_radius(void **state)
{
    (void)state;
    crv_options options = fixture_options("hbao");
    crv_camera camera = crv_camera_perspective(200, 200, 1.57079633f);
    options.radius = 0.5f;
    assert_int_equal(crv_guard_px(&options, &camera, 2), 25 + 7);
    options.filter = NULL;
    assert_int_equal(crv_guard_px(&options, &camera, 2), 25);
    options.max_radius_px = 10;
    assert_int_equal(crv_guard_px(&options, &camera, 2), 10);
    options.max_radius_px = 0;
    assert_int_equal(crv_guard_px(&options, &camera, 1e-9f), CRV_MAX_SIZE);
    assert_int_equal(crv_guard_px(&options, &camera, 0), 0);
    assert_int_equal(crv_guard_px(NULL, &camera, 2), 0);
    assert_int_equal(crv_guard_px(&options, NULL, 2), 0);
    camera = crv_camera_orthographic(200, 200, 4); /* 50 px for a unit */
    assert_int_equal(crv_guard_px(&options, &camera, 0), 25);
}

static void count_warnings(void *user, crv_log_level level, const char *line)
{
    int32_t *warnings = user;
    *warnings += level == CRV_LOG_WARNING && strncmp(line, "depth: ", 7) == 0;
}

/* Depth that cannot be right is told once, and depth that can be is not. */
static void depth_that_cannot_be_right_is_told_once(void **state)
{
    (void)state;
    const crv_depth_format planar = crv_depth_format_planar();
    const crv_depth_format hardware = {
        .encoding = CRV_DEPTH_HARDWARE, .z_near = 0.1f, .z_far = 100};
    const struct {
        const crv_depth_format *format;
        float first, other; /* of the first half of the pixels, and of the second */
        int32_t warnings;
    } CASES[] = {
        {&planar, 3, 8, 0},        {&planar, 3, INFINITY, 0}, {&planar, 0, 8, 0},
        {&planar, 0.02f, 0.5f, 0}, {&hardware, 0.9f, 1, 0},   {&hardware, 3, 8, 1},
        {&hardware, 0.9f, -2, 1},  {&hardware, 1, 1, 1},      {&planar, -3, 8, 1},
        {&planar, 0, 0, 1},        {&planar, 0.02f, 0, 1},    {&planar, NAN, INFINITY, 1},
    };
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1);
    int32_t warnings = 0;
    crv_context_desc hooks;
    crv_gbuffer_desc desc;
    crv_context *context = NULL;
    crv_context_desc_init(&hooks, sizeof hooks);
    hooks.logger = (crv_logger){.fn = count_warnings, .user = &warnings};
    crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT);
    assert_int_equal(crv_context_create(&hooks, &context), CRV_OK);
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        float values[COUNT];
        for (int k = 0; k < COUNT; k++)
            values[k] = k < COUNT / 2 ? CASES[i].first : CASES[i].other;
        const crv_const_image depth = crv_const_image_packed(values, WIDTH, HEIGHT, 1);
        crv_gbuffer *gbuffer = NULL;
        warnings = 0;
        assert_int_equal(crv_gbuffer_create(context, &desc, &gbuffer), CRV_OK);
        for (int frame = 0; frame < 3; frame++) {
            assert_int_equal(crv_gbuffer_set_camera(gbuffer, &camera), CRV_OK);
            assert_int_equal(crv_gbuffer_set_depth(gbuffer, 0, &depth, CASES[i].format),
                             CRV_OK);
        }
        crv_gbuffer_destroy(gbuffer);
        assert_int_equal(warnings, CASES[i].warnings);
    }
    crv_context_destroy(context);
}

static double rms_error(const float *a, const float *b)
{
    double sum = 0;
    for (int i = 0; i < COUNT; i++)
        sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sqrt(sum / COUNT);
}

/* The mean of 16 frames with noise of their own comes near the estimate with 32 times the
 * directions; the same frame 16 times does not. */
static void frames_of_other_noise_average_out(void **state)
{
    (void)state;
    fixture f = spheres();
    const fixture_run run = {.exact = 1};
    crv_options options = fixture_options("hbao");
    options.filter = NULL;
    options.directions = 4;
    options.noise_size = 1; /* no help from neighbours */
    options.steps = 32;
    float mean[COUNT] = {0};
    double first = 0;
    crv_options converged = options;
    converged.directions = 128;
    float *truth = fixture_compute(&f, &converged, &run);
    for (int frame = 0; frame < 16; frame++) {
        options.noise_index = frame;
        float *pixels = fixture_compute(&f, &options, &run);
        if (frame == 0)
            first = rms_error(pixels, truth);
        for (int i = 0; i < COUNT; i++)
            mean[i] += pixels[i] / 16;
        free(pixels);
    }
    /* 16 well-spread draws: an error of a quarter would be that of random ones. */
    assert_true(first > 0.005);
    assert_true(rms_error(mean, truth) < first / 4);
    free(truth);
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_way_is_the_long_way),
        cmocka_unit_test(short_way_refuses_with_a_line),
        cmocka_unit_test(depth_converts_as_in_a_gbuffer),
        cmocka_unit_test(other_types_become_floats),
        cmocka_unit_test(guard_band_is_the_projected_radius),
        cmocka_unit_test(depth_that_cannot_be_right_is_told_once),
        cmocka_unit_test(frames_of_other_noise_average_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
