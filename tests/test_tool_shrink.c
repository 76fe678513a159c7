/* SPDX-License-Identifier: MIT */
/* Results of frames rendered larger, or that are a part of their picture, by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "frame_facts.h"
#include "shrink.h"

/* A frame of one depth layer, whose pixels the caller owns. */
static io_frame make_frame(float *depth, int32_t width, int32_t height)
{
    io_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.image.width = frame.image.display_width = width;
    frame.image.height = frame.image.display_height = height;
    frame.depth[0].data = depth;
    return frame;
}

static io_image make_ao(const io_frame *frame, const float *values, int32_t width,
                        int32_t height)
{
    static const char *const names[] = {"AO"};
    io_image ao;
    assert_int_equal(io_image_init(&ao, width, height, names, 1, NULL), 0);
    memcpy(ao.channels[0].data, values, (size_t)(width * height) * sizeof(float));
    ao.display_width = frame->image.display_width;
    ao.display_height = frame->image.display_height;
    return ao;
}

static void expect(const io_image *ao, const float *expected, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (ao->channels[0].data[i] < expected[i]
            || ao->channels[0].data[i] > expected[i])
            fail_msg("pixel %d is %g, not %g", i, (double)ao->channels[0].data[i],
                     (double)expected[i]);
}

/* Background does not count, and is 1 if there is nothing else. Sums of quarters are
 * exact. */
static void test_coverage(void **state)
{
    float depth[4 * 2] = {1, 1, 1, INFINITY, 1, 1, INFINITY, INFINITY};
    const float values[4 * 2] = {0.0f, 1.0f, 0.25f, 1.0f, 0.5f, 0.5f, 1.0f, 1.0f};
    io_frame frame = make_frame(depth, 4, 2);
    io_image ao = make_ao(&frame, values, 4, 2);
    report r;
    (void)state;
    report_init(&r);
    assert_int_equal(shrink(&frame, 2, &ao, &r), EXIT_DONE);
    assert_int_equal(ao.width, 2);
    assert_int_equal(ao.height, 1);
    assert_int_equal(ao.display_width, 2);
    expect(&ao, (const float[]){0.5f, 0.25f}, 2);
    io_image_free(&ao);
    depth[2] = INFINITY;
    ao = make_ao(&frame, values, 4, 2);
    assert_int_equal(shrink(&frame, 2, &ao, &r), EXIT_DONE);
    expect(&ao, (const float[]){0.5f, 1.0f}, 2);
    io_image_free(&ao);
}

/* Blocks lie in the display window: overscan of one pixel is half a block of its own. */
static void test_overscan(void **state)
{
    float depth[4] = {1, 1, 1, 1};
    const float values[4] = {0.25f, 0.5f, 1.0f, 0.75f};
    io_frame frame = make_frame(depth, 4, 1);
    report r;
    (void)state;
    report_init(&r);
    frame.image.display_width = frame.image.display_height = 2;
    frame.image.data_x = -1;
    io_image ao = make_ao(&frame, values, 4, 1);
    ao.data_x = -1;
    assert_int_equal(shrink(&frame, 2, &ao, &r), EXIT_DONE);
    assert_int_equal(ao.data_x, -1);
    assert_int_equal(ao.width, 3);
    expect(&ao, (const float[]){0.25f, 0.75f, 0.75f}, 3);
    io_image_free(&ao);
}

/* The result lacks the guard band, whose depths are in front of its own. */
static void test_guard_band(void **state)
{
    float depth[4] = {INFINITY, 1, INFINITY, 1};
    const float values[2] = {0.25f, 0.75f};
    io_frame frame = make_frame(depth, 4, 1);
    report r;
    (void)state;
    report_init(&r);
    frame.desc.guard_left = frame.desc.guard_right = 1;
    frame.image.display_width = 2;
    frame.image.data_x = -1;
    io_image ao = make_ao(&frame, values, 2, 1);
    assert_int_equal(shrink(&frame, 2, &ao, &r), EXIT_DONE);
    assert_int_equal(ao.width, 1);
    expect(&ao, (const float[]){0.25f}, 1);
    io_image_free(&ao);
}

/* Means of bent normals are directions again; without a surface there is none. */
static void test_bent_normals(void **state)
{
    static const char *const names[] = {"AO", "bent.X", "bent.Y", "bent.Z"};
    float depth[6] = {1, 1, INFINITY, 1, INFINITY, INFINITY};
    const float half = sqrtf(0.5f), values[4][6] = {{0.25f, 0.75f, 1, 0.5f, 1, 1},
                                                    {1, 0, 9, 0, 0, 0},
                                                    {0, 1, 0, 0, 0, 0},
                                                    {0, 0, 0, 1, 0, 0}};
    const float expected[4][3] = {
        {0.5f, 0.5f, 1.0f}, {half, 0, 0}, {half, 0, 0}, {0, 1, 0}};
    io_frame frame = make_frame(depth, 6, 1);
    io_image ao;
    report r;
    (void)state;
    report_init(&r);
    assert_int_equal(io_image_init(&ao, 6, 1, names, 4, NULL), 0);
    memcpy(ao.channels[0].data, values, sizeof values); /* channels lie in a row */
    ao.display_width = 6;
    ao.display_height = 2;
    assert_int_equal(shrink(&frame, 2, &ao, &r), EXIT_DONE);
    assert_int_equal(ao.channel_count, 4);
    for (int32_t k = 0; k < 4; k++) {
        assert_string_equal(ao.channels[k].name, names[k]);
        for (int i = 0; i < 3; i++)
            assert_float_equal(ao.channels[k].data[i], expected[k][i], 1e-7f);
    }
    io_image_free(&ao);
}

/* A picture of the display window is open beside the data window, and still says how it
 * was made, which --skip-existing reads. */
static void test_fill_display(void **state)
{
    const float values[2] = {0.25f, 0.5f};
    float depth[2] = {1, 1};
    io_frame frame = make_frame(depth, 2, 1);
    report r;
    (void)state;
    report_init(&r);
    io_image ao = make_ao(&frame, values, 2, 1);
    ao.data_x = 1;
    ao.display_width = 4;
    snprintf(ao.made, sizeof ao.made, "by hand");
    assert_int_equal(facts_fill_display(&ao, &r), EXIT_DONE);
    assert_int_equal(ao.width, 4);
    expect(&ao, (const float[]){1.0f, 0.25f, 0.5f, 1.0f}, 4);
    assert_string_equal(ao.made, "by hand");
    io_image_free(&ao);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coverage), cmocka_unit_test(test_overscan),
        cmocka_unit_test(test_guard_band), cmocka_unit_test(test_bent_normals),
        cmocka_unit_test(test_fill_display)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
