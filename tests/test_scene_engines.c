/* SPDX-License-Identifier: MIT */
/*
 * Projection matrices by the formulas in the documents of engines. A frame is rasterised
 * by the matrix alone: rays are its inverse in double, depth is what it gives at the
 * surface, stored as a float. Read with the camera and the format that the library takes
 * from the matrix, it must be the frame that the ray caster renders with that camera.
 */
#include "raycast.h"
#include "test_scene_support.h"

#include <stdio.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 54, PIXELS = WIDTH * HEIGHT };

static const double Z_NEAR = 0.05, Z_FAR = 200, ASPECT = 16.0 / 9, HALF_FOV = 0.4;

/* Entries of clip = M view by row and column, as mathematics writes them. */
typedef struct matrix {
    double at[4][4];
} matrix;

typedef struct engine {
    const char *name;
    matrix (*make)(void);
    bool is_left_handed; /* looks along +Z of its view space */
    bool is_y_down;      /* clip-space y */
    crv_clip_depth range;
    bool is_reversed;
    double z_far; /* INFINITY: none */
} engine;

/* ---- OpenGL ---- */

/* glFrustum() */
static matrix gl_frustum(double l, double r, double b, double t)
{
    const double n = Z_NEAR, f = Z_FAR;
    return (matrix){{{2 * n / (r - l), 0, (r + l) / (r - l), 0},
                     {0, 2 * n / (t - b), (t + b) / (t - b), 0},
                     {0, 0, -(f + n) / (f - n), -2 * f * n / (f - n)},
                     {0, 0, -1, 0}}};
}

/* gluPerspective() */
static matrix gl_perspective(void)
{
    const double n = Z_NEAR, f = Z_FAR, cot = 1 / tan(HALF_FOV);
    return (matrix){{{cot / ASPECT, 0, 0, 0},
                     {0, cot, 0, 0},
                     {0, 0, (f + n) / (n - f), 2 * f * n / (n - f)},
                     {0, 0, -1, 0}}};
}

/* The left eye of a headset: more is seen to the left and below. */
static matrix gl_off_axis(void)
{
    return gl_frustum(-1.1 * Z_NEAR, 0.8 * Z_NEAR, -0.6 * Z_NEAR, 0.5 * Z_NEAR);
}

/* The tile in column 2 of 3 and the lower of 2 rows of a large picture. */
static matrix gl_tile(void)
{
    const double t = Z_NEAR * tan(HALF_FOV), r = t * ASPECT;
    return gl_frustum(-r + 2 * r * 2 / 3, r, -t, 0);
}

/* glm::infinitePerspective(), and f of gl_perspective() to infinity. */
static matrix gl_infinite(void)
{
    matrix m = gl_perspective();
    m.at[2][2] = -1;
    m.at[2][3] = -2 * Z_NEAR;
    return m;
}

/* glOrtho() */
static matrix gl_ortho(void)
{
    const double l = -9, r = 11, b = -5, t = 6, n = Z_NEAR, f = Z_FAR;
    return (matrix){{{2 / (r - l), 0, 0, -(r + l) / (r - l)},
                     {0, 2 / (t - b), 0, -(t + b) / (t - b)},
                     {0, 0, -2 / (f - n), -(f + n) / (f - n)},
                     {0, 0, 0, 1}}};
}

/* Unity's Camera.projectionMatrix is OpenGL's on every platform. */
static matrix unity_camera(void)
{
    return gl_perspective();
}

/* GL.GetGPUProjectionMatrix(m, true) where depth is reversed and textures begin on top:
 * y is negated, and z' = (w - z) / 2. */
static matrix unity_gpu(void)
{
    matrix m = gl_perspective();
    m.at[1][1] *= -1;
    for (int i = 0; i < 4; i++)
        m.at[2][i] = (m.at[3][i] - m.at[2][i]) / 2;
    return m;
}

/* ---- Vulkan ---- */

