/* SPDX-License-Identifier: MIT */
/* Cameras against projections computed by hand. */
#include "fixture.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { IMAGE_WIDTH = 640, IMAGE_HEIGHT = 360 };

/* A projection as an engine's documents have it, rows of clip = M * view. */
typedef struct engine {
    const char *name;
    double m[4][4];
    double side;   /* view-space z of what is seen: -1 right-handed, 1 left-handed */
    double y_down; /* of clip space */
    crv_clip_depth range;
    bool reversed;
    double z_near, z_far;
} engine;

/* f = cot(fov / 2) = 1.7, aspect 16 / 9, near 0.25, far 50. A = f / aspect. */
#define F 1.7
#define A (1.7 * 9 / 16)
#define N 0.25
#define E 50.0

static const engine ENGINES[] = {
    {"OpenGL, gluPerspective",
     {{A, 0, 0, 0},
      {0, F, 0, 0},
      {0, 0, (E + N) / (N - E), 2 * E *N / (N - E)},
      {0, 0, -1, 0}},
     -1,
     0,
     CRV_CLIP_MINUS_ONE_TO_ONE,
     false,
     N,
     E},
    {"OpenGL, off-centre frustum of a tile",
     {{2 * A, 0, 0.6, 0},
      {0, 2 * F, -0.9, 0},
      {0, 0, (E + N) / (N - E), 2 * E *N / (N - E)},
      {0, 0, -1, 0}},
     -1,
     0,
     CRV_CLIP_MINUS_ONE_TO_ONE,
     false,
     N,
     E},
    {"Vulkan, y down",
     {{A, 0, 0, 0}, {0, -F, 0, 0}, {0, 0, E / (N - E), E *N / (N - E)}, {0, 0, -1, 0}},
     -1,
     1,
     CRV_CLIP_ZERO_TO_ONE,
     false,
     N,
     E},
    {"Vulkan, reversed infinite, off-axis for an eye",
     {{A, 0, 0.15, 0}, {0, -F, 0.03, 0}, {0, 0, 0, N}, {0, 0, -1, 0}},
     -1,
     1,
     CRV_CLIP_ZERO_TO_ONE,
     true,
     N,
     INFINITY},
    {"Vulkan, infinite",
     {{A, 0, 0, 0}, {0, -F, 0, 0}, {0, 0, -1, -N}, {0, 0, -1, 0}},
     -1,
     1,
     CRV_CLIP_ZERO_TO_ONE,
     false,
     N,
     INFINITY},
    {"Direct3D, XMMatrixPerspectiveFovLH",
     {{A, 0, 0, 0}, {0, F, 0, 0}, {0, 0, E / (E - N), -E *N / (E - N)}, {0, 0, 1, 0}},
     1,
     0,
     CRV_CLIP_ZERO_TO_ONE,
     false,
     N,
     E},
    {"Direct3D, reversed, jittered",
     {{A, 0, 0.5 / 640, 0},
      {0, F, -0.25 / 360, 0},
      {0, 0, N / (N - E), E *N / (E - N)},
      {0, 0, 1, 0}},
     1,
     0,
     CRV_CLIP_ZERO_TO_ONE,
     true,
     N,
     E},
    {"Unity, GL.GetGPUProjectionMatrix",
     {{A, 0, 0, 0}, {0, -F, 0, 0}, {0, 0, N / (E - N), E *N / (E - N)}, {0, 0, -1, 0}},
     -1,
     1,
     CRV_CLIP_ZERO_TO_ONE,
     true,
     N,
     E},
    {"Unreal, FReversedZPerspectiveMatrix without far",
     {{A, 0, 0, 0}, {0, F, 0, 0}, {0, 0, 0, N}, {0, 0, 1, 0}},
     1,
     0,
     CRV_CLIP_ZERO_TO_ONE,
     true,
     N,
     INFINITY},
    {"OpenGL, glOrtho",
     {{0.25, 0, 0, 0.3},
      {0, 0.5, 0, -0.2},
      {0, 0, -2 / (E - N), -(E + N) / (E - N)},
      {0, 0, 0, 1}},
     -1,
     0,
     CRV_CLIP_MINUS_ONE_TO_ONE,
     false,
     N,
     E},
    {"Direct3D, XMMatrixOrthographicLH",
     {{0.25, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 1 / (E - N), -N / (E - N)}, {0, 0, 0, 1}},
     1,
     0,
     CRV_CLIP_ZERO_TO_ONE,
     false,
     N,
     E},
    {"Vulkan, reversed orthographic",
     {{0.25, 0, 0, 0}, {0, -0.5, 0, 0}, {0, 0, 1 / (E - N), E / (E - N)}, {0, 0, 0, 1}},
     -1,
     1,
     CRV_CLIP_ZERO_TO_ONE,
     true,
     N,
     E},
};

