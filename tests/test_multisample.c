/* SPDX-License-Identifier: MIT */
/* Accessibility for the subpixel samples of a multisampled frame. */
#include "fixture.h"

#include <math.h>
#include <string.h>

/* Floats: sums of a few numbers below 1. */
static const float EXACT = 1e-6f;

enum { WIDTH = 4, HEIGHT = 3, SAMPLES = 4, GUARD = 1 };
enum { FULL_WIDTH = WIDTH + 2 * GUARD, FULL_HEIGHT = HEIGHT + 2 * GUARD };

typedef struct frame {
    crv_context *context;
    crv_gbuffer *gbuffer;
    float depth[FULL_HEIGHT][FULL_WIDTH];
    float accessibility[HEIGHT][WIDTH];
    float samples[HEIGHT][WIDTH][SAMPLES];
    float result[HEIGHT][WIDTH][SAMPLES];
} frame;

static crv_image samples_of(float *data)
{
    return crv_image_packed(data, WIDTH, HEIGHT, SAMPLES);
}

/* A column (depth 2, accessibility 0.2) in front of a floor (depth 5, 0.8): columns 0 and
 * 1 of the picture show the former, 2 and 3 the latter. Guard pixels show nothing near.
 */
static void make(frame *f, const crv_context_desc *hooks)
{
    memset(f, 0, sizeof *f);
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, FULL_WIDTH, FULL_HEIGHT);
    desc.guard_left = desc.guard_right = desc.guard_top = desc.guard_bottom = GUARD;
    for (int y = 0; y < FULL_HEIGHT; y++) {
        for (int x = 0; x < FULL_WIDTH; x++)
            f->depth[y][x] = 100;
    }
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            f->depth[y + GUARD][x + GUARD] = x < 2 ? 2 : 5;
            f->accessibility[y][x] = x < 2 ? 0.2f : 0.8f;
            for (int s = 0; s < SAMPLES; s++)
                f->samples[y][x][s] = x < 2 ? 2 : 5;
        }
    }
    assert_int_equal(crv_context_create(hooks, &f->context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(f->context, &desc, &f->gbuffer), CRV_OK);
}