/* glm::perspectiveRH_ZO() with m[1][1] negated, as the tutorials do. */
static matrix vulkan_perspective(void)
{
    const double n = Z_NEAR, f = Z_FAR, cot = 1 / tan(HALF_FOV);
    return (matrix){{{cot / ASPECT, 0, 0, 0},
                     {0, -cot, 0, 0},
                     {0, 0, f / (n - f), -f * n / (f - n)},
                     {0, 0, -1, 0}}};
}

static matrix vulkan_reversed_infinite(void)
{
    matrix m = vulkan_perspective();
    m.at[2][2] = 0;
    m.at[2][3] = Z_NEAR;
    return m;
}

/* OpenXR: the tangents of the angles of an eye, up and down exchanged for Vulkan. */
static matrix vulkan_openxr(void)
{
    const double left = -1.2, right = 0.9, up = 0.7, down = -0.8, n = Z_NEAR, f = Z_FAR;
    const double wide = right - left, high = down - up;
    return (matrix){{{2 / wide, 0, (right + left) / wide, 0},
                     {0, 2 / high, (up + down) / high, 0},
                     {0, 0, -f / (f - n), -f * n / (f - n)},
                     {0, 0, -1, 0}}};
}

/* For temporal antialiasing, a part of a pixel of the picture, in clip space. */
static matrix jittered(matrix m, double x_px, double y_px)
{
    for (int i = 0; i < 4; i++) {
        m.at[0][i] += 2 * x_px / WIDTH * m.at[3][i];
        m.at[1][i] += 2 * y_px / HEIGHT * m.at[3][i];
    }
    return m;
}

static matrix vulkan_jittered(void)
{
    return jittered(vulkan_reversed_infinite(), 0.375, -0.4375);
}

/* ---- Direct3D ---- */

/* XMMatrixPerspectiveFovLH(); the documents print it for row vectors. */
static matrix d3d_perspective(void)
{
    const double n = Z_NEAR, f = Z_FAR, cot = 1 / tan(HALF_FOV);
    return (matrix){{{cot / ASPECT, 0, 0, 0},
                     {0, cot, 0, 0},
                     {0, 0, f / (f - n), -n * f / (f - n)},
                     {0, 0, 1, 0}}};
}

/* XMMatrixPerspectiveOffCenterLH() with near and far exchanged: reversed. */
static matrix d3d_off_centre_reversed(void)
{
    const double n = Z_FAR, f = Z_NEAR, l = -0.9 * n, r = 1.2 * n, b = -0.7 * n,
                 t = 0.55 * n;
    return (matrix){{{2 * n / (r - l), 0, -(l + r) / (r - l), 0},
                     {0, 2 * n / (t - b), -(t + b) / (t - b), 0},
                     {0, 0, f / (f - n), -n * f / (f - n)},
                     {0, 0, 1, 0}}};
}

/* XMMatrixPerspectiveFovRH() */
static matrix d3d_right_handed(void)
{
    matrix m = d3d_perspective();
    for (int i = 0; i < 4; i++)
        m.at[i][2] *= -1;
    return m;
}

/* XMMatrixOrthographicLH() */
static matrix d3d_ortho(void)
{
    const double n = Z_NEAR, f = Z_FAR;
    return (matrix){{{2 / 20.0, 0, 0, 0},
                     {0, 2 / 11.25, 0, 0},
                     {0, 0, 1 / (f - n), -n / (f - n)},
                     {0, 0, 0, 1}}};
}

/* ---- Unreal ---- */

/* FReversedZPerspectiveMatrix with equal near and far, which stands for no far plane. */
static matrix unreal_perspective(void)
{
    const double cot_x = 1 / (tan(HALF_FOV) * ASPECT);
    return (matrix){
        {{cot_x, 0, 0, 0}, {0, cot_x * ASPECT, 0, 0}, {0, 0, 0, Z_NEAR}, {0, 0, 1, 0}}};
}

