/* SPDX-License-Identifier: MIT */
/*
 * Positions instead of depth. A floor and a wall are seen by a known camera; what each
 * pixel sees is known in closed form, and depth and camera must come out as they were.
 */
#include <math.h>

#include "passes/passes.h"
#include "test_io_support.h"

enum { W = 120, H = 80, PIXELS = W * H };

/* Of the view: rows right, up, back. Turned about y, then tilted down. */
static double axes[3][3];
static const double eye[3] = {1.5, 2.0, 4.0};
static double depth[PIXELS]; /* INFINITY: nothing */
static float planes[6][PIXELS];

typedef struct lens {
    double fx, fy, cx, cy;
    bool orthographic;
} lens;

static const lens usual = {100, 100, 60, 40, false}, off_axis = {90, 70, 20, 55, false};
static const lens parallel = {15, 15, 60, 40, true};

static void turn_camera(void)
{
    const double pan = 0.4, tilt = -0.3;
    const double right[3] = {cos(pan), 0, -sin(pan)};
    const double back[3] = {sin(pan) * cos(tilt), -sin(tilt), cos(pan) * cos(tilt)};
    for (int c = 0; c < 3; c++) {
        axes[0][c] = right[c];
        axes[2][c] = back[c];
    }
    for (int c = 0; c < 3; c++)
        axes[1][c] = back[(c + 1) % 3] * right[(c + 2) % 3]
                     - back[(c + 2) % 3] * right[(c + 1) % 3];
}

/* Positions in world or camera space, in planes[0..2]; camera space is mirrored in z if
 * `mirrored`, as the left-handed one of others. `wall`: there is one beside the floor. */
static void see(const lens *l, bool world, bool mirrored, bool wall)
{
    turn_camera();
    for (int i = 0; i < PIXELS; i++) {
        const double x = (i % W + 0.5 - l->cx) / l->fx;
        const double y = -(i / W + 0.5 - l->cy) / l->fy;
        double o[3], d[3], view[3];
        for (int c = 0; c < 3; c++) {
            const double across = x * axes[0][c] + y * axes[1][c];
            o[c] = eye[c] + (l->orthographic ? across : 0.0);
            d[c] = (l->orthographic ? 0.0 : across) - axes[2][c];
        }
        double t = d[1] < 0.0 ? -o[1] / d[1] : INFINITY;
        const double to_wall = (-3.0 - o[2]) / d[2], wall_y = o[1] + to_wall * d[1];
        if (wall && to_wall > 0.0 && to_wall < t && wall_y < 1.5)
            t = to_wall;
        depth[i] = t > 0.0 && t < 40.0 ? t : INFINITY;
        view[0] = l->orthographic ? x : x * t;
        view[1] = l->orthographic ? y : y * t;
        view[2] = mirrored && !world ? t : -t;
        for (int c = 0; c < 3; c++) {
            const double p = world ? o[c] + t * d[c] : view[c];
            planes[c][i] =
                isfinite(depth[i]) ? (float)(mirrored && world && c == 2 ? -p : p) : 0.0f;
        }
    }
}

/* worldToCamera with z along the view, and worldToNDC of a lens, row vectors. */
static void fill_metadata(const lens *l, io_camera_metadata *out)
{
    double m[4][3] = {{0}};
    memset(out, 0, sizeof *out);
    out->has_world_to_camera = out->has_world_to_ndc = true;
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) {
            const double axis = c == 2 ? -axes[2][k] : axes[c][k];
            m[k][c] = axis;
            m[3][c] -= eye[k] * axis;
        }
    for (int r = 0; r < 4; r++) {
        const double w = m[r][2];
        for (int c = 0; c < 3; c++)
            out->world_to_camera[4 * r + c] = (float)m[r][c];
        out->world_to_camera[4 * r + 3] = r == 3 ? 1.0f : 0.0f;
        out->world_to_ndc[4 * r] = (float)((l->fx * m[r][0] + l->cx * w) / W);
        out->world_to_ndc[4 * r + 1] = (float)((-l->fy * m[r][1] + l->cy * w) / H);
        out->world_to_ndc[4 * r + 2] = (float)(w - (r == 3 ? 1.0 : 0.0));
        out->world_to_ndc[4 * r + 3] = (float)w;
    }
}

static const char *const p_names[] = {"P.X", "P.Y", "P.Z"};

static const char *write_planes(const char *const *names, int count,
                                const io_camera_metadata *camera)
{
    const char *path = support_path("positions.exr");
    io_image image;
    assert_int_equal(io_image_init(&image, W, H, names, count, NULL), 0);
    for (int c = 0; c < count; c++)
        memcpy(image.channels[c].data, planes[c], sizeof planes[c]);
    if (camera)
        image.camera = *camera;
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    io_image_free(&image);
    support_forget();
    return path;
}

static io_passes_request plain_request(void)
{
    return (io_passes_request){.depth_format = crv_depth_format_planar()};
}

