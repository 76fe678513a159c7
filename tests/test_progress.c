/* SPDX-License-Identifier: MIT */
/*
 * Runs on the CPU that the host watches and ends: crv_progress is told in order, on the
 * calling thread, and wherever it ends a run, the result is untouched and the next run
 * has the same bits as if nothing had happened.
 */
#include "fixture.h"

#include <stdio.h>
#include <string.h>

enum { WIDTH = 300, HEIGHT = 100, COUNT = WIDTH * HEIGHT };

typedef struct listener {
    int32_t calls, stop_at; /* the call that ends the run, from 1; 0: none */
    int32_t steps;          /* how often `done` began again */
    int32_t done, total;    /* of the last call */
} listener;

static int32_t listen(void *user, int32_t done, int32_t total)
{
    listener *l = user;
    assert_true(done > 0 && done < total);
    l->steps += l->calls == 0 || done <= l->done;
    assert_true(done <= l->done || l->calls == 0 || total == l->total);
    l->calls++;
    l->done = done;
    l->total = total;
    return l->calls == l->stop_at;
}

typedef struct frame {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_gbuffer_desc desc;
} frame;

static frame open_frame(listener *l, int32_t threads, bool exact)
{
    static const double ONE = 1;
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    fixture scene = fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT);
    frame f = {.context = NULL};
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.threads = threads;
    desc.exact = exact;
    desc.logger = fixture_strict_logger();
    desc.progress = (crv_progress){.fn = listen, .user = l};
    assert_int_equal(crv_context_create(&desc, &f.context), CRV_OK);
    crv_gbuffer_desc_init(&f.desc, sizeof f.desc, WIDTH, HEIGHT);
    assert_int_equal(crv_gbuffer_create(f.context, &f.desc, &f.gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(f.gbuffer, &camera), CRV_OK);
    const crv_const_image depth = crv_const_image_packed(scene.depth, WIDTH, HEIGHT, 1);
    assert_int_equal(crv_gbuffer_set_depth(f.gbuffer, 0, &depth, NULL), CRV_OK);
    fixture_free(&scene);
    assert_int_equal(l->calls, 0); /* runs are told of, nothing else */
    return f;
}

static void close_frame(frame *f)
{
    crv_gbuffer_destroy(f->gbuffer);
    crv_context_destroy(f->context);
}

static crv_status run(const frame *f, crv_plan *plan, float *out)
{
    const crv_image image = crv_image_packed(out, WIDTH, HEIGHT, 1);
    return crv_plan_run(plan, f->gbuffer, &image);
}

/* Ends runs of a method at each call in turn. steps: loops of tiles that a run has. */
static void end_everywhere(const char *method, const char *filter, bool exact,
                           int32_t steps)
{
    static float expected[COUNT], out[COUNT], untouched[COUNT];
    listener l = {.calls = 0};
    frame f = open_frame(&l, 1, exact);
    crv_options options = fixture_options(method);
    options.filter = crv_filter_find(filter); /* NULL for "none" alone */
    assert_true(options.filter || strcmp(filter, "none") == 0);
    crv_plan *plan = NULL;
    assert_int_equal(crv_plan_create(f.context, &options, &f.desc, &plan), CRV_OK);
    assert_int_equal(run(&f, plan, expected), CRV_OK);
    const int32_t calls = l.calls;
    printf("%s %s: %d calls in %d steps\n", method, filter, calls, l.steps);
    assert_true(calls >= steps);
    assert_int_equal(l.steps, steps);
    for (int32_t stop_at = 1; stop_at <= calls; stop_at++) {
        memset(out, 0x55, sizeof out);
        memcpy(untouched, out, sizeof out);
        l = (listener){.stop_at = stop_at};
        assert_int_equal(run(&f, plan, out), CRV_ERROR_STOPPED);
        assert_int_equal(l.calls, stop_at);
        assert_memory_equal(out, untouched, sizeof out);
        l = (listener){.stop_at = 0};
        assert_int_equal(run(&f, plan, out), CRV_OK);
        assert_memory_equal(out, expected, sizeof out);
    }
    crv_plan_destroy(plan);
    close_frame(&f);
}

static void a_run_ends_where_the_host_says(void **state)
{
    (void)state;
    end_everywhere("hbao", "bilateral13", false, 2);
    end_everywhere("hbao", "gauss5", true, 2);
    end_everywhere("bitmask", "edges15", false, 3); /* widths, method, filter */
    end_everywhere("raymarch", "none", false, 1);
}

/* Of several threads the one that called tells, and all of them end. */
static void threads_end_together(void **state)
{
    (void)state;
    static float out[COUNT];
    listener l = {.stop_at = 1};
    frame f = open_frame(&l, 2, false);
    crv_options options = fixture_options("raymarch");
    crv_plan *plan = NULL;
    assert_int_equal(crv_plan_create(f.context, &options, &f.desc, &plan), CRV_OK);
    /* The other thread may have taken every tile before this one woke: not for ever. */
    crv_status status = CRV_OK;
    for (int i = 0; i < 1000 && status == CRV_OK; i++)
        status = run(&f, plan, out);
    assert_int_equal(status, CRV_ERROR_STOPPED);
    assert_int_equal(l.calls, 1);
    crv_plan_destroy(plan);
    close_frame(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_run_ends_where_the_host_says),
        cmocka_unit_test(threads_end_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
