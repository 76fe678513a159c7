/* SPDX-License-Identifier: MIT */
/* The filters against sums done by hand, and what all of them must hold. */
#include "fixture.h"

#include <math.h>
#include <string.h>

enum { SIZE = 33, COUNT = SIZE * SIZE, MIDDLE = SIZE / 2 * SIZE + SIZE / 2 };

/* Filters an image over these depths, and normals unless NULL. */
static void apply_with(const char *filter, int32_t slope, float normal_deg,
                       const float *depth, const float *normals, const float *in,
                       float *out)
{
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, SIZE, SIZE);
    crv_options options = fixture_options(NULL);
    assert_int_equal(crv_options_set(&options, "filter", filter, NULL), CRV_OK);
    options.radius = 2;
    options.filter_depth = 0.25f; /* 0.5 scene units */
    options.filter_slope = slope;
    options.filter_normal = normal_deg;
    crv_camera camera = crv_camera_perspective(SIZE, SIZE, 1);
    crv_const_image depths = crv_const_image_packed(depth, SIZE, SIZE, 1);
    crv_const_image input = crv_const_image_packed(in, SIZE, SIZE, 1);
    crv_image result = crv_image_packed(out, SIZE, SIZE, 1);
    crv_context *context = fixture_context_open();
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    assert_int_equal(crv_gbuffer_create(context, &desc, &gbuffer), CRV_OK);
    assert_int_equal(crv_plan_create(context, &options, &desc, &plan), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(gbuffer, 0, &depths, NULL), CRV_OK);
    if (normals) {
        crv_const_image n = crv_const_image_packed(normals, SIZE, SIZE, 3);
        assert_int_equal(crv_gbuffer_set_normals(gbuffer, &n, CRV_NORMAL_VIEW), CRV_OK);
    }
    assert_int_equal(crv_plan_filter(plan, gbuffer, &input, &result), CRV_OK);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    fixture_context_close(context);
}

static void apply(const char *filter, int32_t slope, const float *depth, const float *in,
                  float *out)
{
    apply_with(filter, slope, 25, depth, NULL, in, out);
}

static void fill(float *image, float value)
{
    for (int32_t i = 0; i < COUNT; i++)
        image[i] = value;
}

/* 1 2 3 4 3 2 1, and a third of the same 4 pixels to each side. */
static double levels_at(int32_t k)
{
    double sum = 0;
    for (int32_t side = -4; side <= 4; side += 4) {
        const double height = 4 - abs(k - side);
        sum += (side ? 0.2 : 0.6) * (height > 0 ? height / 16 : 0);
    }
    return sum;
}

static void flat_depth_gives_the_plain_kernel(void **state)
{
    (void)state;
    static float depth[COUNT], in[COUNT], out[COUNT];
    fill(depth, 5);
    fill(in, 1);
    in[MIDDLE] = 0;
    /* An impulse comes out as the kernel: weight at (dx, dy) over the sum of weights. */
    apply("gauss5", 1, depth, in, out);
    static const double B[5] = {1, 4, 6, 4, 1};
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t dx = i % SIZE - SIZE / 2, dy = i / SIZE - SIZE / 2;
        const double w = abs(dx) > 2 || abs(dy) > 2 ? 0 : B[dx + 2] * B[dy + 2] / 256;
        assert_true(fabs(1 - (double)out[i] - w) < 1e-6); /* float sums of 25 taps */
    }
    apply("box4", 1, depth, in, out);
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t dx = i % SIZE - SIZE / 2, dy = i / SIZE - SIZE / 2;
        const int inside = dx >= -1 && dx <= 2 && dy >= -1 && dy <= 2;
        assert_true(fabs(1 - (double)out[i] - inside / 16.0) < 1e-6);
    }
    apply("edges15", 1, depth, in, out);
    for (int32_t i = 0; i < COUNT; i++) {
        const double w = levels_at(i % SIZE - SIZE / 2) * levels_at(i / SIZE - SIZE / 2);
        assert_true(fabs(1 - (double)out[i] - w) < 1e-6);
    }
    apply("bilateral13", 1, depth, in, out);
    double sum = 0;
    for (int k = -6; k <= 6; k++)
        sum += exp(-k * k / 18.0);
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t dx = i % SIZE - SIZE / 2, dy = i / SIZE - SIZE / 2;
        const double w = abs(dx) > 6 || abs(dy) > 6
                             ? 0
                             : exp(-(dx * dx + dy * dy) / 18.0) / (sum * sum);
        assert_true(fabs(1 - (double)out[i] - w) < 1e-6);
    }
}

