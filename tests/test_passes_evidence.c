/* SPDX-License-Identifier: MIT */
/*
 * What a frame is taken for: camera, field of view and normals. The scene is written in
 * every way that renderers write such frames; the G-buffer must be the true one or the
 * line must say what contradicts.
 */
#include "passes_scene.h"

/* A level camera over a floor: most normals are the same in world and in view space. */
static void test_level_camera(void **state)
{
    (void)state;
    static const double heights[] = {1.2, 1.04}; /* level, and 2 degrees down */
    const double from[3] = {3.1, 1.2, 1.2};
    for (int k = 0; k < 2; k++)
        for (int kind = 0; kind < 3; kind++) {
            const double at[3] = {0.1, heights[k], -1.8};
            const window w = centred(60);
            const io_passes_request request = request_of(kind == 1 ? 0.0 : 60.0);
            io_camera_metadata camera;
            io_frame frame;
            look(from, at);
            trace(&w);
            fill_metadata(&w, false, &camera);
            for (int i = 0; i < PIXELS; i++)
                planes[0][i] = (float)(isfinite(depth[i]) ? depth[i] : 1e10);
            set_normals(kind == 2 ? view : world, identity);
            load(write_frame(true, kind == 1 ? &camera : NULL), &request, &frame);
            expect_truth(&frame);
            assert_non_null(strstr(support_lines.text,
                                   kind == 0   ? "world space, rotation found"
                                   : kind == 1 ? "world space, rotation from the camera"
                                               : "view space (deviation 0.0"));
            assert_int_equal(support_lines.warnings, 0);
            io_frame_free(&frame);
        }
}