static void load(const char *path, const io_passes_request *request, io_frame *frame)
{
    if (io_frame_load(path, request, frame, support_logger()))
        fail_msg("%s", support_lines.error);
}

/* Floats of about 10 and a fit over thousands: a part in 10^4 is ample. The depth of an
 * orthographic view is free by a constant. */
static void expect_frame(const io_frame *frame, const lens *l)
{
    double shift = NAN;
    for (int i = 0; i < PIXELS; i++) {
        const double d = (double)*crv_image_at(&frame->depth[0], i % W, i / W, 0);
        assert_int_equal(isfinite(d), isfinite(depth[i]));
        if (!isfinite(d))
            continue;
        if (isnan(shift))
            shift = l->orthographic ? d - depth[i] : 0.0;
        assert_true(fabs(d - shift - depth[i]) < 1e-3 * depth[i]);
    }
    assert_int_equal(frame->camera.projection,
                     l->orthographic ? CRV_ORTHOGRAPHIC : CRV_PERSPECTIVE);
    assert_true(fabs((double)frame->camera.fx_px / l->fx - 1.0) < 1e-4);
    assert_true(fabs((double)frame->camera.fy_px / l->fy - 1.0) < 1e-4);
    if (l->orthographic)
        return;
    assert_true(fabs((double)frame->camera.cx_px - l->cx) < 0.02);
    assert_true(fabs((double)frame->camera.cy_px - l->cy) < 0.02);
}

static void test_camera_and_depth(void **state)
{
    (void)state;
    static const lens *const lenses[] = {&usual, &off_axis, &parallel};
    const io_passes_request request = plain_request();
    for (int i = 0; i < 12; i++) {
        const lens *l = lenses[i / 4];
        const bool world = i & 1, mirrored = i & 2;
        io_frame frame;
        /* A parallel view of a left-handed world is that of a right-handed one that is
         * seen from behind. */
        if (l->orthographic && world && mirrored)
            continue;
        see(l, world, mirrored, true);
        load(write_planes(p_names, 3, NULL), &request, &frame);
        expect_frame(&frame, l);
        assert_int_equal(support_lines.warnings, 0);
        assert_non_null(strstr(support_lines.text, world ? "positions in world space"
                                                         : "positions in camera space"));
        io_frame_free(&frame);
    }
}

/* World normals need no guess: the positions tell how the camera is turned. */
static void test_normals(void **state)
{
    (void)state;
    static const char *const names[] = {"Position.X", "Position.Y", "Position.Z",
                                        "Normal.X",   "Normal.Y",   "Normal.Z"};
    const io_passes_request request = plain_request();
    io_frame frame;
    see(&usual, true, false, true);
    for (int i = 0; i < PIXELS; i++) {
        planes[3][i] = 0.0f;
        planes[4][i] = planes[1][i] < 1e-3f && isfinite(depth[i]) ? 1.0f : 0.0f;
        planes[5][i] = planes[1][i] < 1e-3f || !isfinite(depth[i]) ? 0.0f : 1.0f;
    }
    load(write_planes(names, 6, NULL), &request, &frame);
    expect_frame(&frame, &usual);
    assert_non_null(strstr(support_lines.text,
                           "world space, rotation from the camera (deviation 0.0"));
    for (int i = 0; i < 9; i++)
        assert_true(fabs((double)frame.camera.world_to_view[i] - axes[i / 3][i % 3])
                    < 1e-4);
    io_frame_free(&frame);
}

/* One plane is seen alike by many cameras, unless it is known where they stand. */
static void test_a_plane_alone(void **state)
{
    (void)state;
    io_passes_request request = plain_request();
    io_camera_metadata camera;
    io_frame frame;
    see(&usual, true, false, false);
    const char *path = write_planes(p_names, 3, NULL);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "do not tell which camera saw them");
    request.pose.given = true;
    memcpy(request.pose.to_view, axes, sizeof axes);
    memcpy(request.pose.eye, eye, sizeof eye);
    load(path, &request, &frame);
    expect_frame(&frame, &usual);
    io_frame_free(&frame);
    request = plain_request();
    fill_metadata(&usual, &camera);
    load(write_planes(p_names, 3, &camera), &request, &frame);
    expect_frame(&frame, &usual);
    assert_int_equal(support_lines.warnings, 0);
    io_frame_free(&frame);
    see(&usual, false, false, false);
    load(write_planes(p_names, 3, NULL), &request, &frame);
    expect_frame(&frame, &usual);
    io_frame_free(&frame);
}

/* A frame of a shot may show nothing but sky. */
static void test_nothing_seen(void **state)
{
    (void)state;
    const io_passes_request request = plain_request();
    io_frame frame;
    memset(planes, 0, sizeof planes);
    planes[1][7] = NAN;
    load(write_planes(p_names, 3, NULL), &request, &frame);
    for (int i = 0; i < PIXELS; i++)
        assert_true(!isfinite(*crv_image_at(&frame.depth[0], i % W, i / W, 0)));
    io_frame_free(&frame);
    /* A single position tells no camera. */
    planes[2][PIXELS / 2] = -3.0f;
    const char *path = write_planes(p_names, 3, NULL);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "do not tell which camera saw them");
}