static void set(frame *f)
{
    crv_camera camera = crv_camera_perspective(FULL_WIDTH, FULL_HEIGHT, 1);
    crv_const_image depth =
        crv_const_image_packed(&f->depth[0][0], FULL_WIDTH, FULL_HEIGHT, 1);
    assert_int_equal(crv_gbuffer_set_camera(f->gbuffer, &camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(f->gbuffer, 0, &depth, NULL), CRV_OK);
}

static crv_status gather(frame *f, const crv_depth_format *format, float range)
{
    const crv_const_image accessibility =
        crv_const_image_packed(&f->accessibility[0][0], WIDTH, HEIGHT, 1);
    const crv_const_image samples = crv_image_const(samples_of(&f->samples[0][0][0]));
    crv_image result = samples_of(&f->result[0][0][0]);
    return crv_multisample_gather(f->gbuffer, &accessibility, &samples, format, range,
                                  &result);
}

static void destroy(frame *f)
{
    crv_gbuffer_destroy(f->gbuffer);
    crv_context_destroy(f->context);
}

static void an_edge_pixel_gives_each_sample_its_surface(void **state)
{
    (void)state;
    frame f;
    make(&f, NULL);
    set(&f);
    /* The last pixel of the column: two of its samples see the floor, one the sky, and
     * the other way round beside it. */
    f.samples[1][1][1] = f.samples[1][1][2] = 5;
    f.samples[1][1][3] = INFINITY;
    f.samples[1][2][0] = 2;
    f.samples[1][2][1] = -1;
    assert_int_equal(gather(&f, NULL, 0.5f), CRV_OK);
    static const float LEFT[SAMPLES] = {0.2f, 0.8f, 0.8f, 1},
                       RIGHT[SAMPLES] = {0.2f, 1, 0.8f, 0.8f};
    for (int s = 0; s < SAMPLES; s++) {
        assert_float_equal(f.result[1][1][s], LEFT[s], EXACT);
        assert_float_equal(f.result[1][2][s], RIGHT[s], EXACT);
        assert_float_equal(f.result[0][0][s], 0.2f, EXACT);
        assert_float_equal(f.result[2][3][s], 0.8f, EXACT);
    }
    destroy(&f);
}

static void neighbours_weigh_by_their_depth(void **state)
{
    (void)state;
    frame f;
    make(&f, NULL);
    /* Around the pixel (1, 1): centre, left, right, above, below. */
    static const float DEPTH[5] = {2, 2.25f, 1.5f, 2.125f, 3},
                       A[5] = {0.5f, 0.1f, 0.9f, 0.3f, 0.7f};
    static const int AT[5][2] = {{1, 1}, {0, 1}, {2, 1}, {1, 0}, {1, 2}};
    for (int i = 0; i < 5; i++) {
        f.depth[AT[i][1] + GUARD][AT[i][0] + GUARD] = DEPTH[i];
        f.accessibility[AT[i][1]][AT[i][0]] = A[i];
    }
    set(&f);
    f.samples[1][1][0] = 2;
    f.samples[1][1][1] = 2.25f;
    f.samples[1][1][2] = 2.6f;
    f.samples[1][1][3] = 2.55f;
    assert_int_equal(gather(&f, NULL, 0.5f), CRV_OK);
    /* Range 0.5: weights 1, 1/2, 0, 3/4, 0: (0.5 + 0.05 + 0.225) / 2.25. */
    assert_float_equal(f.result[1][1][0], 0.775f / 2.25f, EXACT);
    /* From 2.25: 1/2, 1, 0, 3/4, 0: (0.25 + 0.1 + 0.225) / 2.25. */
    assert_float_equal(f.result[1][1][1], 0.575f / 2.25f, EXACT);
    /* From 2.6: 0, 0.3, 0, 0.05, 0.2: (0.03 + 0.015 + 0.14) / 0.55. */
    assert_float_equal(f.result[1][1][2], 0.185f / 0.55f, EXACT);
    /* The smallest range: none is in it, the left neighbour (0.3 off) is nearest. */
    assert_int_equal(gather(&f, NULL, 0.01f), CRV_OK);
    assert_float_equal(f.result[1][1][3], 0.1f, EXACT);
    destroy(&f);
}

static void a_flat_wall_gets_the_mean_of_the_cross(void **state)
{
    (void)state;
    frame f;
    make(&f, NULL);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            f.depth[y + GUARD][x + GUARD] = 5;
            f.accessibility[y][x] = 0.1f * (float)x + 0.2f * (float)y;
            for (int s = 0; s < SAMPLES; s++)
                f.samples[y][x][s] = 5;
        }
    }
    set(&f);
    assert_int_equal(gather(&f, NULL, 0.5f), CRV_OK);
    for (int s = 0; s < SAMPLES; s++) {
        /* Inside, the mean of a linear function over the cross is its centre. */
        assert_float_equal(f.result[1][1][s], 0.3f, EXACT);
        assert_float_equal(f.result[1][2][s], 0.4f, EXACT);
        /* In the corner three are left: (0 + 0.1 + 0.2) / 3. */
        assert_float_equal(f.result[0][0][s], 0.1f, EXACT);
    }
    destroy(&f);
}

static void nothing_around_is_open(void **state)
{
    (void)state;
    frame f;
    make(&f, NULL);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < 3; x++)
            f.depth[y + GUARD][x + GUARD] = NAN;
        f.accessibility[y][3] = NAN;
    }
    set(&f);
    assert_int_equal(gather(&f, NULL, 0.5f), CRV_OK);
    for (int s = 0; s < SAMPLES; s++) {
        assert_true(f.result[1][0][s] == 1); /* a surface in a hole of the G-buffer */
        assert_true(f.result[1][3][s] == 1); /* a value that is none */
    }
    destroy(&f);
}

static void sample_depths_have_their_encoding(void **state)
{
    (void)state;
    frame f;
    make(&f, NULL);
    set(&f);
    /* near 1, far 9: v = (1 - 1/d) / (1 - 1/9). */
    const crv_depth_format hardware = {CRV_DEPTH_HARDWARE, 1, 9, INFINITY};
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            f.samples[y][x][0] = 0.5625f; /* 2 */
            f.samples[y][x][1] = 0.9f;    /* 5 */
            f.samples[y][x][2] = 1;       /* background */
            f.samples[y][x][3] = 0.9f;
        }
    }
    assert_int_equal(gather(&f, &hardware, 0.5f), CRV_OK);
    static const float EXPECTED[SAMPLES] = {0.2f, 0.8f, 1, 0.8f};
    for (int s = 0; s < SAMPLES; s++)
        assert_float_equal(f.result[1][1][s], EXPECTED[s], EXACT);
    /* Along the slanted ray of the corner's pixel, (1.5, 1) px from the middle (3, 2.5):
     * the planar depth 5 is longer. */
    const crv_camera camera = crv_camera_perspective(FULL_WIDTH, FULL_HEIGHT, 1);
    const crv_depth_format radial = {CRV_DEPTH_RADIAL, 0, 0, INFINITY};
    const float length = sqrtf(1 + (1.5f * 1.5f + 1) / (camera.fx_px * camera.fx_px));
    f.samples[0][3][0] = 5 * length;
    f.accessibility[0][3] = 0.4f;
    /* Its neighbours are on the floor at 0.8: (0.4 + 2 * 0.8) / 3, all weights 1. */
    assert_int_equal(gather(&f, &radial, 0.5f), CRV_OK);
    assert_float_equal(f.result[0][3][0], 2.0f / 3, 1e-5f); /* 1e-6 of depth / range */
    destroy(&f);
}

