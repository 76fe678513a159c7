/* SPDX-License-Identifier: MIT */
/*
 * Depth and normals of simple shapes against their closed forms.
 */
#include "test_scene_support.h"

#include <stdio.h>

enum { WIDTH = 97, HEIGHT = 61 };

/* Depth is stored as float (6e-8) and the camera's numbers are floats on both sides; what
 * is left is rounding in double. */
#define PLANE_TOLERANCE 2e-7

static double plane_depth(const ray *r, const double normal[3], double offset)
{
    return (offset - dot(normal, r->origin)) / dot(normal, r->direction);
}

/* A quad in the plane normal . p = offset that is far larger than what is seen. */
static scene *plane_scene(const double normal[3], double offset)
{
    char text[512];
    int used = 0;
    static const double xz[4][2] = {{-60, 60}, {60, 60}, {60, -60}, {-60, -60}};
    for (int i = 0; i < 4; i++) {
        double x = xz[i][0], z = xz[i][1];
        double y = (offset - normal[0] * x - normal[2] * z) / normal[1];
        used += snprintf(text + used, sizeof text - (size_t)used, "v %.9g %.9g %.9g\n", x,
                         y, z);
    }
    snprintf(text + used, sizeof text - (size_t)used, "f 1 2 3 4\n");
    return load_text("plane.obj", text);
}

static void check_plane(crv_projection projection, const double normal[3], double offset,
                        const double eye[3])
{
    const double target[3] = {0, 0, 0};
    scene *s = plane_scene(normal, offset);
    scene_view view = look(projection, eye, target, 3.0);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    scene_gbuffer g = render(s, &request);
    int hits = 0;
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            int32_t pixel = y * WIDTH + x;
            ray r = ray_of_pixel(&g, x, y);
            double expected = plane_depth(&r, normal, offset), n[3];
            double depth = (double)g.depth[0][pixel];
            if (!(expected > 0.0 && expected < 30.0))
                continue;
            hits++;
            assert_true(fabs(depth - expected) <= PLANE_TOLERANCE * expected);
            to_world(&g, g.normals + 3 * pixel, n);
            assert_true(dot(n, normal) / sqrt(dot(normal, normal)) > 1.0 - 1e-6);
        }
    assert_true(hits > WIDTH * HEIGHT / 3);
    scene_gbuffer_free(&g);
    scene_free(s);
}

static void test_planes(void **state)
{
    /* Corner coordinates are exact in float, so that the mesh is the plane. */
    static const double normal[3][3] = {{0, 1, 0}, {0.5, 1, 0.25}, {-2, 1, 1}};
    static const double eye[3] = {1, 5, 4};
    (void)state;
    for (int i = 0; i < 3; i++) {
        check_plane(CRV_PERSPECTIVE, normal[i], 0.125, eye);
        check_plane(CRV_ORTHOGRAPHIC, normal[i], 0.125, eye);
    }
}

static void test_back_of_plane_is_turned(void **state)
{
    static const double below[3] = {0.3, -4, 1}, target[3] = {0, 0, 0};
    static const double normal[3] = {0, 1, 0};
    scene *s = plane_scene(normal, 0.0);
    scene_view view = look(CRV_PERSPECTIVE, below, target, 0.0);
    scene_gbuffer_request request = request_of(&view, 5, 5);
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        double n[3];
        request.normals = (scene_normals)kind;
        scene_gbuffer g = render(s, &request);
        to_world(&g, g.normals + 3 * 12, n);
        assert_true(n[1] < -0.999999);
        scene_gbuffer_free(&g);
    }
    scene_free(s);
}

/* The nearer root of |origin + t direction - (0, 1, 0)| = 1, or a negative number. */
static double sphere_depth(const ray *r)
{
    double o[3] = {r->origin[0], r->origin[1] - 1.0, r->origin[2]};
    double a = dot(r->direction, r->direction), b = dot(r->direction, o);
    double under = b * b - a * (dot(o, o) - 1.0);
    return under > 0.0 ? (-b - sqrt(under)) / a : -1.0;
}

