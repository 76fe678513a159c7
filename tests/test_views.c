/* SPDX-License-Identifier: MIT */
/* The eyes of stereo frames, by names of channels and of parts. */
#include "passes/views.h"
#include "test_io_support.h"

enum { SIZE = 2 };

/* The depth that a view gets: each channel holds another constant. */
static float depth_of(const char *path, const char *view, bool *has_normals)
{
    io_passes_request request = {
        .depth_format = crv_depth_format_planar(),
        .vfov_rad = 1.0f,
        .view = view,
        .views = "left,right",
    };
    io_frame frame;
    if (io_frame_load(path, &request, &frame, support_logger()))
        fail_msg("%s", support_lines.error);
    const float *depth = frame.depth[0].data;
    const float value = depth[0];
    /* Found, whether they are unit vectors or not. */
    *has_normals = strstr(support_lines.text, "normals: \"VL.Normal.right\"");
    io_frame_free(&frame);
    support_forget();
    return value;
}

/* Channel i holds i + 1 everywhere. */
static void make(const char *path, const char *const *names, int count)
{
    float values[16][SIZE * SIZE];
    const float *planes[16];
    for (int c = 0; c < count; c++) {
        for (int i = 0; i < SIZE * SIZE; i++)
            values[c][i] = (float)(c + 1);
        planes[c] = values[c];
    }
    support_make_plain_exr(path, names, count, SIZE, SIZE, planes);
}

static void expect(const char *path, const char *view, float depth, bool normals)
{
    bool has_normals;
    const float value = depth_of(path, view, &has_normals);
    if (value < depth || value > depth)
        fail_msg("%s: depth %g, not %g", view, (double)value, (double)depth);
    assert_int_equal(has_normals, normals);
}

/* Blender's names; normals of the other eye are none. */
static void test_pieces(void **state)
{
    static const char *const names[] = {"VL.Depth.left.Z", "VL.Depth.right.Z",
                                        "VL.Normal.right.X", "VL.Normal.right.Y",
                                        "VL.Normal.right.Z"};
    const char *path = support_path("pieces.exr");
    (void)state;
    make(path, names, 5);
    expect(path, "left", 1.0f, false);
    expect(path, "right", 2.0f, true);
}

/* The default view has no name; a layer may be called like a view's beginning. */
static void test_default(void **state)
{
    static const char *const names[] = {"Z", "right.Z", "lefty.R"};
    const char *path = support_path("default.exr");
    (void)state;
    make(path, names, 3);
    expect(path, "left", 1.0f, false);
    expect(path, "right", 2.0f, false);
}

static support_part eye(const char *name, const char *view)
{
    return (support_part){.name = name,
                          .view = view,
                          .storage = EXR_STORAGE_SCANLINE,
                          .compression = EXR_COMPRESSION_ZIP,
                          .width = SIZE,
                          .height = SIZE,
                          .channel_count = 1,
                          .channels = {"Z"},
                          .types = {EXR_PIXEL_FLOAT}};
}

/* What a part says of its view counts, whatever it is called. support_value() is 0 at
 * the first pixel of the first part and 307 in the second. */
static void test_parts(void **state)
{
    const support_part parts[] = {eye("a.right", "left"), eye("b", "right")};
    const char *path = support_path("parts.exr");
    io_image probed;
    (void)state;
    support_make_exr(path, parts, 2, NULL, NULL, NULL);
    assert_int_equal(io_probe(path, &probed, support_logger()), 0);
    assert_string_equal(probed.channels[0].view, "left");
    assert_string_equal(probed.channels[1].view, "right");
    char plain[IO_NAME_SIZE];
    assert_false(io_channel_is_of_view(&probed.channels[0], "right", plain));
    assert_true(io_channel_is_of_view(&probed.channels[1], "right", plain));
    assert_string_equal(plain, "b.Z");
    io_image_free(&probed);
    expect(path, "right", 307.0f, false);
}

static void test_missing(void **state)
{
    static const char *const mono[] = {"Z"}, *const half[] = {"Z.left.Z", "Z.left.A"};
    const char *path = support_path("mono.exr");
    io_frame frame;
    io_passes_request request = {.depth_format = crv_depth_format_planar(),
                                 .vfov_rad = 1.0f,
                                 .view = "right",
                                 .views = "left,right"};
    (void)state;
    make(path, mono, 1);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "has no view \"right\" nor any of the others");
    make(path, half, 2);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "has no view \"right\"; choose");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pieces), cmocka_unit_test(test_default),
        cmocka_unit_test(test_parts), cmocka_unit_test(test_missing)};
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}
