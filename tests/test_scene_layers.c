/* SPDX-License-Identifier: MIT */
/*
 * Further layers of boxes, whose entries and exits are known from the slab test.
 */
#include "test_scene_support.h"

#include <stdio.h>
#include <string.h>

enum { WIDTH = 64, HEIGHT = 48 };

#define TOLERANCE 1e-6

/* Appends a closed box about (x, 0, 0) to OBJ text; `first` vertices precede it. */
static void append_box(char *text, size_t size, double x, double half, int first)
{
    static const int face[6][4] = {{1, 2, 4, 3}, {5, 7, 8, 6}, {1, 5, 6, 2},
                                   {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}};
    for (int v = 0; v < 8; v++)
        snprintf(text + strlen(text), size - strlen(text), "v %g %g %g\n",
                 x + (v & 4 ? half : -half), v & 2 ? half : -half, v & 1 ? half : -half);
    for (int f = 0; f < 6; f++)
        snprintf(text + strlen(text), size - strlen(text), "f %d %d %d %d\n",
                 first + face[f][0], first + face[f][1], first + face[f][2],
                 first + face[f][3]);
}

/* Where the ray enters and leaves the box; false where it misses. */
static bool cross_box(const ray *r, double x, double half, double *enter, double *leave)
{
    *enter = -1e30;
    *leave = 1e30;
    for (int i = 0; i < 3; i++) {
        double middle = i == 0 ? x : 0.0;
        double a = (middle - half - r->origin[i]) / r->direction[i];
        double b = (middle + half - r->origin[i]) / r->direction[i];
        *enter = fmax(*enter, fmin(a, b));
        *leave = fmin(*leave, fmax(a, b));
    }
    return *enter < *leave - 1e-3; /* rays along an edge may go either way */
}

static bool grazes(const ray *r, double x, double half)
{
    double a, b;
    cross_box(r, x, half, &a, &b);
    return fabs(a - b) <= 1e-3;
}

static void assert_depth(float found, double expected)
{
    if (isfinite(expected))
        assert_true(fabs((double)found - expected) <= TOLERANCE * expected);
    else
        assert_true(isinf(found) && found > 0.0f);
}

static scene_gbuffer render_layers(const scene *s, crv_projection projection,
                                   crv_layers kind, int32_t layers)
{
    static const double eye[3] = {3.1, 2.2, 4.3}, target[3] = {0.1, 0.05, 0};
    scene_view view = look(projection, eye, target, 4.0);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    request.layers = layers;
    request.layer_kind = kind;
    return render(s, &request);
}

static void check_nested(crv_projection projection, crv_layers kind)
{
    char text[4096] = "";
    int inner_hits = 0;
    append_box(text, sizeof text, 0.0, 1.0, 0);
    append_box(text, sizeof text, 0.0, 0.5, 8);
    scene *s = load_text("nested.obj", text);
    scene_gbuffer g = render_layers(s, projection, kind, 4);
    assert_int_equal(g.desc.layer_kind,
                     kind == CRV_LAYERS_SOLID ? CRV_LAYERS_SOLID : CRV_LAYERS_SURFACES);
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            int32_t pixel = y * WIDTH + x;
            double in[2], out[2], next[4] = {INFINITY, INFINITY, INFINITY, INFINITY};
            ray r = ray_of_pixel(&g, x, y);
            bool outer = cross_box(&r, 0.0, 1.0, &in[0], &out[0]);
            bool inner = cross_box(&r, 0.0, 0.5, &in[1], &out[1]);
            int count = 0;
            if (grazes(&r, 0.0, 1.0) || grazes(&r, 0.0, 0.5))
                continue;
            if (outer)
                next[count++] = in[0];
            if (inner && kind == CRV_LAYERS_SURFACES)
                next[count++] = in[1];
            if (inner)
                next[count++] = out[1];
            /* Fronts and backs: nothing faces the viewer beyond the inner box's back. */
            if (outer && !(inner && kind == CRV_LAYERS_SOLID))
                next[count++] = out[0];
            inner_hits += inner;
            for (int layer = 0; layer < 4; layer++)
                assert_depth(g.depth[layer][pixel], next[layer]);
        }
    assert_true(inner_hits > 50);
    scene_gbuffer_free(&g);
    scene_free(s);
}

static void test_next_surfaces(void **state)
{
    (void)state;
    check_nested(CRV_PERSPECTIVE, CRV_LAYERS_SURFACES);
    check_nested(CRV_ORTHOGRAPHIC, CRV_LAYERS_SURFACES);
}

static void test_back_faces(void **state)
{
    (void)state;
    check_nested(CRV_PERSPECTIVE, CRV_LAYERS_SOLID);
    check_nested(CRV_ORTHOGRAPHIC, CRV_LAYERS_SOLID);
}

/* Two solids in a row are two pairs of layers, also where one begins in the very place
 * where the other ends. */