/* FReversedZPerspectiveMatrix with both */
static matrix unreal_finite(void)
{
    matrix m = unreal_perspective();
    m.at[2][2] = Z_NEAR / (Z_NEAR - Z_FAR);
    m.at[2][3] = -Z_FAR * Z_NEAR / (Z_NEAR - Z_FAR);
    return m;
}

/* FViewMatrices::HackAddTemporalAAProjectionJitter() adds to M[2][0] and M[2][1]. */
static matrix unreal_jittered(void)
{
    return jittered(unreal_perspective(), -0.25, 0.3125);
}

#define GL_RANGE  CRV_CLIP_MINUS_ONE_TO_ONE
#define ONE_RANGE CRV_CLIP_ZERO_TO_ONE

static const engine ENGINES[] = {
    {.name = "OpenGL", .make = gl_perspective, .range = GL_RANGE, .z_far = 200},
    {.name = "OpenGL, off-axis", .make = gl_off_axis, .range = GL_RANGE, .z_far = 200},
    {.name = "OpenGL, tile", .make = gl_tile, .range = GL_RANGE, .z_far = 200},
    {.name = "OpenGL, infinite",
     .make = gl_infinite,
     .range = GL_RANGE,
     .z_far = INFINITY},
    {.name = "OpenGL, orthographic", .make = gl_ortho, .range = GL_RANGE, .z_far = 200},
    {.name = "Unity, camera", .make = unity_camera, .range = GL_RANGE, .z_far = 200},
    {.name = "Unity, GPU",
     .make = unity_gpu,
     .is_y_down = true,
     .is_reversed = true,
     .z_far = 200},
    {.name = "Vulkan", .make = vulkan_perspective, .is_y_down = true, .z_far = 200},
    {.name = "Vulkan, reversed infinite",
     .make = vulkan_reversed_infinite,
     .is_y_down = true,
     .is_reversed = true,
     .z_far = INFINITY},
    {.name = "Vulkan, OpenXR", .make = vulkan_openxr, .is_y_down = true, .z_far = 200},
    {.name = "Vulkan, jittered",
     .make = vulkan_jittered,
     .is_y_down = true,
     .is_reversed = true,
     .z_far = INFINITY},
    {.name = "Direct3D", .make = d3d_perspective, .is_left_handed = true, .z_far = 200},
    {.name = "Direct3D, off-centre, reversed",
     .make = d3d_off_centre_reversed,
     .is_left_handed = true,
     .is_reversed = true,
     .z_far = 200},
    {.name = "Direct3D, right-handed", .make = d3d_right_handed, .z_far = 200},
    {.name = "Direct3D, orthographic",
     .make = d3d_ortho,
     .is_left_handed = true,
     .z_far = 200},
    {.name = "Unreal",
     .make = unreal_perspective,
     .is_left_handed = true,
     .is_reversed = true,
     .z_far = INFINITY},
    {.name = "Unreal, far plane",
     .make = unreal_finite,
     .is_left_handed = true,
     .is_reversed = true,
     .z_far = 200},
    {.name = "Unreal, jittered",
     .make = unreal_jittered,
     .is_left_handed = true,
     .is_reversed = true,
     .z_far = INFINITY},
};

/* ---- what an engine's rasteriser does ---- */

/* The engine computes with floats. */
static matrix rounded(matrix m)
{
    for (int i = 0; i < 16; i++)
        m.at[i / 4][i % 4] = (double)(float)m.at[i / 4][i % 4];
    return m;
}

/* The point whose clip-space position is (x, y, z, 1) times a number: elimination with
 * pivots. */