static void test_sphere(void **state)
{
    scene *s = NULL;
    scene_view view;
    int hits = 0;
    (void)state;
    assert_int_equal(scene_builtin("sphere", &s, NULL), 0);
    scene_frame(s, 0.7f, (float)WIDTH / HEIGHT, &view);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    scene_gbuffer g = render(s, &request);
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            int32_t pixel = y * WIDTH + x;
            ray r = ray_of_pixel(&g, x, y);
            double depth = sphere_depth(&r), n[3], expected[3];
            if (depth < 0.0)
                continue;
            for (int i = 0; i < 3; i++)
                expected[i] = r.origin[i] + depth * r.direction[i] - (i == 1 ? 1.0 : 0.0);
            const double facing =
                -dot(expected, r.direction) / sqrt(dot(r.direction, r.direction));
            if (facing < 0.3)
                continue;
            hits++;
            /* 512 segments: facets lie up to 2 (1 - cos(pi / 512)) = 3.8e-5 inside, seen
             * at a slant up to 1 / 0.3 times as deep. */
            assert_true((double)g.depth[0][pixel] >= depth - 1e-6);
            assert_true((double)g.depth[0][pixel] <= depth + 1.3e-4);
            to_world(&g, g.normals + 3 * pixel, n);
            /* The point moves by as much along the ray, and the normal with it. */
            assert_true(dot(n, expected) > cos(5e-4));
        }
    assert_true(hits > 300);
    scene_gbuffer_free(&g);
    scene_free(s);
}

static void test_corner(void **state)
{
    static const double floor_normal[3] = {0, 1, 0}, wall_normal[3] = {1, 0, 0};
    scene *s = NULL;
    scene_view view;
    (void)state;
    assert_int_equal(scene_builtin("corner", &s, NULL), 0);
    scene_frame(s, 0.785f, (float)WIDTH / HEIGHT, &view);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    scene_gbuffer g = render(s, &request);
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            int32_t pixel = y * WIDTH + x;
            ray r = ray_of_pixel(&g, x, y);
            double to_floor = plane_depth(&r, floor_normal, 0.0);
            double to_wall = plane_depth(&r, wall_normal, 0.0);
            bool floor_first = to_floor > 0.0 && (to_wall < 0.0 || to_floor < to_wall);
            double expected = floor_first ? to_floor : to_wall, n[3];
            double depth = (double)g.depth[0][pixel];
            if (!isfinite(g.depth[0][pixel]))
                continue; /* beyond the quads' ends */
            assert_true(fabs(depth - expected) <= PLANE_TOLERANCE * expected);
            to_world(&g, g.normals + 3 * pixel, n);
            if (fabs(to_floor - to_wall) > 1e-4)
                assert_true(dot(n, floor_first ? floor_normal : wall_normal) > 0.999999);
        }
    assert_true(isfinite(g.depth[0][HEIGHT / 2 * WIDTH + WIDTH / 2]));
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* Down the bisector from y = 20: depth is 20 - |x|, the floor is to the right. */
static void test_groove(void **state)
{
    const double half = sqrt(0.5);
    scene *s = NULL;
    scene_view view;
    (void)state;
    assert_int_equal(scene_builtin("groove", &s, NULL), 0);
    scene_frame(s, 0.7f, 16.0f / 9.0f, &view);
    assert_int_equal(view.projection, CRV_ORTHOGRAPHIC);
    scene_gbuffer_request request = request_of(&view, 160, 90);
    scene_gbuffer g = render(s, &request);
    for (int32_t y = 0; y < 90; y++)
        for (int32_t x = 0; x < 160; x++) {
            int32_t pixel = y * 160 + x;
            double along = ((double)x + 0.5 - 80.0) * (double)view.view_height / 90.0;
            const float *n = g.normals + 3 * pixel;
            /* 4e-6: view_height / 90 px is rounded to float in the camera, too. */
            assert_true(fabs((double)g.depth[0][pixel] - (20.0 - fabs(along))) < 4e-6);
            assert_true(fabs((double)n[0] + (along > 0.0 ? half : -half)) < 1e-6);
            assert_true(fabs((double)n[1]) < 1e-6);
            assert_true(fabs((double)n[2] - half) < 1e-6);
        }
    scene_gbuffer_free(&g);
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_planes), cmocka_unit_test(test_back_of_plane_is_turned),
        cmocka_unit_test(test_sphere), cmocka_unit_test(test_corner),
        cmocka_unit_test(test_groove)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
