/* SPDX-License-Identifier: MIT */
#include "test_scene_support.h"

#include <stdio.h>

#include <stdio.h>
#include <string.h>

/* The box's corners as seen: largest and smallest x, y in units of the picture's half
 * size. All must be before the eye. */
typedef struct seen_box {
    double low[2], high[2];
} seen_box;

static seen_box see_box(const scene *s, const scene_view *view, double aspect)
{
    seen_box box = {{1e9, 1e9}, {-1e9, -1e9}};
    double half = tan(0.5 * (double)view->vfov_rad);
    scene_gbuffer g = {.view = *view};
    double bound[2][3];
    double axis[3][3];
    for (int k = 0; k < 3; k++) {
        const float unit[3] = {k == 0, k == 1, k == 2};
        to_world(&g, unit, axis[k]);
    }
    scene_bounds(s, bound[0], bound[1]);
    for (int corner = 0; corner < 8; corner++) {
        double p[3], seen[2];
        for (int i = 0; i < 3; i++)
            p[i] = bound[corner >> i & 1][i] - view->eye[i];
        assert_true(dot(p, axis[2]) < 0.0);
        seen[0] = dot(p, axis[0]) / (-dot(p, axis[2]) * half * aspect);
        seen[1] = dot(p, axis[1]) / (-dot(p, axis[2]) * half);
        for (int i = 0; i < 2; i++) {
            box.low[i] = fmin(box.low[i], seen[i]);
            box.high[i] = fmax(box.high[i], seen[i]);
        }
    }
    return box;
}

static scene *box_scene(double x, double y, double z, double offset)
{
    char text[1024];
    snprintf(text, sizeof text,
             "v %g %g %g\nv %g %g %g\nv %g %g %g\nv %g %g %g\nf 1 2 3\nf 1 3 4\n", offset,
             0.0, 0.0, offset + x, 0.0, 0.0, offset + x, y, z, offset, y, z * 0.5);
    return load_text("frame.obj", text);
}

static void check_framing(const scene *s, double vfov, double aspect)
{
    scene_view view;
    double reach = 0.0;
    scene_frame(s, (float)vfov, (float)aspect, &view);
    seen_box box = see_box(s, &view, aspect);
    for (int i = 0; i < 2; i++) {
        /* In the middle, to a hundredth of the picture. */
        assert_true(fabs(box.low[i] + box.high[i]) < 0.02);
        assert_true(box.low[i] > -1.0 && box.high[i] < 1.0);
        reach = fmax(reach, fmax(-box.low[i], box.high[i]));
    }
    /* Filled but for the margin of 5 %. */
    assert_true(reach > 0.9 && reach < 0.97);
    assert_true(view.eye[1] > view.target[1]);
}