static void check_pairs(crv_projection projection, double gap)
{
    char text[4096] = "";
    const double x[2] = {0.5 + gap, -0.5};
    int both = 0;
    append_box(text, sizeof text, x[0], 0.5, 0);
    append_box(text, sizeof text, x[1], 0.5, 8);
    scene *s = load_text("pairs.obj", text);
    scene_gbuffer g = render_layers(s, projection, CRV_LAYERS_SOLID, 4);
    for (int32_t pixel = 0; pixel < WIDTH * HEIGHT; pixel++) {
        ray r = ray_of_pixel(&g, pixel % WIDTH, pixel / WIDTH);
        double expected[4] = {INFINITY, INFINITY, INFINITY, INFINITY};
        int count = 0;
        if (grazes(&r, x[0], 0.5) || grazes(&r, x[1], 0.5))
            continue;
        for (int box = 0; box < 2; box++) {
            double in, out;
            if (!cross_box(&r, x[box], 0.5, &in, &out))
                continue;
            expected[count++] = in;
            expected[count++] = out;
        }
        both += count == 4;
        for (int layer = 0; layer < 4; layer++)
            assert_depth(g.depth[layer][pixel], expected[layer]);
    }
    assert_true(both > 20);
    scene_gbuffer_free(&g);
    scene_free(s);
}

static void test_solids_in_a_row(void **state)
{
    (void)state;
    check_pairs(CRV_PERSPECTIVE, 0.3);
    check_pairs(CRV_ORTHOGRAPHIC, 0.3);
    check_pairs(CRV_PERSPECTIVE, 0.0);
    check_pairs(CRV_ORTHOGRAPHIC, 0.0);
}

/* A sheet with a front on both sides is a solid without thickness, whatever comes behind
 * it and whichever of its sides the ray caster happens to meet. */
static void check_sheet(const char *faces)
{
    char text[4096] = "";
    scene *s;
    int sheets = 0;
    append_box(text, sizeof text, 0.0, 0.5, 0);
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "v -1 -1 1.3\nv 1 -1 1.3\nv 1 1 1.3\nv -1 1 1.3\n%s", faces);
    s = load_text("sheet.obj", text);
    scene_gbuffer g = render_layers(s, CRV_PERSPECTIVE, CRV_LAYERS_SOLID, 2);
    for (int32_t pixel = 0; pixel < WIDTH * HEIGHT; pixel++) {
        ray r = ray_of_pixel(&g, pixel % WIDTH, pixel / WIDTH);
        double depth = (1.3 - r.origin[2]) / r.direction[2];
        double x = r.origin[0] + depth * r.direction[0];
        double y = r.origin[1] + depth * r.direction[1];
        /* Not on the diagonal, where a ray may meet either triangle or both. */
        if (fmax(fabs(x), fabs(y)) > 0.999 || fabs(x - y) < 1e-3)
            continue;
        sheets++;
        assert_depth(g.depth[0][pixel], depth);
        assert_depth(g.depth[1][pixel], depth);
    }
    assert_true(sheets > 200);
    scene_gbuffer_free(&g);
    scene_free(s);
}

static void test_sheet_has_no_thickness(void **state)
{
    (void)state;
    check_sheet("f 9 10 11\nf 9 11 12\nf 11 10 9\nf 12 11 9\n");
    check_sheet("f 11 10 9\nf 12 11 9\nf 9 10 11\nf 9 11 12\n");
}

static void test_coincident_surfaces_are_one(void **state)
{
    char text[4096] = "";
    int hits = 0;
    (void)state;
    append_box(text, sizeof text, 0.0, 1.0, 0);
    append_box(text, sizeof text, 0.0, 1.0, 8);
    scene *s = load_text("twice.obj", text);
    scene_gbuffer g = render_layers(s, CRV_PERSPECTIVE, CRV_LAYERS_SURFACES, 3);
    for (int32_t pixel = 0; pixel < WIDTH * HEIGHT; pixel++) {
        ray r = ray_of_pixel(&g, pixel % WIDTH, pixel / WIDTH);
        double in, out;
        if (grazes(&r, 0.0, 1.0) || !cross_box(&r, 0.0, 1.0, &in, &out))
            continue;
        hits++;
        assert_depth(g.depth[0][pixel], in);
        assert_depth(g.depth[1][pixel], out);
        assert_depth(g.depth[2][pixel], INFINITY);
    }
    assert_true(hits > 300);
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* Whatever the scene, layers lie one behind the other, and nothing is behind nothing. */
static void test_order(void **state)
{
    scene *s = NULL;
    scene_view view;
    (void)state;
    assert_int_equal(scene_builtin("courtyard", &s, NULL), 0);
    scene_frame(s, 0.7f, 16.0f / 9.0f, &view);
    scene_gbuffer_request request = request_of(&view, 160, 90);
    request.layers = 4;
    for (int kind = 0; kind < 2; kind++) {
        request.layer_kind = (crv_layers)kind;
        scene_gbuffer g = render(s, &request);
        for (int32_t pixel = 0; pixel < 160 * 90; pixel++)
            for (int layer = 1; layer < 4; layer++) {
                float front = g.depth[layer - 1][pixel], here = g.depth[layer][pixel];
                bool touching = kind == CRV_LAYERS_SOLID && here == front;
                assert_true(here > front || touching || (isinf(here) && isinf(front)));
            }
        scene_gbuffer_free(&g);
    }
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_next_surfaces),
                                       cmocka_unit_test(test_back_faces),
                                       cmocka_unit_test(test_solids_in_a_row),
                                       cmocka_unit_test(test_sheet_has_no_thickness),
                                       cmocka_unit_test(test_coincident_surfaces_are_one),
                                       cmocka_unit_test(test_order)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