static void edges_are_kept(void **state)
{
    (void)state;
    static float depth[COUNT], in[COUNT], out[COUNT];
    for (int32_t f = 0; f < crv_filter_count(); f++) {
        const char *name = crv_filter_at(f)->name;
        for (int32_t i = 0; i < COUNT; i++) {
            const int right = i % SIZE >= SIZE / 2;
            depth[i] = right ? 50 : 5;
            in[i] = right ? 1 : 0.25f;
        }
        apply(name, 1, depth, in, out);
        /* gauss5 never leaves a tap out: over 45 units of depth, 90 times filter_depth,
         * its weights are 0.125/90 of what they are on the same surface. */
        const double leak = strcmp(name, "gauss5") == 0 ? 0.002 : 1e-6;
        for (int32_t i = 0; i < COUNT; i++)
            assert_true(fabs((double)out[i] - (double)in[i]) < leak);
    }
}

static void background_is_no_tap(void **state)
{
    (void)state;
    static float depth[COUNT], in[COUNT], out[COUNT];
    for (int32_t f = 0; f < crv_filter_count(); f++) {
        for (int32_t i = 0; i < COUNT; i++) {
            const int sky = i % 3 == 0;
            depth[i] = sky ? INFINITY : 5;
            in[i] = sky ? 1 : 0.5f;
        }
        apply(crv_filter_at(f)->name, 0, depth, in, out);
        for (int32_t i = 0; i < COUNT; i++)
            assert_true(fabsf(out[i] - in[i]) < 1e-6f);
    }
}

/* On a slope of 0.8 and 3 units a pixel every neighbour is beyond the depth limit of 0.5;
 * only the slope tells that they belong to the same surface. */
static void slopes_are_followed(void **state)
{
    (void)state;
    static float depth[COUNT], in[COUNT], followed[COUNT], literal[COUNT];
    for (int32_t i = 0; i < COUNT; i++) {
        depth[i] = 200 + 0.8f * (float)(i % SIZE) - 3 * (float)(i / SIZE);
        in[i] = (i + i / SIZE) % 2 ? 1.0f : 0.0f; /* a chequerboard: SIZE is odd */
    }
    for (int32_t f = 0; f < crv_filter_count(); f++) {
        const char *name = crv_filter_at(f)->name;
        apply(name, 1, depth, in, followed);
        apply(name, 0, depth, in, literal);
        /* Kernels weigh black and white alike to a sixteenth. */
        assert_true(fabsf(followed[MIDDLE] - 0.5f) < 0.07f);
        /* gauss5 weighs its neighbours little. So does edges15 if all edges are shut: by
         * 0.1 of 1.1 in one pass, in two less than twice that. The others do not weigh
         * them. */
        const int is_gauss5 = strcmp(name, "gauss5") == 0,
                  is_edges15 = strcmp(name, "edges15") == 0;
        const float rest = is_gauss5 ? 0.25f : is_edges15 ? 0.19f : 0;
        assert_true(fabsf(literal[MIDDLE] - in[MIDDLE]) <= rest);
    }
}

static void non_finite_values_count_as_open(void **state)
{
    (void)state;
    static float depth[COUNT], in[COUNT], out[COUNT];
    fill(depth, 5);
    for (int32_t i = 0; i < COUNT; i++)
        in[i] = i % 5 == 0 ? NAN : i % 5 == 1 ? INFINITY : 1;
    for (int32_t f = 0; f < crv_filter_count(); f++) {
        apply(crv_filter_at(f)->name, 1, depth, in, out);
        for (int32_t i = 0; i < COUNT; i++)
            assert_true(fabsf(out[i] - 1) < 1e-6f);
    }
    apply("none", 0, depth, in, out);
    for (int32_t i = 0; i < COUNT; i++)
        assert_true(out[i] == 1);
}

/* Two faces that meet at the same depth; their normals are 40 degrees apart. */
static void faces_that_meet_are_kept_apart(void **state)
{
    (void)state;
    static float depth[COUNT], normals[3 * COUNT], in[COUNT], apart[COUNT], joined[COUNT];
    fill(depth, 5);
    for (int32_t i = 0; i < COUNT; i++) {
        const int right = i % SIZE >= SIZE / 2;
        const double angle = right ? 40 * 3.14159265358979 / 180 : 0;
        const float n[3] = {(float)sin(angle), 0, (float)cos(angle)};
        memcpy(normals + (ptrdiff_t)3 * i, n, sizeof n);
        in[i] = right ? 1 : 0.25f;
    }
    for (int32_t f = 0; f < crv_filter_count(); f++) {
        const char *name = crv_filter_at(f)->name;
        apply_with(name, 1, 39, depth, normals, in, apart);
        apply_with(name, 1, 180, depth, normals, in, joined);
        for (int32_t i = 0; i < COUNT; i++)
            assert_true(fabsf(apart[i] - in[i]) < 1e-6f);
        assert_true(joined[MIDDLE] < 0.9f);
        /* Past the angle the other face begins to count, but less than its own. */
        apply_with(name, 1, 60, depth, normals, in, apart);
        assert_true(apart[MIDDLE] < 0.999f && apart[MIDDLE] >= joined[MIDDLE]);
    }
}