static vec3 unproject(const matrix *m, double x, double y, double z)
{
    double a[4][5];
    for (int i = 0; i < 4; i++) {
        memcpy(a[i], m->at[i], sizeof m->at[i]);
        a[i][4] = i == 0 ? x : i == 1 ? y : i == 2 ? z : 1;
    }
    for (int k = 0; k < 4; k++) {
        int pivot = k;
        for (int i = k; i < 4; i++)
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        for (int j = 0; j < 5; j++) {
            const double held = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = held;
        }
        for (int i = 0; i < 4; i++) {
            const double factor = a[i][k] / a[k][k];
            for (int j = k; j < 5 && i != k; j++)
                a[i][j] -= factor * a[k][j];
        }
    }
    const double w = a[3][4] / a[3][3];
    return v3(a[0][4] / a[0][0] / w, a[1][4] / a[1][1] / w, a[2][4] / a[2][2] / w);
}

/* The ray through a pixel's centre in the engine's view space, from z = 0 on and one long
 * along z. */
static pixel_ray engine_ray(const engine *e, const matrix *m, int32_t x, int32_t y)
{
    const double across = 2 * (x + 0.5) / WIDTH - 1, down = 2 * (y + 0.5) / HEIGHT - 1;
    const vec3 p = unproject(m, across, e->is_y_down ? down : -down, 0.25);
    const vec3 q = unproject(m, across, e->is_y_down ? down : -down, 0.75);
    const vec3 slope = v3_scale(v3_sub(q, p), 1 / (q.z - p.z));
    return (pixel_ray){.origin = v3_sub(p, v3_scale(slope, p.z)),
                       .direction = v3_scale(slope, e->is_left_handed ? 1 : -1)};
}

static vec3 in_world(const engine *e, const scene_axes *axes, vec3 v)
{
    const vec3 flat = v3_along(v3_scale(axes->right, v.x), axes->up, v.y);
    return v3_along(flat, axes->back, e->is_left_handed ? -v.z : v.z);
}

static float buffer_value(const engine *e, const matrix *m, vec3 p)
{
    double clip[4];
    for (int i = 0; i < 4; i++)
        clip[i] = m->at[i][0] * p.x + m->at[i][1] * p.y + m->at[i][2] * p.z + m->at[i][3];
    const double z = clip[2] / clip[3];
    return (float)(e->range == GL_RANGE ? (z + 1) / 2 : z);
}

/* What a pixel of the engine's frame is: planar depth, the point in the world, and the
 * depth buffer's value. */
typedef struct texel {
    double depth; /* INFINITY: background */
    vec3 point;
    float value;
} texel;

static texel rasterise(const engine *e, const matrix *m, const scene *s,
                       const scene_axes *axes, int32_t x, int32_t y)
{
    const pixel_ray own = engine_ray(e, m, x, y);
    const pixel_ray sight = {v3_add(axes->eye, in_world(e, axes, own.origin)),
                             in_world(e, axes, own.direction)};
    surface_hit hit; /* beyond the near plane: what is before it is clipped */
    if (!find_surface(s, &sight, (float)Z_NEAR, &hit))
        return (texel){.depth = INFINITY, .value = e->is_reversed ? 0 : 1};
    return (texel){
        .depth = hit.depth,
        .point = v3_along(sight.origin, sight.direction, hit.depth),
        .value = buffer_value(e, m, v3_along(own.origin, own.direction, hit.depth))};
}

/* ---- the comparison ---- */

/* Relative error of a depth that went through the buffer. Half a step of a float is 6e-8
 * of the value, 3e-8 below 1. Matrix and format have been rounded likewise. The error is
 * that of 1 / d next to 1 / near; reversed it is that of 1 / d itself. Orthographic: that
 * of d next to far. */
static double tolerance(const engine *e, const crv_camera *camera, double depth)
{
    if (camera->projection == CRV_ORTHOGRAPHIC)
        return 1e-6 + 2e-7 * Z_FAR / depth;
    return e->is_reversed ? 1e-6 : 1e-6 + 3e-7 * depth / Z_NEAR;
}

static vec3 point_of(const crv_camera *camera, const scene_axes *axes, int32_t x,
                     int32_t y, double depth)
{
    const pixel_ray sight = ray_through_pixel(camera, axes, x, y);
    return v3_along(sight.origin, sight.direction, depth);
}

