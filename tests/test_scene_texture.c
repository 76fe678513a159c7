/* SPDX-License-Identifier: MIT */
/*
 * Texture coordinates and their frames, against maps that are known in closed form.
 */
#include "test_scene_support.h"

#include <stdio.h>
#include <string.h>

enum { WIDTH = 72, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

/* Coordinates are a few units large and stored as floats, as are the mesh's. */
#define TOLERANCE 2e-6

static scene_gbuffer render_textured(const scene *s, const scene_view *view)
{
    scene_gbuffer_request request = request_of(view, WIDTH, HEIGHT);
    request.texture_frames = true;
    return render(s, &request);
}

static scene_gbuffer look_at_plane(const scene *s, crv_projection projection)
{
    static const double eye[3] = {1.5, 4, 6}, target[3] = {0.2, 0, 0};
    scene_view view = look(projection, eye, target, 5.0);
    return render_textured(s, &view);
}

/* (u, v) = m (x, z) + (0.3, -0.2) over the floor y = 0. */
typedef struct floor_map {
    double m[2][2];
} floor_map;

static void map_point(const floor_map *f, double x, double z, double uv[2])
{
    for (int i = 0; i < 2; i++)
        uv[i] = f->m[i][0] * x + f->m[i][1] * z + (i ? -0.2 : 0.3);
}

static void assert_vector(const scene_gbuffer *g, const float view[3], double x, double y,
                          double z)
{
    const double expected[3] = {x, y, z};
    double world[3], size = sqrt(dot(expected, expected));
    to_world(g, view, world);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(world[i] - expected[i]) <= 10 * TOLERANCE * size);
}

/* Every pixel's coordinates are those of the point that it sees, which perspective must
 * not bend, and its frame is the inverse of the map. */
static void assert_floor(const scene_gbuffer *g, const floor_map *f)
{
    double det = f->m[0][0] * f->m[1][1] - f->m[0][1] * f->m[1][0];
    int seen = 0;
    for (int pixel = 0; pixel < PIXELS; pixel++) {
        ray r = ray_of_pixel(g, pixel % WIDTH, pixel / WIDTH);
        double t = -r.origin[1] / r.direction[1], uv[2];
        if (isinf(g->depth[0][pixel]))
            continue;
        seen++;
        map_point(f, r.origin[0] + t * r.direction[0], r.origin[2] + t * r.direction[2],
                  uv);
        for (int i = 0; i < 2; i++)
            assert_true(fabs((double)g->uv[2 * pixel + i] - uv[i]) < 5 * TOLERANCE);
        assert_vector(g, g->tangent + 3 * pixel, f->m[1][1] / det, 0, -f->m[1][0] / det);
        assert_vector(g, g->bitangent + 3 * pixel, -f->m[0][1] / det, 0,
                      f->m[0][0] / det);
    }
    assert_true(seen > PIXELS / 2);
}

static const floor_map floor_maps[] = {{{{0.5, 0}, {0, 0.5}}},       /* as built in */
                                       {{{0.25, 0.125}, {-0.5, 1}}}, /* sheared */
                                       {{{-0.5, 0}, {0, 0.5}}},      /* mirrored */
                                       {{{0.125, 0.5}, {0.75, 0.25}}} /* both */};

/* OBJ has v up. */
static void test_obj(void **state)
{
    static const double corner[4][2] = {{-5, 4}, {5, 4}, {5, -5}, {-5, -5}};
    (void)state;
    for (size_t i = 0; i < sizeof floor_maps / sizeof *floor_maps; i++) {
        char text[1024] = "";
        for (int c = 0; c < 4; c++) {
            double uv[2];
            map_point(&floor_maps[i], corner[c][0], corner[c][1], uv);
            snprintf(text + strlen(text), sizeof text - strlen(text),
                     "v %g 0 %g\nvt %.9g %.9g\n", corner[c][0], corner[c][1], uv[0],
                     1.0 - uv[1]);
        }
        strcat(text, "f 1/1 2/2 3/3 4/4\n");
        scene *s = load_text("floor.obj", text);
        for (int projection = 0; projection < 2; projection++) {
            scene_gbuffer g =
                look_at_plane(s, projection ? CRV_ORTHOGRAPHIC : CRV_PERSPECTIVE);
            assert_floor(&g, &floor_maps[i]);
            scene_gbuffer_free(&g);
        }
        scene_free(s);
    }
}