/* What the user says and the positions deny is refused, metadata are told of. */
static void test_contradictions(void **state)
{
    (void)state;
    io_passes_request request = plain_request();
    const lens longer = {120, 120, 60, 40, false};
    io_camera_metadata camera;
    io_frame frame;
    see(&usual, true, false, true);
    fill_metadata(&longer, &camera);
    load(write_planes(p_names, 3, &camera), &request, &frame);
    expect_frame(&frame, &usual);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(strstr(support_lines.text, "that of the positions is taken"));
    io_frame_free(&frame);
    request.vfov_rad = 1.0f; /* of 2 atan(40 / 100) = 0.761 */
    const char *path = write_planes(p_names, 3, NULL);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path,
                         "43.60 degrees, not with a vertical field of view of 57.30");
    request.vfov_rad = 2.0f * atanf(0.4f);
    load(path, &request, &frame);
    assert_int_equal(support_lines.warnings, 0);
    io_frame_free(&frame);
    request.depth_format.encoding = CRV_DEPTH_RADIAL;
    request.encoding_given = true;
    support_forget();
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "positions have no depth encoding");
}

/* Samples lie anywhere in their pixels, a filter mixes some with nothing, and halves are
 * told. */
static void test_roughness(void **state)
{
    (void)state;
    const io_passes_request request = plain_request();
    uint32_t seed = 7;
    io_frame frame;
    see(&usual, true, false, true);
    int outline = 0;
    for (int i = 0; i < PIXELS - W; i++) {
        seed = seed * 1664525u + 1013904223u;
        const float share = (float)(seed >> 8) / 16777216.0f;
        /* Somewhere in the pixel; at the border to nothing, drawn to 0. */
        for (int c = 0; c < 3; c++)
            planes[c][i] += share * (planes[c][i + W] - planes[c][i]);
        outline += isfinite(depth[i]) != isfinite(depth[i + W]);
    }
    assert_true(outline > 10);
    load(write_planes(p_names, 3, NULL), &request, &frame);
    /* Samples lie half a pixel further down, in the mean; far away, where rows are far
     * apart, the mean of two points is seen nearer to the second. */
    assert_true(fabs((double)frame.camera.fy_px / usual.fy - 1.0) < 2e-3);
    assert_true(fabs((double)frame.camera.cy_px - usual.cy + 0.5) < 0.3);
    assert_non_null(strstr(support_lines.text, "are not seen at their pixels"));
    io_frame_free(&frame);
    see(&usual, true, false, true);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++) {
            int exponent;
            const float fraction = frexpf(planes[c][i], &exponent);
            planes[c][i] = ldexpf(roundf(ldexpf(fraction, 11)), exponent - 11);
        }
    load(write_planes(p_names, 3, NULL), &request, &frame);
    assert_true(fabs((double)frame.camera.fy_px / usual.fy - 1.0) < 1e-3);
    assert_non_null(strstr(support_lines.text, "positions hold nothing but half floats"));
    io_frame_free(&frame);
}

/* Depth is taken if there is any, but for a denoiser's; positions by request. */
static void test_choice(void **state)
{
    (void)state;
    static const char *const names[] = {"V.Position.X", "V.Position.Y", "V.Position.Z",
                                        "V.Depth.Z"};
    io_passes_request request = plain_request();
    io_frame frame;
    see(&usual, true, false, true);
    for (int i = 0; i < PIXELS; i++)
        planes[3][i] = isfinite(depth[i]) ? (float)depth[i] : 1e10f;
    request.vfov_rad = 2.0f * atanf(0.4f);
    load(write_planes(names, 4, NULL), &request, &frame);
    assert_non_null(strstr(support_lines.text, "depth: \"V.Depth.Z\""));
    io_frame_free(&frame);
    request.vfov_rad = 0.0f;
    request.depth = "V.Position";
    load(support_path("positions.exr"), &request, &frame);
    expect_frame(&frame, &usual);
    io_frame_free(&frame);
    static const char *const denoising[] = {"V.Position.X", "V.Position.Y",
                                            "V.Position.Z", "V.Denoising Depth.Z"};
    request.depth = NULL;
    load(write_planes(denoising, 4, NULL), &request, &frame);
    expect_frame(&frame, &usual);
    io_frame_free(&frame);
    /* Positions of something else. */
    static const char *const reference[] = {"Pref.X", "Pref.Y", "Pref.Z"};
    const char *path = write_planes(reference, 3, NULL);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "no channel looks like depth");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_camera_and_depth), cmocka_unit_test(test_normals),
        cmocka_unit_test(test_a_plane_alone),    cmocka_unit_test(test_contradictions),
        cmocka_unit_test(test_nothing_seen),     cmocka_unit_test(test_roughness),
        cmocka_unit_test(test_choice),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}