static void store(const engine *e, crv_matrix_layout layout, float m[16])
{
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 4; column++)
            m[layout == CRV_MATRIX_ROW_MAJOR ? 4 * row + column : 4 * column + row] =
                (float)e->m[row][column];
    }
}

/* The rasteriser's pixel and depth-buffer value of a point of the engine's view space. */
static void rasterise(const engine *e, const double p[3], double pixel[2], double *value)
{
    double clip[4];
    for (int r = 0; r < 4; r++)
        clip[r] = e->m[r][0] * p[0] + e->m[r][1] * p[1] + e->m[r][2] * p[2] + e->m[r][3];
    const double x = clip[0] / clip[3], y = clip[1] / clip[3] * (e->y_down != 0 ? -1 : 1);
    const double z = clip[2] / clip[3];
    pixel[0] = (x + 1) / 2 * IMAGE_WIDTH;
    pixel[1] = (1 - y) / 2 * IMAGE_HEIGHT;
    *value = e->range == CRV_CLIP_ZERO_TO_ONE ? z : (z + 1) / 2;
}

static void check_engine(const engine *e, crv_matrix_layout layout)
{
    float m[16];
    crv_camera camera;
    crv_depth_format format;
    const crv_logger strict = fixture_strict_logger();
    store(e, layout, m);
    assert_int_equal(crv_camera_from_projection(&camera, m, layout, IMAGE_WIDTH,
                                                IMAGE_HEIGHT, &strict),
                     CRV_OK);
    assert_int_equal(
        crv_depth_format_from_projection(&format, m, layout, e->range, &strict), CRV_OK);
    assert_int_equal(format.encoding,
                     e->reversed ? CRV_DEPTH_REVERSED : CRV_DEPTH_HARDWARE);
    assert_true(fabs((double)format.z_near - e->z_near) < 1e-4 * e->z_near);
    /* far comes from 1 - A in floats: relative error 6e-8 * far / near, doubled. */
    assert_true(isinf(e->z_far)
                    ? isinf(format.z_far)
                    : fabs((double)format.z_far - e->z_far) < 1e-4 * e->z_far);
    static const double POINTS[][3] = {
        {0, 0, 1}, {1, 2, 3}, {-4, 0.5, 7}, {0.1, -0.7, 20}};
    for (int i = 0; i < 4; i++) {
        const double d = POINTS[i][2], x = POINTS[i][0], y = POINTS[i][1];
        const double p[3] = {x, y, e->side * d};
        double expected[2], value;
        rasterise(e, p, expected, &value);
        const double near_scale = camera.projection == CRV_PERSPECTIVE ? d : 1;
        /* Pixels; floats of a few hundred. */
        assert_true(fabs((double)camera.cx_px + (double)camera.fx_px * x / near_scale
                         - expected[0])
                    < 1e-3);
        assert_true(fabs((double)camera.cy_px - (double)camera.fy_px * y / near_scale
                         - expected[1])
                    < 1e-3);
        float buffer = (float)value, planar;
        const crv_const_image from = crv_const_image_packed(&buffer, 1, 1, 1);
        const crv_image to = crv_image_packed(&planar, 1, 1, 1);
        assert_int_equal(crv_depth_convert(&from, &format, &camera, &to, &strict),
                         CRV_OK);
        /* A float's step near 1 is 6e-8 of 1/near - 1/far: 3e-4 of depth 20. */
        assert_true(fabs((double)planar - d) < 1e-3 * d);
    }
}

static void projections_of_engines_are_understood(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ENGINES / sizeof ENGINES[0]; i++) {
        check_engine(&ENGINES[i], CRV_MATRIX_COLUMN_MAJOR);
        check_engine(&ENGINES[i], CRV_MATRIX_ROW_MAJOR);
    }
}

static void keep_line(void *user, crv_log_level level, const char *line)
{
    (void)level;
    snprintf(user, 512, "%s", line);
}

/* The other layout is refused with a word of it, but where near makes the matrix its own
 * transposition. */
