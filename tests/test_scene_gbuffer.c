/* SPDX-License-Identifier: MIT */
#include "test_scene_support.h"

#include <string.h>

enum { WIDTH = 120, HEIGHT = 67 };

static scene_gbuffer_request courtyard_request(scene **s)
{
    scene_view view;
    assert_int_equal(scene_builtin("courtyard", s, NULL), 0);
    scene_frame(*s, 0.8f, (float)WIDTH / HEIGHT, &view);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    request.layers = 2;
    return request;
}

static void assert_same_pixels(const scene_gbuffer *a, int32_t x_a, int32_t y_a,
                               const scene_gbuffer *b)
{
    for (int32_t y = 0; y < b->desc.height; y++) {
        size_t from = (size_t)(y + y_a) * (size_t)a->desc.width + (size_t)x_a;
        size_t to = (size_t)y * (size_t)b->desc.width, count = (size_t)b->desc.width;
        for (int32_t layer = 0; layer < b->desc.layers; layer++)
            assert_memory_equal(a->depth[layer] + from, b->depth[layer] + to, 4 * count);
        assert_memory_equal(a->normals + 3 * from, b->normals + 3 * to, 12 * count);
        assert_memory_equal(a->albedo + 3 * from, b->albedo + 3 * to, 12 * count);
    }
}

static void check_guard_band(crv_projection projection)
{
    scene *s = NULL;
    scene_gbuffer_request request = courtyard_request(&s);
    request.view.projection = projection;
    scene_gbuffer plain = render(s, &request);
    request.guard_px = 13;
    scene_gbuffer banded = render(s, &request);
    assert_int_equal(banded.desc.width, WIDTH + 26);
    assert_int_equal(banded.desc.height, HEIGHT + 26);
    assert_int_equal(banded.desc.guard_left, 13);
    assert_int_equal(banded.desc.guard_bottom, 13);
    assert_same_pixels(&banded, 13, 13, &plain);
    scene_gbuffer_free(&plain);
    scene_gbuffer_free(&banded);
    scene_free(s);
}

static void test_guard_band_widens(void **state)
{
    (void)state;
    check_guard_band(CRV_PERSPECTIVE);
    check_guard_band(CRV_ORTHOGRAPHIC);
}

static void test_threads_do_not_matter(void **state)
{
    scene *s = NULL;
    scene_gbuffer_request request = courtyard_request(&s);
    scene_gbuffer many;
    (void)state;
    request.threads = 1;
    scene_gbuffer one = render(s, &request);
    for (int32_t threads = 2; threads <= 7; threads += 5) {
        request.threads = threads;
        many = render(s, &request);
        assert_same_pixels(&many, 0, 0, &one);
        scene_gbuffer_free(&many);
    }
    scene_gbuffer_free(&one);
    scene_free(s);
}

static void test_pixels_are_sound(void **state)
{
    scene *s = NULL;
    scene_gbuffer_request request = courtyard_request(&s);
    scene_gbuffer g = render(s, &request);
    int background = 0, cut = 0;
    (void)state;
    for (int32_t pixel = 0; pixel < WIDTH * HEIGHT; pixel++) {
        const float *n = g.normals + 3 * pixel, *a = g.albedo + 3 * pixel;
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (isinf(g.depth[0][pixel])) {
            background++;
            assert_true(length == 0.0f && a[0] == 0.0f);
            continue;
        }
        cut++;
        assert_true(g.depth[0][pixel] > 0.0f);
        assert_true(fabsf(length - 1.0f) < 1e-6f);
        assert_true(a[0] > 0.0f && a[0] <= 1.0f && a[1] > 0.0f && a[2] > 0.0f);
    }
    /* The scene shows sky and fills the rest of the picture. */
    assert_true(background > WIDTH * HEIGHT / 10 && cut > WIDTH * HEIGHT / 2);
    scene_gbuffer_free(&g);
    scene_free(s);
}