static void bad_arguments_are_refused(void **state)
{
    (void)state;
    frame f;
    make(&f, NULL);
    assert_int_equal(gather(&f, NULL, 0.5f), CRV_ERROR_NOT_READY);
    set(&f);
    static const float RANGES[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++)
        assert_int_equal(gather(&f, NULL, RANGES[i]), CRV_ERROR_INVALID_ARGUMENT);
    const crv_depth_format odd = {CRV_DEPTH_HARDWARE, 2, 1, INFINITY};
    assert_int_equal(gather(&f, &odd, 0.5f), CRV_ERROR_INVALID_ARGUMENT);

    const crv_const_image a =
        crv_const_image_packed(&f.accessibility[0][0], WIDTH, HEIGHT, 1);
    crv_image in_place = samples_of(&f.samples[0][0][0]);
    const crv_const_image d = crv_image_const(in_place);
    crv_image out = samples_of(&f.result[0][0][0]);
    const float before = f.result[0][0][0] = -7;
    crv_const_image small = d, single = d, many = d;
    crv_image other = out, overlap = out;
    small.width--;
    single.channels = 1;
    many.channels = 17;
    other.channels = 3;
    overlap.channel_stride = 0;
    crv_gbuffer *g = f.gbuffer;
    const crv_status bad = CRV_ERROR_INVALID_ARGUMENT;
    assert_int_equal(crv_multisample_gather(NULL, &a, &d, NULL, 1, &out), bad);
    assert_int_equal(crv_multisample_gather(g, NULL, &d, NULL, 1, &out), bad);
    assert_int_equal(crv_multisample_gather(g, &a, NULL, NULL, 1, &out), bad);
    assert_int_equal(crv_multisample_gather(g, &a, &d, NULL, 1, NULL), bad);
    assert_int_equal(crv_multisample_gather(g, &d, &d, NULL, 1, &out), bad);
    assert_int_equal(crv_multisample_gather(g, &a, &small, NULL, 1, &out), bad);
    assert_int_equal(crv_multisample_gather(g, &a, &single, NULL, 1, &out), bad);
    assert_int_equal(crv_multisample_gather(g, &a, &many, NULL, 1, &out), bad);
    assert_int_equal(crv_multisample_gather(g, &a, &d, NULL, 1, &other), bad);
    assert_int_equal(crv_multisample_gather(g, &a, &d, NULL, 1, &overlap), bad);
    assert_true(f.result[0][0][0] == before);
    /* The result may take the place of the depths. */
    assert_int_equal(crv_multisample_gather(g, &a, &d, NULL, 1, &in_place), CRV_OK);
    assert_float_equal(f.samples[0][0][0], 0.2f, EXACT);
    destroy(&f);
}

static void count_tasks(void *user, uint32_t count, void (*task)(void *, uint32_t),
                        void *data)
{
    *(uint32_t *)user += count;
    for (uint32_t i = count; i-- > 0;)
        task(data, i);
}

static void rows_run_in_the_hosts_loop(void **state)
{
    (void)state;
    uint32_t tasks = 0;
    crv_context_desc hooks;
    crv_context_desc_init(&hooks, sizeof hooks);
    hooks.parallel = (crv_parallel){count_tasks, &tasks};
    static frame plain, hooked;
    make(&plain, NULL);
    make(&hooked, &hooks);
    set(&plain);
    set(&hooked);
    tasks = 0;
    assert_int_equal(gather(&plain, NULL, 4), CRV_OK);
    assert_int_equal(gather(&hooked, NULL, 4), CRV_OK);
    assert_int_equal(tasks, HEIGHT);
    assert_memory_equal(plain.result, hooked.result, sizeof plain.result);
    destroy(&plain);
    destroy(&hooked);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edge_pixel_gives_each_sample_its_surface),
        cmocka_unit_test(neighbours_weigh_by_their_depth),
        cmocka_unit_test(a_flat_wall_gets_the_mean_of_the_cross),
        cmocka_unit_test(nothing_around_is_open),
        cmocka_unit_test(sample_depths_have_their_encoding),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(rows_run_in_the_hosts_loop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
