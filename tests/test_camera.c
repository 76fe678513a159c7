/* SPDX-License-Identifier: MIT */
/* Cameras against projections computed by hand. */
#include "fixture.h"

#include <math.h>
#include <string.h>

/* The pixel of a view-space point through a column-major clip matrix. */
static void project(const float m[16], const double p[3], int32_t width, int32_t height,
                    int y_down, double out[2])
{
    double clip[4];
    for (int r = 0; r < 4; r++)
        clip[r] = (double)m[r] * p[0] + (double)m[4 + r] * p[1] + (double)m[8 + r] * p[2]
                  + (double)m[12 + r];
    const double x = clip[0] / clip[3], y = clip[1] / clip[3] * (y_down ? -1 : 1);
    out[0] = (x + 1) / 2 * width;
    out[1] = (1 - y) / 2 * height;
}

static void expect_projection(const float m[16], int y_down)
{
    enum { WIDTH = 640, HEIGHT = 360 };
    crv_camera camera;
    assert_int_equal(crv_camera_from_projection(&camera, m, WIDTH, HEIGHT), CRV_OK);
    static const double POINTS[][3] = {
        {0, 0, -1}, {1, 2, -3}, {-4, 0.5, -7}, {0.1, -0.7, -20}};
    for (int i = 0; i < 4; i++) {
        const double *p = POINTS[i];
        const double d = camera.projection == CRV_PERSPECTIVE ? -p[2] : 1;
        double expected[2];
        project(m, p, WIDTH, HEIGHT, y_down, expected);
        const double x = (double)camera.cx_px + (double)camera.fx_px * p[0] / d;
        const double y = (double)camera.cy_px - (double)camera.fy_px * p[1] / d;
        assert_true(fabs(x - expected[0]) < 1e-3); /* pixels; floats of a few hundred */
        assert_true(fabs(y - expected[1]) < 1e-3);
    }
}

static void projections_are_understood(void **state)
{
    (void)state;
    /* Off-centre OpenGL frustum, the same with y down (Vulkan), reversed infinite z,
     * ortho. */
    const float gl[16] = {1.5f, 0,     0,       0,  0, 2, 0,     0,
                          0.2f, -0.1f, -1.002f, -1, 0, 0, -0.2f, 0};
    float vulkan[16], infinite[16];
    memcpy(vulkan, gl, sizeof gl);
    vulkan[5] = -2;
    vulkan[9] = 0.1f;
    memcpy(infinite, gl, sizeof gl);
    infinite[10] = 0;
    infinite[14] = 0.1f;
    const float ortho[16] = {0.25f, 0, 0,     0, 0,    0.5f,  0, 0,
                             0,     0, -0.1f, 0, 0.3f, -0.2f, 0, 1};
    expect_projection(gl, 0);
    expect_projection(vulkan, 1);
    expect_projection(infinite, 0);
    expect_projection(ortho, 0);
}

static void other_matrices_are_refused(void **state)
{
    (void)state;
    crv_camera camera;
    float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    assert_int_equal(crv_camera_from_projection(&camera, m, 4, 4), CRV_OK);
    assert_int_equal(crv_camera_from_projection(NULL, m, 4, 4),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_camera_from_projection(&camera, m, 0, 4),
                     CRV_ERROR_INVALID_ARGUMENT);
    m[0] = NAN;
    assert_int_equal(crv_camera_from_projection(&camera, m, 4, 4),
                     CRV_ERROR_INVALID_ARGUMENT);
    m[0] = 1;
    m[1] = 0.5f; /* sheared */
    assert_int_equal(crv_camera_from_projection(&camera, m, 4, 4),
                     CRV_ERROR_INVALID_ARGUMENT);
    m[1] = 0;
    m[11] = 1; /* looks down +Z */
    m[15] = 0;
    assert_int_equal(crv_camera_from_projection(&camera, m, 4, 4),
                     CRV_ERROR_INVALID_ARGUMENT);
}

static void field_of_view_is_vertical(void **state)
{
    (void)state;
    /* 90 degrees: half the height is seen at distance 1 under tan 45 = 1. */
    crv_camera camera = crv_camera_perspective(200, 100, 1.57079633f);
    assert_true(fabsf(camera.fx_px - 50) < 1e-4f && fabsf(camera.fy_px - 50) < 1e-4f);
    assert_true(camera.cx_px == 100 && camera.cy_px == 50);
    crv_camera cropped = crv_camera_crop(&camera, -8, 30);
    assert_true(cropped.cx_px == 108 && cropped.cy_px == 20
                && cropped.fx_px == camera.fx_px);
    assert_true(fabsf(crv_camera_orthographic(200, 100, 4).fy_px - 25) < 1e-5f);
}

static void look_at_turns_the_world(void **state)
{
    (void)state;
    crv_camera camera = crv_camera_perspective(4, 4, 1);
    /* From +X towards the origin: world -X is view -Z, world -Z is view +X, +Y stays. */
    const float eye[3] = {5, 0, 0}, target[3] = {0, 0, 0}, up[3] = {0, 3, 0};
    assert_int_equal(crv_camera_look_at(&camera, eye, target, up), CRV_OK);
    static const float EXPECTED[9] = {0, 0, -1, 0, 1, 0, 1, 0, 0};
    for (int i = 0; i < 9; i++)
        assert_true(fabsf(camera.world_to_view[i] - EXPECTED[i]) < 1e-6f);
    crv_camera before = camera;
    const float along[3] = {-1, 0, 0}, not_a_number[3] = {NAN, 0, 0};
    assert_int_equal(crv_camera_look_at(&camera, eye, eye, up),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_camera_look_at(&camera, eye, target, along),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_camera_look_at(&camera, not_a_number, target, up),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_camera_look_at(NULL, eye, target, up),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_memory_equal(&before, &camera, sizeof camera);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(projections_are_understood),
        cmocka_unit_test(other_matrices_are_refused),
        cmocka_unit_test(field_of_view_is_vertical),
        cmocka_unit_test(look_at_turns_the_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