static void test_shows_whole_box(void **state)
{
    static const double size[][4] = {
        {1, 1, 1, 0},   {10, 1, 2, 0},      {1, 10, 1, 300}, {1e-3, 2e-3, 1e-3, 0},
        {2, 0.2, 2, 0}, {1e6, 1e5, 1e6, 0}, {1, 1, 0, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        scene *s = box_scene(size[i][0], size[i][1], size[i][2], size[i][3]);
        check_framing(s, 0.7, 16.0 / 9.0);
        check_framing(s, 0.2, 0.5);
        check_framing(s, 1.8, 1.0);
        scene_free(s);
    }
}

static void test_builtin_view_adapts(void **state)
{
    scene *s = NULL;
    scene_view narrow, wide;
    double n[3], w[3];
    (void)state;
    assert_int_equal(scene_builtin("courtyard", &s, NULL), 0);
    scene_frame(s, 0.4f, 16.0f / 9.0f, &narrow);
    scene_frame(s, 1.2f, 16.0f / 9.0f, &wide);
    for (int i = 0; i < 3; i++) {
        assert_true(narrow.target[i] == wide.target[i]);
        n[i] = narrow.eye[i] - narrow.target[i];
        w[i] = wide.eye[i] - wide.target[i];
    }
    /* As much is seen at the target: distance times the tangent stays. */
    assert_true(fabs(sqrt(dot(n, n)) * tan(0.2) - sqrt(dot(w, w)) * tan(0.6)) < 1e-4);
    scene_free(s);
}

static void test_radius(void **state)
{
    const double eye[3] = {0, 0, 10}, target[3] = {0, 0, 0};
    scene *s = box_scene(100, 100, 100, 0);
    scene_view view = look(CRV_ORTHOGRAPHIC, eye, target, 10.0);
    (void)state;
    /* sqrt(2) * 10 / 20 = 0.7071, to two digits. */
    assert_true(fabs((double)scene_suggest_radius(s, &view) - 0.71) < 1e-6);
    /* 2 * 10 tan(22.5 deg) * sqrt(2) / 20 = 0.5858. */
    view.projection = CRV_PERSPECTIVE;
    assert_true(fabs((double)scene_suggest_radius(s, &view) - 0.59) < 1e-6);
    /* Never more than a twentieth of the scene: sqrt(3) * 100 / 20 = 8.66. */
    view = look(CRV_ORTHOGRAPHIC, eye, target, 1e6);
    assert_true(fabs((double)scene_suggest_radius(s, &view) - 8.7) < 1e-5);
    scene_free(s);
}

/* Depth in the middle of the picture and one unit to the right of it or above it, in an
 * orthographic view that is 6 units high. */
static void check_depths(const char *name, int32_t dx, int32_t dy, double middle,
                         double beside)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    scene_view view;
    assert_int_equal(scene_builtin(name, &s, &log), 0);
    scene_frame(s, 1.0f, 16.0f / 9.0f, &view);
    assert_int_equal(view.projection, CRV_ORTHOGRAPHIC);
    assert_true(fabs((double)view.view_height - 6.0) < 1e-5);
    /* 10 px a unit, with a pixel's centre in the middle of the picture. */
    view.view_height = 6.1f;
    const scene_gbuffer_request request = request_of(&view, 109, 61);
    scene_gbuffer g = render(s, &request);
    assert_true(fabs((double)g.depth[0][30 * 109 + 54] - middle) < 2e-6 * middle);
    assert_true(fabs((double)g.depth[0][(30 - dy) * 109 + 54 + dx] - beside)
                < 2e-6 * beside);
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* A wall of the groove rises by cot(angle / 2) for each unit off the edge, a tilted plane
 * falls back by tan(tilt) for each unit up. Planes are exact to float rounding. */
static void test_builtin_parameters(void **state)
{
    static const char *const refused[] = {
        "groove,angle=180", "groove,angle=", "groove,angle=60x", "groove,tilt=60",
        "plane?tilt=60",    "plane,",        "corner,tilt=1",    "plane,tilt=60,",
    };
    static const double angles[] = {30, 60, 90, 120, 150};
    static const double tilts[] = {0, 45, 60, 80, 88};
    char name[40];
    (void)state;
    for (int i = 0; i < 5; i++) {
        snprintf(name, sizeof name, "groove,angle=%g", angles[i]);
        check_depths(name, 10, 0, 20.0, 20.0 - 1.0 / tan(angles[i] * PI / 360.0));
        const double slope = tan(tilts[i] * PI / 180.0), distance = 20.0 + 8.0 * slope;
        snprintf(name, sizeof name, "plane,tilt=%g", tilts[i]);
        check_depths(name, 0, 10, distance, distance + slope);
    }
    check_depths("groove", 10, 0, 20.0, 19.0);
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        messages m;
        crv_logger log = catch_messages(&m);
        scene *s = NULL;
        assert_int_equal(scene_builtin_check(refused[i], &log), -1);
        assert_int_equal(scene_builtin(refused[i], &s, NULL), -1);
        assert_null(s);
        snprintf(name, sizeof name, "builtin:%s", refused[i]);
        assert_error_line(&m, name);
    }
    assert_string_equal(scene_builtin_parameter(4, 0)->key, "angle");
    assert_null(scene_builtin_parameter(0, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shows_whole_box),
                                       cmocka_unit_test(test_builtin_view_adapts),
                                       cmocka_unit_test(test_radius),
                                       cmocka_unit_test(test_builtin_parameters)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