/* glTF has v down, and a mirrored node. The mesh is half the floor's quad. */
static void test_gltf(void **state)
{
    static const float data[15] = {-9,    0,    9,    9,    0,    9,
                                   0,     0,    -27, /* then u, v */
                                   -4.2f, 4.3f, 4.8f, 4.3f, 0.3f, -13.7f};
    static const char *const scales[2] = {"1,1,1", "-1,1,1"};
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        char text[2048];
        scene *s;
        write_file("floor.bin", data, sizeof data);
        snprintf(
            text, sizeof text,
            "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
            "\"nodes\":[{\"mesh\":0,\"scale\":[%s]}],\"meshes\":[{\"primitives\":[{"
            "\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1}}]}],\"accessors\":[{"
            "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
            "\"min\":[-9,0,-27],\"max\":[9,0,9]},{\"bufferView\":1,\"componentType\":"
            "5126,"
            "\"count\":3,\"type\":\"VEC2\"}],\"bufferViews\":[{\"buffer\":0,"
            "\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24}],"
            "\"buffers\":[{\"byteLength\":60,\"uri\":\"floor.bin\"}]}",
            scales[mirrored]);
        s = load_text("floor.gltf", text);
        scene_gbuffer g = look_at_plane(s, CRV_PERSPECTIVE);
        assert_floor(&g, &floor_maps[mirrored ? 2 : 0]);
        scene_gbuffer_free(&g);
        scene_free(s);
    }
}

/* Without coordinates, with one point for all and with a line, there is no frame. */
static void test_none(void **state)
{
    static const char *const faces[] = {
        "f 1 2 3\n", "vt 0.3 0.7\nf 1/1 2/1 3/1\n",
        "vt 0.1 0.1\nvt 0.7 0.7\nvt 0.3 0.3\nf 1/1 2/2 3/3\n"};
    (void)state;
    for (size_t i = 0; i < sizeof faces / sizeof *faces; i++) {
        char text[256] = "v -2 0 2\nv 2 0 2\nv 0 0 -3\n";
        int seen = 0;
        strcat(text, faces[i]);
        scene *s = load_text("none.obj", text);
        scene_gbuffer g = look_at_plane(s, CRV_PERSPECTIVE);
        for (int pixel = 0; pixel < PIXELS; pixel++) {
            seen += isfinite(g.depth[0][pixel]) != 0;
            assert_true(isnan(g.uv[2 * pixel]) && isnan(g.uv[2 * pixel + 1]));
            for (int c = 0; c < 3; c++) {
                assert_true(g.tangent[3 * pixel + c] == 0.0f);
                assert_true(g.bitangent[3 * pixel + c] == 0.0f);
            }
        }
        assert_true(seen > 100 && seen < PIXELS);
        scene_gbuffer_free(&g);
        scene_free(s);
    }
}

static void test_only_on_request(void **state)
{
    scene *s = NULL;
    scene_view view;
    (void)state;
    assert_int_equal(scene_builtin("plane", &s, NULL), 0);
    scene_frame(s, 0.8f, 1.5f, &view);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    scene_gbuffer g = render(s, &request);
    assert_null(g.uv);
    assert_null(g.tangent);
    assert_null(g.bitangent);
    scene_gbuffer_free(&g);
    request.texture_frames = true;
    g = render(s, &request);
    scene_gbuffer_free(&g);
    assert_null(g.uv);
    assert_null(g.tangent);
    assert_null(g.bitangent);
    scene_free(s);
}

static scene *make_builtin(const char *name, scene_gbuffer *g)
{
    scene *s = NULL;
    scene_view view;
    assert_int_equal(scene_builtin(name, &s, NULL), 0);
    scene_frame(s, 0.8f, (float)WIDTH / HEIGHT, &view);
    *g = render_textured(s, &view);
    return s;
}