static void refuse(const scene *s, const scene_gbuffer_request *request)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene_gbuffer g;
    memset(&g, 0x5a, sizeof g);
    assert_int_equal(scene_render_gbuffer(s, request, &g, &log), -1);
    assert_error_line(&m, "view");
}

static void test_refuses_sizes(void **state)
{
    scene *s = NULL;
    const scene_gbuffer_request good = courtyard_request(&s);
    scene_gbuffer_request bad;
    (void)state;
    static const int32_t sizes[][3] = {
        {0, 10, 0}, {10, 0, 0},           {-1, 10, 0},       {CRV_MAX_SIZE + 1, 1, 0},
        {1, 1, -1}, {CRV_MAX_SIZE, 1, 1}, {INT32_MAX, 1, 0}, {1, 1, INT32_MAX}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        bad = good;
        bad.width = sizes[i][0];
        bad.height = sizes[i][1];
        bad.guard_px = sizes[i][2];
        refuse(s, &bad);
    }
    static const int32_t counts[][2] = {{0, 0}, {5, 0}, {-1, 0}, {1, -1}, {1, 5000}};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        bad = good;
        bad.layers = counts[i][0];
        bad.threads = counts[i][1];
        refuse(s, &bad);
    }
    scene_free(s);
}

static void test_refuses_views(void **state)
{
    static const float angles[] = {0.0f, -1.0f, 3.1416f, NAN, INFINITY, 1e-42f};
    static const float heights[] = {0.0f, -1.0f, NAN, INFINITY};
    scene *s = NULL;
    const scene_gbuffer_request good = courtyard_request(&s);
    scene_gbuffer_request bad;
    (void)state;
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        bad = good;
        bad.view.vfov_rad = angles[i];
        refuse(s, &bad);
    }
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        bad = good;
        bad.view.projection = CRV_ORTHOGRAPHIC;
        bad.view.view_height = heights[i];
        refuse(s, &bad);
    }
    bad = good;
    memcpy(bad.view.eye, bad.view.target, sizeof bad.view.eye);
    refuse(s, &bad);
    bad = good;
    for (int i = 0; i < 3; i++)
        bad.view.up[i] = 2.0 * (bad.view.eye[i] - bad.view.target[i]);
    refuse(s, &bad);
    bad = good;
    bad.view.eye[1] = (double)NAN;
    refuse(s, &bad);
    scene_free(s);
}

static void test_upload(void **state)
{
    scene *s = NULL;
    scene_gbuffer_request request = courtyard_request(&s);
    crv_context *context = NULL;
    crv_gbuffer *buffer = NULL;
    static float depth[WIDTH * HEIGHT];
    crv_image image = crv_image_packed(depth, WIDTH, HEIGHT, 1);
    (void)state;
    request.width -= 10;
    request.height -= 10;
    request.guard_px = 5;
    scene_gbuffer g = render(s, &request);
    assert_int_equal(crv_context_create(NULL, &context), CRV_OK);
    /* Made the first time, refilled the second. */
    for (int round = 0; round < 2; round++) {
        crv_gbuffer *before = buffer;
        assert_int_equal(scene_gbuffer_upload(&g, context, &buffer), CRV_OK);
        assert_true(round == 0 || buffer == before);
        for (int32_t layer = 0; layer < 2; layer++) {
            assert_int_equal(crv_gbuffer_get_depth(buffer, layer, &image), CRV_OK);
            assert_memory_equal(depth, g.depth[layer], sizeof depth);
        }
    }
    crv_gbuffer_destroy(buffer);
    crv_context_destroy(context);
    scene_gbuffer_free(&g);
    assert_null(g.normals);
    scene_gbuffer_free(&g);
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_guard_band_widens),
                                       cmocka_unit_test(test_threads_do_not_matter),
                                       cmocka_unit_test(test_pixels_are_sound),
                                       cmocka_unit_test(test_refuses_sizes),
                                       cmocka_unit_test(test_refuses_views),
                                       cmocka_unit_test(test_upload)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