/* Every handedness of view space, and worlds with other axes. */
static void test_flipped_axes(void **state)
{
    (void)state;
    static const double swaps[3][9] = {
        {1, 0, 0, 0, 0, -1, 0, 1, 0},  /* z up */
        {1, 0, 0, 0, 1, 0, 0, 0, -1},  /* left-handed */
        {0, 0, -1, 1, 0, 0, 0, 1, 0}}; /* z up, left-handed */
    const window w = centred(50);
    io_passes_request request = request_of(50);
    io_frame frame;
    make_usual(50);
    for (int flips = 0; flips < 8; flips++) {
        const double m[9] = {flips & 1 ? -1 : 1, 0, 0, 0, flips & 2 ? -1 : 1, 0, 0, 0,
                             flips & 4 ? -1 : 1};
        set_normals(view, m);
        load(write_frame(true, NULL), &request, &frame);
        expect_truth(&frame);
        assert_non_null(
            strstr(support_lines.text, flips == 2 ? "y flipped" : "view space"));
        io_frame_free(&frame);
    }
    io_camera_metadata camera;
    fill_metadata(&w, false, &camera);
    for (int k = 0; k < 3; k++)
        for (int with_camera = 0; with_camera < 2; with_camera++) {
            set_normals(world, swaps[k]);
            load(write_frame(true, with_camera ? &camera : NULL), &request, &frame);
            expect_truth(&frame);
            assert_int_equal(support_lines.warnings, 0);
            io_frame_free(&frame);
        }
    /* Said outright, without a guess. */
    const double green_down[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1};
    set_normals(view, green_down);
    request.normal_space = IO_NORMALS_VIEW;
    request.flip_normals[1] = true;
    load(write_frame(true, NULL), &request, &frame);
    expect_truth(&frame);
    assert_int_equal(support_lines.warnings, 0);
    io_frame_free(&frame);
    request.flip_normals[1] = false;
    load(write_frame(true, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(
        strstr(support_lines.text, "agree with depth as view space, y flipped"));
    io_frame_free(&frame);
}

/* A frame that cannot tell is read as the shot is. */
static void test_undecided_frame(void **state)
{
    (void)state;
    const double from[3] = {0, 2, 0}, at[3] = {2, 2, 2};
    io_passes_request request = request_of(0);
    window w = {-0.4, 0.4, -0.9, -0.4, false}; /* the floor alone */
    io_camera_metadata camera;
    io_frame frame;
    look(from, at);
    trace(&w);
    fill_metadata(&w, false, &camera);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = (float)depth[i];
    set_normals(view, identity);
    const char *path = write_frame(true, &camera);
    load(path, &request, &frame);
    assert_false(frame.reading_decided);
    const int first = frame.reading;
    io_frame_free(&frame);
    /* 2 is view space: what another frame of the shot decided. */
    request.usual_reading = 2;
    load(path, &request, &frame);
    assert_int_equal(frame.reading, 2);
    assert_int_not_equal(first, 0);
    assert_int_equal(frame.normal_space, CRV_NORMAL_VIEW);
    io_frame_free(&frame);
}

/* Off-axis frusta and orthographic views, in both ranges of NDC, with every kind of help.
 */
static void test_ranges_of_ndc(void **state)
{
    (void)state;
    static const window windows[] = {
        {-1.7, 0.6, -1.2, 0.8, false}, /* a wall of a cave */
        {-0.9, 0, 0, 0.6, false},      /* a corner tile */
        {0, 0.9, -0.6, 0, false},      /* the opposite one: its centre lies at 0, 0 */
        {-0.9, 0.9, -0.6, 0.6, false},
        {-3, 3, -2, 2, true}};
    for (size_t k = 0; k < sizeof windows / sizeof windows[0]; k++)
        for (int variant = 0; variant < 8; variant++) {
            const window *w = &windows[k];
            const io_passes_request request = request_of(0);
            io_camera_metadata camera;
            io_frame frame;
            look(usual_eye, usual_target);
            trace(w);
            fill_metadata(w, variant & 1, &camera);
            camera.has_world_to_camera = variant & 2;
            for (int i = 0; i < PIXELS; i++)
                planes[0][i] = (float)(isfinite(depth[i]) ? depth[i] : 1e10);
            set_normals(world, identity);
            load(write_frame(variant & 4, &camera), &request, &frame);
            /* From the definition of the window; single precision. */
            const double fx = W / (w->right - w->left), fy = H / (w->top - w->bottom);
            assert_true(fabs((double)frame.camera.fx_px / fx - 1.0) < 1e-4);
            assert_true(fabs((double)frame.camera.fy_px / fy - 1.0) < 1e-4);
            if (!w->orthographic) {
                assert_true(fabs((double)frame.camera.cx_px + w->left * fx) < 1e-2);
                assert_true(fabs((double)frame.camera.cy_px - w->top * fy) < 1e-2);
            }
            if (variant & 4)
                expect_truth(&frame);
            assert_int_equal(support_lines.warnings, 0);
            io_frame_free(&frame);
        }
}

static void test_identity_is_no_camera(void **state)
{
    (void)state;
    const io_passes_request request = request_of(0);
    io_camera_metadata camera = {.has_world_to_camera = true, .has_world_to_ndc = true};
    io_frame frame;
    for (int i = 0; i < 16; i++)
        camera.world_to_camera[i] = camera.world_to_ndc[i] =
            (float)identity[0] * !(i % 5);
    make_usual(50);
    const char *path = write_frame(false, &camera);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "does not say which camera made it");
}

/* Each part has its own camera: the right eye's depth is not seen by the left one. */
static void test_cameras_of_parts(void **state)
{
    (void)state;
    io_camera_metadata cameras[2];
    const io_passes_request left = {.depth_format = crv_depth_format_planar(),
                                    .depth = "left.Z"};
    const window windows[2] = {{-0.9, 0.9, -0.6, 0.6, false},
                               {-1.2, 0.6, -0.6, 0.6, false}};
    support_part parts[2];
    for (int p = 0; p < 2; p++) {
        look(usual_eye, usual_target);
        fill_metadata(&windows[p], false, &cameras[p]);
        parts[p] = (support_part){.name = p ? "right" : "left",
                                  .storage = EXR_STORAGE_SCANLINE,
                                  .compression = EXR_COMPRESSION_ZIP,
                                  .width = W,
                                  .height = H,
                                  .channel_count = 1,
                                  .channels = {"Z"},
                                  .types = {EXR_PIXEL_FLOAT},
                                  .world_to_ndc = cameras[p].world_to_ndc};
    }
    const char *path = support_path("stereo.exr");
    support_make_exr(path, parts, 2, NULL, NULL, NULL);
    for (int p = 0; p < 2; p++) {
        io_passes_request request = left;
        io_frame frame;
        request.depth = p ? "right.Z" : "left.Z";
        load(path, &request, &frame);
        assert_true(fabs((double)frame.camera.cx_px - (p ? 1.2 : 0.9) * W / 1.8) < 1e-2);
        io_frame_free(&frame);
    }
}

static void test_wrong_field_of_view(void **state)
{
    (void)state;
    const io_passes_request request = request_of(25);
    io_frame frame;
    make_usual(50);
    set_normals(view, identity);
    load(write_frame(true, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    /* The steps of the search are 3.5 %: 50 degrees to within 2. */
    const char *at = strstr(support_lines.text, "field of view were about ");
    assert_non_null(at);
    assert_true(fabs(atof(at + strlen("field of view were about ")) - 50.0) < 2.0);
    io_frame_free(&frame);
}

/* Depth that is upside down, as one of two programs writes it: a rotation that suits most
 * of the floor is found, and the rest says that it is wrong. */
static void test_depth_upside_down(void **state)
{
    (void)state;
    const io_passes_request request = request_of(50);
    io_frame frame;
    make_usual(50);
    set_normals(view, identity);
    const char *path = write_frame(true, NULL);
    load(path, &request, &frame);
    assert_int_equal(support_lines.warnings, 0);
    io_frame_free(&frame);
    for (int y = 0; y < H / 2; y++)
        for (int x = 0; x < W; x++) {
            float *const upper = &planes[0][y * W + x],
                         *const lower = &planes[0][(H - 1 - y) * W + x];
            const float kept = *upper;
            *upper = *lower;
            *lower = kept;
        }
    load(write_frame(true, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    io_frame_free(&frame);
}

static void test_negative_depth(void **state)
{
    (void)state;
    const io_passes_request request = request_of(50);
    io_frame frame;
    make_usual(50);
    set_normals(view, identity);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = -planes[0][i];
    load(write_frame(true, NULL), &request, &frame);
    expect_truth(&frame);
    assert_non_null(strstr(support_lines.text, "negated"));
    io_frame_free(&frame);
}

/* To the nearest of 11 bits. */
static float rounded_to_half(float value)
{
    int exponent;
    const float fraction = frexpf(value, &exponent);
    return ldexpf(roundf(ldexpf(fraction, 11)), exponent - 11);
}

/* Halves in a float channel: no wall may come out rough. */
static void test_halves_in_floats(void **state)
{
    (void)state;
    const io_passes_request request = request_of(40);
    io_frame frame;
    make_usual(40);
    set_normals(view, identity);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = rounded_to_half(planes[0][i]);
    load(write_frame(true, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(strstr(support_lines.text, "half floats"));
    double rough = 0.0;
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float d = *crv_image_at(&frame.depth[0], i % W, i / W, 0);
        if (!isfinite(depth[i]))
            continue;
        /* Half a step of the half float, twice: rounding, and smoothing. */
        assert_true(fabs((double)d - depth[i]) <= depth[i] / 1024.0);
        if (world[1][i] < 0.999 || i % W < 2 || i % W >= W - 2)
            continue;
        /* The floor: 1/d has no second differences along a row. */
        const float a = *crv_image_at(&frame.depth[0], i % W - 1, i / W, 0);
        const float b = *crv_image_at(&frame.depth[0], i % W + 1, i / W, 0);
        if (world[1][i - 1] < 0.999 || world[1][i + 1] < 0.999)
            continue;
        rough += fabs(1.0 / (double)a + 1.0 / (double)b - 2.0 / (double)d) * (double)d;
        count++;
    }
    /* Rounding alone leaves about half a step, 1/4096 of d. */
    assert_true(count > 1000);
    assert_true(rough / count < 1.0 / 4096.0 / 8.0);
    io_frame_free(&frame);
}

/* Under depth of field each pixel is an average of its own few rays. */
static void test_noisy_depth(void **state)
{
    (void)state;
    const io_passes_request request = request_of(50);
    uint32_t seed = 1;
    io_frame frame;
    make_usual(50);
    for (int i = 0; i < PIXELS; i++) {
        seed = seed * 1664525u + 1013904223u;
        planes[0][i] *= 1.0f + 0.01f * ((float)(seed >> 8) / 16777216.0f - 0.5f);
    }
    load(write_frame(false, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(strstr(support_lines.text, "depth is noise"));
    io_frame_free(&frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_level_camera),
        cmocka_unit_test(test_flipped_axes),
        cmocka_unit_test(test_undecided_frame),
        cmocka_unit_test(test_ranges_of_ndc),
        cmocka_unit_test(test_identity_is_no_camera),
        cmocka_unit_test(test_cameras_of_parts),
        cmocka_unit_test(test_wrong_field_of_view),
        cmocka_unit_test(test_depth_upside_down),
        cmocka_unit_test(test_negative_depth),
        cmocka_unit_test(test_halves_in_floats),
        cmocka_unit_test(test_noisy_depth),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}