/* A line of a pixel, nearer than the surface around it. */
static void edges15_takes_little_of_what_is_unlike(void **state)
{
    (void)state;
    enum { LINE = SIZE / 2 };
    static float depth[COUNT], in[COUNT], out[COUNT];
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t x = i % SIZE;
        depth[i] = x == LINE ? 5 : 20;
        in[i] = x < LINE ? 1 : x == LINE ? 0 : 0.5f;
    }
    apply("edges15", 1, depth, in, out);
    /* Alone between two edges, the line has 0.05 of each side's value, and its own. */
    assert_true(fabs((double)out[MIDDLE] - 0.05 * (1 + 0.5) / 1.1) < 1e-6);
}

/* Columns at one depth every `period` pixels, others behind them, all facing the camera;
 * the middle one is 0, all else 1. */
static void filter_comb(int32_t period, float *out)
{
    static float depth[COUNT], normals[3 * COUNT], in[COUNT];
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t from_middle = i % SIZE - SIZE / 2;
        normals[3 * i + 2] = 1;
        depth[i] = from_middle % period == 0 ? 5 : 20;
        in[i] = from_middle == 0 ? 0 : 1;
    }
    apply_with("edges15", 0, 25, depth, normals, in, out);
}

static void edges15_bridges_gaps(void **state)
{
    (void)state;
    static float out[COUNT];
    /* By level: 1/11; with the columns 2 away, 6/11; with those 4 away, 8/11. */
    filter_comb(2, out);
    assert_true(fabs((double)out[MIDDLE] - 8.0 / 11) < 1e-6);
    /* The column beside it, behind: 10.5/11, 0.965909 (with its own kind, of which one
     * has 10.5/11, too), and with 0.988636 and 1 at 4 pixels: */
    const double beside = (0.9659091 + (0.9886364 + 1) / 3) / (5.0 / 3);
    assert_true(fabs((double)out[MIDDLE + 1] - beside) < 1e-6);
    /* Nothing within 2 pixels: 1.1 of 4 was found, the pixel counts 0.55^2. */
    filter_comb(4, out);
    const double own = 0.55 * 0.55, far = (own / 11 + 2.0 / 3) / (own + 2.0 / 3);
    assert_true(fabs((double)out[MIDDLE] - far) < 1e-6);
}

/* On a surface that turns by 5 degrees at every pixel, the edges of 2 pixels are those of
 * 10 degrees, and those of 4 are shut at 15. */
static void edges15_weighs_by_angles(void **state)
{
    (void)state;
    static float depth[COUNT], normals[3 * COUNT], in[COUNT], out[COUNT];
    const double step = 5 * 3.14159265358979 / 180, limit = 15 * 3.14159265358979 / 180;
    fill(depth, 5);
    for (int32_t i = 0; i < COUNT; i++) {
        const double angle = step * (i % SIZE - MIDDLE % SIZE);
        const float n[3] = {(float)sin(angle), 0, (float)cos(angle)};
        memcpy(normals + (ptrdiff_t)3 * i, n, sizeof n);
        in[i] = i % SIZE == MIDDLE % SIZE ? 0 : 1;
    }
    apply_with("edges15", 1, 15, depth, normals, in, out);
    const double e1 = 1 - (1 - cos(step)) / (1 - cos(limit)),
                 e2 = 1 - (1 - cos(2 * step)) / (1 - cos(limit));
    const double own = 1 / (1 + e1), beside = 0.5 * e1 / (1 + e1);
    const double wanted[4] = {own / (1 + e2), beside * (1 + 0.5 * e2) / (1 + e2),
                              0.5 * e2 * own / (1 + e2), 0.5 * e2 * beside / (1 + e2)};
    for (int32_t k = 0; k <= 3; k++) {
        /* 1 - cos of 5 degrees, 0.0038, is known to 6e-8, and counts 29 times. */
        assert_true(fabs(1 - (double)out[MIDDLE + k] - wanted[k]) < 1e-5);
    }
}

/* At the picture's border, all neighbours are on one side, and those 2 and 4 pixels away
 * count less. */
static void edges15_leans_little_to_one_side(void **state)
{
    (void)state;
    static float depth[COUNT], in[COUNT], out[COUNT];
    fill(depth, 5);
    for (int32_t i = 0; i < COUNT; i++)
        in[i] = i % SIZE == 0 ? 0 : 1;
    apply("edges15", 1, depth, in, out);
    const double first = 0.5 / 1.5, second = (first + 0.375) / 1.375;
    const double wanted = (second + 1.0 / 6) / (7.0 / 6);
    assert_true(fabs((double)out[SIZE * (SIZE / 2)] - wanted) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_depth_gives_the_plain_kernel),
        cmocka_unit_test(edges_are_kept),
        cmocka_unit_test(background_is_no_tap),
        cmocka_unit_test(slopes_are_followed),
        cmocka_unit_test(faces_that_meet_are_kept_apart),
        cmocka_unit_test(non_finite_values_count_as_open),
        cmocka_unit_test(edges15_takes_little_of_what_is_unlike),
        cmocka_unit_test(edges15_bridges_gaps),
        cmocka_unit_test(edges15_weighs_by_angles),
        cmocka_unit_test(edges15_leans_little_to_one_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
