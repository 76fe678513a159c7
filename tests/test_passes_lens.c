/* SPDX-License-Identifier: MIT */
/* The field of view that normals and depth agree on: a corner of three planes, seen by a
 * known camera. */
#include <math.h>

#include "passes/passes.h"
#include "test_io_support.h"

enum { W = 120, H = 80, PIXELS = W * H };

static float planes[4][PIXELS]; /* depth, normals */
static double axes[3][3];       /* rows right, up, back */

static const double pi = 3.14159265358979323846;

static void turn_camera(double pan, double tilt)
{
    const double r[3] = {cos(pan), 0, -sin(pan)};
    const double b[3] = {sin(pan) * cos(tilt), -sin(tilt), cos(pan) * cos(tilt)};
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        axes[0][c] = r[c];
        axes[1][c] = b[d] * r[e] - b[e] * r[d];
        axes[2][c] = b[c];
    }
}

/* The planes x = 0, y = 0, z = 0 from inside, normals in view or world space; depth along
 * the axis, or from the eye. */
static void see(double vfov_deg, bool world, bool radial)
{
    static const double eye[3] = {2.0, 1.5, 3.0};
    const double f = 0.5 * H / tan(0.5 * vfov_deg * pi / 180.0);
    for (int i = 0; i < PIXELS; i++) {
        const double x = (i % W + 0.5 - 0.5 * W) / f, y = -(i / W + 0.5 - 0.5 * H) / f;
        double depth = INFINITY;
        int hit = 0;
        for (int c = 0; c < 3; c++) {
            const double d = x * axes[0][c] + y * axes[1][c] - axes[2][c];
            if (d < 0.0 && -eye[c] / d < depth) {
                depth = -eye[c] / d;
                hit = c;
            }
        }
        planes[0][i] = (float)(depth * (radial ? sqrt(1 + x * x + y * y) : 1.0));
        for (int c = 0; c < 3; c++)
            planes[1 + c][i] = (float)(world ? (c == hit ? 1.0 : 0.0) : axes[c][hit]);
    }
}

static const char *write_frame(int count)
{
    static const char *const names[] = {"Z", "N.X", "N.Y", "N.Z"};
    const float *const all[] = {planes[0], planes[1], planes[2], planes[3]};
    const char *path = support_path("lens.exr");
    support_make_plain_exr(path, names, count, W, H, all);
    support_forget();
    return path;
}

static io_passes_request fitting(void)
{
    return (io_passes_request){.depth_format = crv_depth_format_planar(),
                               .fit_vfov = true};
}

/* Depth in single precision and exact normals: a thousandth of the angle is ample. */
static void test_fit(void **state)
{
    (void)state;
    static const double angles[] = {20.0, 45.0, 45.0, 45.0, 45.0, 90.0};
    const io_passes_request request = fitting();
    for (int i = 0; i < 6; i++) {
        const bool world = i == 3 || i == 4, radial = i == 2 || i == 3;
        io_frame frame;
        turn_camera(0.5, -0.4);
        see(angles[i], world, radial);
        if (io_frame_load(write_frame(4), &request, &frame, support_logger()))
            fail_msg("%g degrees: %s", angles[i], support_lines.error);
        const double found = (double)frame.fitted_vfov_rad * 180.0 / pi;
        if (fabs(found / angles[i] - 1.0) > 1e-3)
            fail_msg("%g degrees for %g: %s", found, angles[i], support_lines.text);
        assert_int_equal(frame.encoding, radial ? CRV_DEPTH_RADIAL : CRV_DEPTH_PLANAR);
        assert_int_equal(support_lines.warnings, radial);
        io_frame_free(&frame);
    }
}

static void expect_refusal(int channels, const char *part)
{
    const io_passes_request request = fitting();
    io_frame frame;
    const char *path = write_frame(channels);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, part);
}

static void test_refusals(void **state)
{
    (void)state;
    turn_camera(0.5, -0.4);
    see(45, false, false);
    expect_refusal(1, "it has no normals");
    /* Depth and normals of two frames. */
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = 2.0f + 0.01f * (float)(i % W);
    expect_refusal(4, "cannot be found");
    /* A wall that faces the camera is the same at any. */
    turn_camera(0, 0);
    see(20, false, false);
    expect_refusal(4, "cannot be found");
    /* Both are said. */
    io_passes_request request = fitting();
    io_frame frame;
    request.vfov_rad = 1.0f;
    const char *path = write_frame(4);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "given and to be found");
}

/* A later frame with another lens is told of, once. */
static void test_zoom(void **state)
{
    (void)state;
    io_passes_request request = {.depth_format = crv_depth_format_planar(),
                                 .vfov_rad = (float)(45.0 * pi / 180.0),
                                 .is_later = true};
    turn_camera(0.5, -0.4);
    for (int k = 0; k < 3; k++) {
        io_frame frame;
        see(k == 0 ? 45 : 25, false, false);
        request.zoom_told = k == 2;
        assert_int_equal(
            io_frame_load(write_frame(4), &request, &frame, support_logger()), 0);
        assert_int_equal(frame.zooms, k == 1);
        assert_int_equal(support_lines.warnings, k == 1);
        assert_int_equal(!strstr(support_lines.text, "zooms"), k != 1);
        io_frame_free(&frame);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_zoom),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}
