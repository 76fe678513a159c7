/* SPDX-License-Identifier: MIT */
/*
 * Runs on a device that take several submissions: the same picture, the host is told how
 * far they are, and ends them. Only a device that is a CPU has runs that are long enough
 * at this size. Exit code 77: there is none.
 */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "crevice/vulkan.h"

/* 2048 points of 4096 in a dispatch, for 96 of these rows: four pieces. */
enum { WIDTH = 160, HEIGHT = 128, GUARD = 3, PIECES = 4 };
enum { RESULT_WIDTH = WIDTH - 2 * GUARD, RESULT_HEIGHT = HEIGHT - 2 * GUARD };

typedef struct listener {
    int32_t calls, stop_at; /* the call that ends the run, from 1; 0: none */
    int32_t done, total;    /* of the last call */
} listener;

static int32_t listen(void *user, int32_t done, int32_t total)
{
    listener *l = user;
    l->calls++;
    assert_true(done > l->done && done < total);
    assert_true(l->calls == 1 || total == l->total);
    l->done = done;
    l->total = total;
    return l->calls == l->stop_at;
}

typedef struct frame {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_plan *plan;
    float pixels[RESULT_WIDTH * RESULT_HEIGHT];
} frame;

static void close_frame(frame *f)
{
    crv_plan_destroy(f->plan);
    crv_gbuffer_destroy(f->gbuffer);
    crv_context_destroy(f->context);
    free(f);
}

/* Three spheres, many points, and a filter that reads the guard band. */
static frame *open_frame(crv_device device, listener *l, crv_vulkan_depth_layout layout)
{
    const double scale[] = {1};
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1.0F);
    fixture scene = fixture_make(fixture_spheres, scale, &camera, WIDTH, HEIGHT);
    frame *f = calloc(1, sizeof *f);
    assert_non_null(f);
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = fixture_strict_logger();
    desc.exact = 1;
    desc.device = device;
    desc.progress = (crv_progress){.fn = l ? listen : NULL, .user = l};
    assert_int_equal(crv_context_create(&desc, &f->context), CRV_OK);
    if (device == CRV_DEVICE_VULKAN)
        assert_int_equal(
            crv_vulkan_context_set_plans(f->context, layout, CRV_VULKAN_HALF_OFF),
            CRV_OK);
    crv_options options = fixture_options("ssao");
    options.samples = 4096;
    options.filter = crv_filter_find("box4");
    crv_gbuffer_desc size;
    crv_gbuffer_desc_init(&size, sizeof size, WIDTH, HEIGHT);
    size.guard_left = size.guard_top = size.guard_right = size.guard_bottom = GUARD;
    assert_int_equal(crv_gbuffer_create(f->context, &size, &f->gbuffer), CRV_OK);
    assert_int_equal(crv_plan_create(f->context, &options, &size, &f->plan), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(f->gbuffer, &scene.camera), CRV_OK);
    const crv_const_image depth = crv_const_image_packed(scene.depth, WIDTH, HEIGHT, 1);
    assert_int_equal(crv_gbuffer_set_depth(f->gbuffer, 0, &depth, NULL), CRV_OK);
    fixture_free(&scene);
    return f;
}

static crv_status run(frame *f)
{
    const crv_image result = crv_image_packed(f->pixels, RESULT_WIDTH, RESULT_HEIGHT, 1);
    return crv_plan_run(f->plan, f->gbuffer, &result);
}

static void pieces_make_one_picture(void **state)
{
    (void)state;
    frame *expected = open_frame(CRV_DEVICE_CPU, NULL, CRV_VULKAN_DEPTH_LINEAR);
    assert_int_equal(run(expected), CRV_OK);
    for (int layout = CRV_VULKAN_DEPTH_LINEAR; layout <= CRV_VULKAN_DEPTH_DEINTERLEAVED;
         layout++) {
        listener l = {.calls = 0};
        frame *f = open_frame(CRV_DEVICE_VULKAN, &l, (crv_vulkan_depth_layout)layout);
        assert_int_equal(run(f), CRV_OK);
        assert_int_equal(l.calls, PIECES - 1);
        assert_int_equal(l.total, PIECES);
        /* As test_vulkan_agreement: a sample at the border of two texels moves one place
         * in 4096, far below the tolerance. */
        for (int i = 0; i < RESULT_WIDTH * RESULT_HEIGHT; i++)
            assert_true(fabsf(f->pixels[i] - expected->pixels[i]) <= 2e-3F);
        close_frame(f);
    }
    close_frame(expected);
}

/* The processor's time of all threads, the emulated device's among them: a busy machine
 * does not change it. The first piece is 96 of 128 rows with half of the points. */
static void the_host_ends_a_run(void **state)
{
    (void)state;
    listener l = {.calls = 0};
    frame *f = open_frame(CRV_DEVICE_VULKAN, &l, CRV_VULKAN_DEPTH_LINEAR);
    const clock_t start = clock();
    assert_int_equal(run(f), CRV_OK);
    const clock_t whole = clock() - start;
    float *kept = malloc(sizeof f->pixels);
    assert_non_null(kept);
    memcpy(kept, f->pixels, sizeof f->pixels);
    l = (listener){.stop_at = 1};
    const clock_t again = clock();
    assert_int_equal(run(f), CRV_ERROR_STOPPED);
    const clock_t stopped = clock() - again;
    print_message("whole: %.2f s, stopped: %.2f s\n", (double)whole / CLOCKS_PER_SEC,
                  (double)stopped / CLOCKS_PER_SEC);
    assert_int_equal(l.calls, 1);
    assert_true((double)stopped < 0.7 * (double)whole);
    assert_memory_equal(kept, f->pixels, sizeof f->pixels); /* outputs are untouched */
    crv_device_time times[CRV_MAX_DEVICE_TIMES];
    int32_t count = 0;
    l = (listener){.calls = 0};
    assert_int_equal(run(f), CRV_OK);
    assert_memory_equal(kept, f->pixels, sizeof f->pixels);
    assert_int_equal(crv_plan_device_times(f->plan, times, &count), CRV_OK);
    assert_int_equal(count, 4); /* upload, ssao, box4, download */
    free(kept);
    close_frame(f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_make_one_picture),
        cmocka_unit_test(the_host_ends_a_run),
    };
    crv_device_info info;
    if (crv_vulkan_device_info(0, &info, NULL) != CRV_OK || info.missing[0]
        || !info.software) {
        printf("SKIPPED: no Vulkan device that is a CPU\n");
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
