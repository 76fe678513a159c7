/* SPDX-License-Identifier: MIT */
/*
 * New options for a plan that exists: what it computes then is what a plan made with them
 * computes, to the bit; where that takes other memory the plan stays as it is.
 */
#include "fixture.h"

#include "core/plan.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, COUNT = WIDTH * HEIGHT };

typedef struct bench {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_gbuffer_desc desc;
} bench;

static bench open_bench(bool exact)
{
    static const double ONE = 1;
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    fixture f = fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT);
    bench b = {0};
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.exact = exact;
    desc.logger = fixture_strict_logger();
    assert_int_equal(crv_context_create(&desc, &b.context), CRV_OK);
    crv_gbuffer_desc_init(&b.desc, sizeof b.desc, WIDTH, HEIGHT);
    assert_int_equal(crv_gbuffer_create(b.context, &b.desc, &b.gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(b.gbuffer, &camera), CRV_OK);
    const crv_const_image depth = crv_const_image_packed(f.depth, WIDTH, HEIGHT, 1);
    assert_int_equal(crv_gbuffer_set_depth(b.gbuffer, 0, &depth, NULL), CRV_OK);
    fixture_free(&f);
    return b;
}

static void close_bench(bench *b)
{
    crv_gbuffer_destroy(b->gbuffer);
    crv_context_destroy(b->context);
}

static crv_plan *make_plan(const bench *b, const crv_options *options)
{
    crv_plan *plan = NULL;
    assert_int_equal(crv_plan_create(b->context, options, &b->desc, &plan), CRV_OK);
    return plan;
}

static void run(const bench *b, crv_plan *plan, float *out)
{
    const crv_image image = crv_image_packed(out, WIDTH, HEIGHT, 1);
    assert_int_equal(crv_plan_run(plan, b->gbuffer, &image), CRV_OK);
}

static void expect_result(const bench *b, crv_plan *plan, const crv_options *options)
{
    static float got[COUNT], expected[COUNT];
    crv_plan *fresh = make_plan(b, options);
    run(b, fresh, expected);
    run(b, plan, got);
    crv_plan_destroy(fresh);
    assert_memory_equal(got, expected, sizeof got);
}

static void set(crv_options *options, const char *key, const char *value)
{
    assert_int_equal(crv_options_set(options, key, value, NULL), CRV_OK);
}

/* With and without the deinterleaved structure. */
static void new_options_are_those_of_a_new_plan(void **state)
{
    (void)state;
    static const char *const CHANGES[][2] = {
        {"radius", "0.4"},    {"falloff", "sqrt"},     {"directions", "2"},
        {"steps", "3"},       {"spacing", "equal"},    {"samples", "6"},
        {"seed", "3"},        {"intensity", "0.5"},    {"contrast", "2"},
        {"filter", "gauss5"}, {"filter_depth", "0.3"}, {"normal_rays", "2"},
        {"thickness", "0.1"}};
    for (int exact = 0; exact < 2; exact++) {
        bench b = open_bench(exact);
        for (int32_t m = 0; m < crv_method_count(); m++) {
            crv_options options = fixture_options(crv_method_at(m)->name);
            options.radius = 0.7f;
            options.directions =
                4; /* of all methods the structure is the same throughout */
            options.filter = crv_filter_find("box4");
            crv_plan *plan = make_plan(&b, &options);
            expect_result(&b, plan, &options);
            for (size_t i = 0; i < sizeof CHANGES / sizeof CHANGES[0]; i++) {
                set(&options, CHANGES[i][0], CHANGES[i][1]);
                assert_true(crv__plan_update(plan, &options));
                expect_result(&b, plan, &options);
            }
            crv_plan_destroy(plan);
        }
        close_bench(&b);
    }
}

static void what_takes_other_memory_is_refused(void **state)
{
    (void)state;
    static const char *const CHANGES[][2] = {{"directions", "64"},
                                             {"noise_size", "8"},
                                             {"filter", "none"},
                                             {"directions", "7"},
                                             {"steps", "64"}};
    bench b = open_bench(false);
    crv_options options = fixture_options("hbao");
    options.radius = 0.7f;
    options.filter = crv_filter_find("box4");
    crv_plan *plan = make_plan(&b, &options);
    for (size_t i = 0; i < sizeof CHANGES / sizeof CHANGES[0]; i++) {
        crv_options other = options;
        set(&other, CHANGES[i][0], CHANGES[i][1]);
        assert_false(crv__plan_update(plan, &other));
        expect_result(&b, plan, &options);
    }
    crv_plan_destroy(plan);

    /* A tile of 8 is computed exactly; a plan made with 4 would be deinterleaved. */
    set(&options, "noise_size", "8");
    plan = make_plan(&b, &options);
    set(&options, "noise_size", "4");
    assert_false(crv__plan_update(plan, &options));
    crv_plan_destroy(plan);
    close_bench(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(new_options_are_those_of_a_new_plan),
        cmocka_unit_test(what_takes_other_memory_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