static void exchanged_rows_and_columns_are_refused(void **state)
{
    (void)state;
    char line[512];
    const crv_logger logger = {keep_line, line};
    for (size_t i = 0; i < sizeof ENGINES / sizeof ENGINES[0]; i++) {
        float m[16];
        crv_camera camera;
        crv_depth_format format;
        line[0] = 0;
        store(&ENGINES[i], CRV_MATRIX_ROW_MAJOR, m);
        assert_int_equal(crv_camera_from_projection(&camera, m, CRV_MATRIX_COLUMN_MAJOR,
                                                    64, 36, &logger),
                         CRV_ERROR_INVALID_ARGUMENT);
        assert_non_null(strstr(line, "layout"));
        assert_int_equal(crv_depth_format_from_projection(&format, m,
                                                          CRV_MATRIX_COLUMN_MAJOR,
                                                          ENGINES[i].range, &logger),
                         CRV_ERROR_INVALID_ARGUMENT);
    }
}

static crv_status understand(const float m[16])
{
    crv_camera camera;
    return crv_camera_from_projection(&camera, m, CRV_MATRIX_COLUMN_MAJOR, 4, 4, NULL);
}

static void other_matrices_are_refused(void **state)
{
    (void)state;
    const crv_status bad = CRV_ERROR_INVALID_ARGUMENT;
    crv_camera camera;
    crv_depth_format format;
    float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    assert_int_equal(understand(m), CRV_OK);
    assert_int_equal(crv_camera_from_projection(NULL, m, 0, 4, 4, NULL), bad);
    assert_int_equal(crv_camera_from_projection(&camera, NULL, 0, 4, 4, NULL), bad);
    assert_int_equal(crv_camera_from_projection(&camera, m, 0, 0, 4, NULL), bad);
    assert_int_equal(
        crv_camera_from_projection(&camera, m, (crv_matrix_layout)2, 4, 4, NULL), bad);
    m[0] = NAN;
    assert_int_equal(understand(m), bad);
    m[0] = -1; /* mirrored */
    assert_int_equal(understand(m), bad);
    m[0] = 1;
    m[1] = 0.5f; /* sheared */
    assert_int_equal(understand(m), bad);
    m[1] = 0;
    m[2] = 0.5f; /* oblique near plane: a camera, but no depth format */
    assert_int_equal(understand(m), CRV_OK);
    assert_int_equal(crv_depth_format_from_projection(&format, m, 0, 0, NULL), bad);
    m[2] = 0;
    m[5] = 3e38f; /* a focal length of 2 * 3e38 px is no float */
    assert_int_equal(understand(m), bad);
    m[5] = 1;
    m[15] = 1e-38f;
    m[0] = m[5] = 3.0f; /* the same, by a tiny w */
    assert_int_equal(understand(m), bad);
}

/* A world that is left-handed turns normals by a reflection; degrees are told apart from
 * radians by their size. */
static void gbuffers_take_reflections_and_refuse_degrees(void **state)
{
    (void)state;
    char line[512] = "";
    crv_context_desc hooks;
    crv_gbuffer_desc desc;
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_context_desc_init(&hooks, sizeof hooks);
    hooks.logger = (crv_logger){keep_line, line};
    crv_gbuffer_desc_init(&desc, sizeof desc, 4, 4);
    assert_int_equal(crv_context_create(&hooks, &context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(context, &desc, &gbuffer), CRV_OK);
    crv_camera camera = crv_camera_perspective(4, 4, 1);
    camera.world_to_view[8] = -1;
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &camera), CRV_OK);
    camera.world_to_view[8] = 0;
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &camera),
                     CRV_ERROR_INVALID_ARGUMENT);
    static const float DEGREES[] = {45, 90, 60, 0, -1};
    for (int i = 0; i < 5; i++) {
        camera = crv_camera_perspective(4, 4, DEGREES[i]);
        line[0] = 0;
        assert_int_equal(crv_gbuffer_set_camera(gbuffer, &camera),
                         CRV_ERROR_INVALID_ARGUMENT);
        assert_non_null(strstr(line, "radians"));
    }
    camera = crv_camera_crop(NULL, 3, 4);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &camera),
                     CRV_ERROR_INVALID_ARGUMENT);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
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
        cmocka_unit_test(projections_of_engines_are_understood),
        cmocka_unit_test(exchanged_rows_and_columns_are_refused),
        cmocka_unit_test(gbuffers_take_reflections_and_refuse_degrees),
        cmocka_unit_test(other_matrices_are_refused),
        cmocka_unit_test(field_of_view_is_vertical),
        cmocka_unit_test(look_at_turns_the_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