static void check_frame(const engine *e, const matrix *m, const crv_camera *camera,
                        const crv_depth_format *format, const scene *s,
                        const scene_axes *axes)
{
    static texel frame[PIXELS];
    static float buffer[PIXELS], planar[PIXELS];
    for (int32_t i = 0; i < PIXELS; i++) {
        frame[i] = rasterise(e, m, s, axes, i % WIDTH, i / WIDTH);
        buffer[i] = frame[i].value;
    }
    const crv_const_image from = crv_const_image_packed(buffer, WIDTH, HEIGHT, 1);
    const crv_image to = crv_image_packed(planar, WIDTH, HEIGHT, 1);
    assert_int_equal(crv_depth_convert(&from, format, camera, &to, NULL), CRV_OK);
    int seen = 0, elsewhere = 0;
    for (int32_t i = 0; i < PIXELS; i++) {
        const int32_t x = i % WIDTH, y = i / WIDTH;
        const pixel_ray sight = ray_through_pixel(camera, axes, x, y);
        surface_hit hit;
        const double rendered =
            find_surface(s, &sight, (float)Z_NEAR, &hit) ? hit.depth : INFINITY;
        const double decoded = (double)planar[i];
        const double bound = tolerance(e, camera, rendered) * rendered;
        if (isinf(rendered) || isinf(decoded)) {
            elsewhere += isinf(rendered) != isinf(decoded);
            continue;
        }
        seen++;
        const vec3 point = point_of(camera, axes, x, y, decoded);
        /* To the side a point moves by its depth's error and the camera's floats. */
        if (!(fabs(decoded - rendered) <= bound)
            || !(v3_length(v3_sub(point, frame[i].point)) <= 3 * bound + 1e-5))
            elsewhere++;
    }
    if (elsewhere > 2) /* rays that differ by 1e-6 may part at a silhouette */
        fail_msg("%s: %d of %d pixels are elsewhere", e->name, elsewhere, seen);
    assert_true(seen > PIXELS / 4);
}

static void check_engine(const engine *e, crv_matrix_layout layout, const scene *s,
                         const scene_axes *axes)
{
    messages said;
    const crv_logger log = catch_messages(&said);
    const matrix m = rounded(e->make());
    float memory[16];
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 4; column++)
            memory[layout == CRV_MATRIX_ROW_MAJOR ? 4 * row + column : 4 * column + row] =
                (float)m.at[row][column];
    }
    crv_camera camera;
    crv_depth_format format;
    assert_int_equal(
        crv_camera_from_projection(&camera, memory, layout, WIDTH, HEIGHT, &log), CRV_OK);
    assert_int_equal(
        crv_depth_format_from_projection(&format, memory, layout, e->range, &log),
        CRV_OK);
    assert_int_equal(said.errors + said.warnings, 0);
    assert_int_equal(format.encoding,
                     e->is_reversed ? CRV_DEPTH_REVERSED : CRV_DEPTH_HARDWARE);
    assert_int_equal(isinf(format.z_far), isinf(e->z_far));
    check_frame(e, &m, &camera, &format, s, axes);
}

static void frames_of_engines_are_those_of_the_ray_caster(void **state)
{
    (void)state;
    scene *s = NULL;
    scene_view view;
    scene_axes axes;
    static const double ORIGIN[3] = {0, 0, 0};
    assert_int_equal(scene_builtin("courtyard", &s, NULL), 0);
    scene_frame(s, 0.8f, (float)ASPECT, &view);
    assert_true(scene_axes_of_view(&view, ORIGIN, &axes));
    for (size_t i = 0; i < sizeof ENGINES / sizeof ENGINES[0]; i++) {
        check_engine(&ENGINES[i], CRV_MATRIX_COLUMN_MAJOR, s, &axes);
        check_engine(&ENGINES[i], CRV_MATRIX_ROW_MAJOR, s, &axes);
    }
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_of_engines_are_those_of_the_ray_caster),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
