/* SPDX-License-Identifier: MIT */
/* A plan with new options computes what a new plan with them computes, to the bit. */
#include "fixture.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum {
    WIDTH = 61,
    HEIGHT = 45,
    GUARD = 8,
    SIZE = (WIDTH - 2 * GUARD) * (HEIGHT - 2 * GUARD)
};

typedef struct world {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_gbuffer_desc desc;
    fixture f;
    char line[512];
} world;

static void keep_line(void *user, crv_log_level level, const char *line)
{
    if (level == CRV_LOG_ERROR)
        snprintf(user, 512, "%s", line);
}

static void open_world(world *w, int32_t exact)
{
    static const double ONE = 1;
    crv_context_desc hooks;
    crv_context_desc_init(&hooks, sizeof hooks);
    hooks.exact = exact;
    hooks.logger = (crv_logger){.fn = keep_line, .user = w->line};
    crv_gbuffer_desc_init(&w->desc, sizeof w->desc, WIDTH, HEIGHT);
    w->desc.guard_left = w->desc.guard_right = GUARD;
    w->desc.guard_top = w->desc.guard_bottom = GUARD;
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    w->f = fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT);
    const crv_const_image depth = crv_const_image_packed(w->f.depth, WIDTH, HEIGHT, 1);
    const crv_const_image normals =
        crv_const_image_packed(w->f.normals, WIDTH, HEIGHT, 3);
    assert_int_equal(crv_context_create(&hooks, &w->context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(w->context, &w->desc, &w->gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(w->gbuffer, &camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(w->gbuffer, 0, &depth, NULL), CRV_OK);
    assert_int_equal(crv_gbuffer_set_normals(w->gbuffer, &normals, CRV_NORMAL_VIEW),
                     CRV_OK);
}

static void close_world(world *w)
{
    crv_gbuffer_destroy(w->gbuffer);
    crv_context_destroy(w->context);
    fixture_free(&w->f);
}

static void run(const world *w, crv_plan *plan, float *pixels)
{
    const crv_image result =
        crv_image_packed(pixels, WIDTH - 2 * GUARD, HEIGHT - 2 * GUARD, 1);
    assert_int_equal(crv_plan_run(plan, w->gbuffer, &result), CRV_OK);
}

static void run_new(const world *w, const crv_options *options, float *pixels)
{
    crv_plan *plan = NULL;
    assert_int_equal(crv_plan_create(w->context, options, &w->desc, &plan), CRV_OK);
    run(w, plan, pixels);
    crv_plan_destroy(plan);
}

/* Another value of the option that takes no more memory. */
static void change(crv_options *options, const crv_option *option)
{
    const double now = crv_options_get(options, option);
    char text[64];
    if (option->type == CRV_OPTION_CHOICE)
        snprintf(text, sizeof text, "%s",
                 option->choices[now < option->max ? (int)now + 1 : 0]);
    else if (option->type == CRV_OPTION_BOOL)
        snprintf(text, sizeof text, "%d", now == 0);
    else if (option->type == CRV_OPTION_INT)
        snprintf(text, sizeof text, "%d",
                 now > option->min ? (int)now / 2 : (int)now + 1);
    else if (now == 0)
        snprintf(text, sizeof text, "%.9g", option->max < 7 ? option->max / 2 : 7);
    else
        snprintf(text, sizeof text, "%.9g",
                 now * 0.7 >= option->min ? now * 0.7 : now * 1.3);
    assert_int_equal(crv_options_set(options, option->key, text, NULL), CRV_OK);
}

/* Fewer samples may want the tables of deinterleaved kernels, which the plan lacks. */
static bool may_want_tables(const crv_option *option)
{
    return strcmp(option->key, "directions") == 0 || strcmp(option->key, "steps") == 0
           || strcmp(option->key, "samples") == 0;
}

static void check_option(const world *w, const crv_options *first, int32_t exact,
                         const crv_option *option)
{
    float before[SIZE], changed[SIZE], expected[SIZE], after[SIZE];
    crv_options next = *first;
    change(&next, option);
    crv_plan *plan = NULL;
    assert_int_equal(crv_plan_create(w->context, first, &w->desc, &plan), CRV_OK);
    run(w, plan, before);
    const crv_status status = crv_plan_set_options(plan, &next);
    if (strcmp(option->key, "noise_size") == 0 || strcmp(option->key, "bent_normal") == 0
        || (status == CRV_ERROR_UNSUPPORTED && !exact && may_want_tables(option))) {
        assert_int_equal(status, CRV_ERROR_UNSUPPORTED);
        assert_non_null(strstr(w->line, option->key));
        run(w, plan, after);
        assert_memory_equal(before, after, sizeof before);
        crv_plan_destroy(plan);
        return;
    }
    if (status)
        print_error("%s %s: %s\n", first->method->name, option->key, w->line);
    assert_int_equal(status, CRV_OK);
    run(w, plan, changed);
    run_new(w, &next, expected);
    if (memcmp(changed, expected, sizeof changed) != 0)
        print_error("%s %s\n", first->method->name, option->key);
    assert_memory_equal(changed, expected, sizeof changed);
    assert_int_equal(crv_plan_set_options(plan, first), CRV_OK);
    run(w, plan, after);
    assert_memory_equal(before, after, sizeof before);
    crv_plan_destroy(plan);
}

static void every_option_of_every_method(void **state)
{
    (void)state;
    for (int32_t exact = 0; exact < 2; exact++) {
        world w = {.line = ""};
        open_world(&w, exact);
        for (int32_t m = 0; m < crv_method_count(); m++) {
            const crv_options first = fixture_options(crv_method_at(m)->name);
            for (int32_t i = 0; i < crv_option_count(); i++) {
                if (crv_option_applies(crv_option_at(i), first.method, first.filter))
                    check_option(&w, &first, exact, crv_option_at(i));
            }
        }
        close_world(&w);
    }
}

static void what_needs_memory_is_named(void **state)
{
    (void)state;
    static const struct {
        const char *method, *key, *value;
    } CASES[] = {
        {"hbao", "method", "vao"},   {"hbao", "filter", "none"},
        {"hbao", "noise_size", "5"}, {"hbao", "directions", "200"},
        {"vao", "samples", "4000"},
    };
    world w = {.line = ""};
    open_world(&w, 1);
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        const crv_options first = fixture_options(CASES[i].method);
        crv_options next = first;
        crv_plan *plan = NULL;
        assert_int_equal(crv_plan_create(w.context, &first, &w.desc, &plan), CRV_OK);
        assert_int_equal(crv_options_set(&next, CASES[i].key, CASES[i].value, NULL),
                         CRV_OK);
        w.line[0] = 0;
        assert_int_equal(crv_plan_set_options(plan, &next), CRV_ERROR_UNSUPPORTED);
        assert_non_null(strstr(w.line, CASES[i].key));
        crv_plan_destroy(plan);
    }
    crv_plan *plan = NULL;
    crv_options options = fixture_options(NULL);
    assert_int_equal(crv_plan_create(w.context, &options, &w.desc, &plan), CRV_OK);
    options.radius = -1;
    assert_int_equal(crv_plan_set_options(plan, &options), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_plan_set_options(plan, NULL), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_plan_set_options(NULL, &options), CRV_ERROR_INVALID_ARGUMENT);
    /* Destroyed too early, the context stays, and says so. */
    w.line[0] = 0;
    crv_context_destroy(w.context);
    assert_non_null(strstr(w.line, "destroy them first"));
    crv_plan_destroy(plan);
    close_world(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_option_of_every_method),
        cmocka_unit_test(what_needs_memory_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