/* The map is 2 units large: on the floor as on the wall x = 0. */
static void test_corner(void **state)
{
    scene_gbuffer g;
    scene *s = make_builtin("corner", &g);
    int floor = 0, wall = 0;
    (void)state;
    for (int pixel = 0; pixel < PIXELS; pixel++) {
        ray r = ray_of_pixel(&g, pixel % WIDTH, pixel / WIDTH);
        double p[3], n[3], t = (double)g.depth[0][pixel];
        if (isinf(g.depth[0][pixel]))
            continue;
        for (int i = 0; i < 3; i++)
            p[i] = r.origin[i] + t * r.direction[i];
        to_world(&g, g.normals + 3 * pixel, n);
        const double u = n[1] > 0.5 ? p[0] / 2 : -p[2] / 2;
        const double v = n[1] > 0.5 ? p[2] / 2 : -p[1] / 2;
        floor += n[1] > 0.5;
        wall += n[0] > 0.5;
        assert_true(fabs((double)g.uv[2 * pixel] - u) < 5 * TOLERANCE);
        assert_true(fabs((double)g.uv[2 * pixel + 1] - v) < 5 * TOLERANCE);
    }
    assert_true(floor > PIXELS / 10 && wall > PIXELS / 10);
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* The ball of radius 1 about (0, 1, 0): longitude eastwards, latitude from the north
 * pole. 512 segments: a triangle's frame is off by half a segment's turn, 0.7 degrees. */
static void test_sphere(void **state)
{
    const double tolerance = 0.02;
    scene_gbuffer g;
    scene *s = make_builtin("sphere", &g);
    int seen = 0;
    (void)state;
    for (int pixel = 0; pixel < PIXELS; pixel++) {
        double n[3], t[3], b[3];
        to_world(&g, g.normals + 3 * pixel, n);
        const double across = sqrt(n[0] * n[0] + n[2] * n[2]);
        if (isinf(g.depth[0][pixel]) || fabs(n[1]) > 0.9)
            continue;
        seen++;
        double u = atan2(-n[2], n[0]) / (2 * PI);
        const double v = acos(n[1]) / PI;
        u -= floor(u - (double)g.uv[2 * pixel] + 0.5);
        assert_true(fabs((double)g.uv[2 * pixel] - u) < 1e-4);
        assert_true(fabs((double)g.uv[2 * pixel + 1] - v) < 1e-4);
        to_world(&g, g.tangent + 3 * pixel, t);
        to_world(&g, g.bitangent + 3 * pixel, b);
        assert_true(fabs(t[0] / (2 * PI) - n[2]) < tolerance);
        assert_true(fabs(t[1] / (2 * PI)) < tolerance);
        assert_true(fabs(t[2] / (2 * PI) + n[0]) < tolerance);
        assert_true(fabs(b[0] / PI - n[0] * n[1] / across) < tolerance);
        assert_true(fabs(b[1] / PI + across) < tolerance);
        assert_true(fabs(b[2] / PI - n[2] * n[1] / across) < tolerance);
    }
    assert_true(seen > PIXELS / 20);
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* In every built-in scene maps are upright and not mirrored: seen from the front, u goes
 * to the right of where v goes down, so that bitangent x tangent is the outer normal. All
 * of the scenes for height maps is covered; the courtyard in part. */
static void test_builtin_maps_are_not_mirrored(void **state)
{
    static const char *const names[] = {"relief", "plane",  "sphere",
                                        "corner", "groove", "courtyard"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        scene_gbuffer g;
        scene *s = make_builtin(names[i], &g);
        int seen = 0, mapped = 0;
        for (int pixel = 0; pixel < PIXELS; pixel++) {
            const float *t = g.tangent + 3 * pixel, *b = g.bitangent + 3 * pixel;
            const float *n = g.normals + 3 * pixel;
            seen += isfinite(g.depth[0][pixel]) != 0;
            if (isnan(g.uv[2 * pixel]))
                continue;
            mapped++;
            assert_true((b[1] * t[2] - b[2] * t[1]) * n[0]
                            + (b[2] * t[0] - b[0] * t[2]) * n[1]
                            + (b[0] * t[1] - b[1] * t[0]) * n[2]
                        > 0.0f);
        }
        assert_true(mapped > PIXELS / 4);
        if (strcmp(names[i], "courtyard") != 0)
            assert_int_equal(seen, mapped);
        scene_gbuffer_free(&g);
        scene_free(s);
    }
}

/* The library takes what is rendered as it is. */
static void test_library_takes_it(void **state)
{
    scene_gbuffer g;
    scene *s = make_builtin("relief", &g);
    float map[4] = {0.0f, 1.0f, 0.5f, 0.25f};
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_height_field field = {
        .uv = crv_const_image_packed(g.uv, WIDTH, HEIGHT, 2),
        .tangent = crv_const_image_packed(g.tangent, WIDTH, HEIGHT, 3),
        .bitangent = crv_const_image_packed(g.bitangent, WIDTH, HEIGHT, 3),
        .height = crv_const_image_packed(map, 2, 2, 1),
        .scale = 0.1f,
        .wrap = CRV_WRAP_REPEAT};
    (void)state;
    assert_int_equal(crv_context_create(NULL, &context), CRV_OK);
    assert_int_equal(scene_gbuffer_upload(&g, context, &gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_height_field(gbuffer, &field), CRV_OK);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
    scene_gbuffer_free(&g);
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_obj),
        cmocka_unit_test(test_gltf),
        cmocka_unit_test(test_none),
        cmocka_unit_test(test_only_on_request),
        cmocka_unit_test(test_corner),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_builtin_maps_are_not_mirrored),
        cmocka_unit_test(test_library_takes_it)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
