/* SPDX-License-Identifier: MIT */
/*
 * Models at map coordinates: the same picture as near zero. In float, 5.4e6 has steps of
 * half a unit, and 5e5 of 1/32.
 */
#include "test_scene_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 25, WIDTH = 96, HEIGHT = 60 };

static const double far_away[3] = {512345.37, 120.5, 5412345.71};
static const double nowhere[3] = {0, 0, 0};

/* A smooth terrain, 12 units wide. */
static void point(int column, int row, const double offset[3], double p[3])
{
    const double x = 0.5 * (column - 12), z = 0.5 * (row - 12);
    p[0] = offset[0] + x;
    p[1] = offset[1] + sin(x * 0.9) * cos(z * 0.8);
    p[2] = offset[2] + z;
}

typedef struct buffer {
    char data[400000];
    size_t size;
} buffer;

static void put(buffer *b, const void *data, size_t size)
{
    assert_true(b->size + size <= sizeof b->data);
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

static void put_text(buffer *b, const char *text)
{
    put(b, text, strlen(text));
}

/* "%d" of the format: the vertex's index, counted from `base`. */
static void put_faces(buffer *b, const char *format, int base)
{
    char line[100];
    for (int i = 0; i < (SIDE - 1) * (SIDE - 1); i++) {
        const int a = i / (SIDE - 1) * SIDE + i % (SIDE - 1) + base;
        snprintf(line, sizeof line, format, a, a + SIDE, a + SIDE + 1, a + 1);
        put_text(b, line);
    }
}

static const char *write_obj(const double offset[3])
{
    static buffer b;
    b.size = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        char line[100];
        double p[3];
        point(i % SIDE, i / SIDE, offset, p);
        snprintf(line, sizeof line, "v %.7f\t%.7f %.7f 0.5 0.5 0.5\n", p[0], p[1], p[2]);
        put_text(&b, line);
    }
    put_faces(&b, "f %d %d %d %d\n", 1);
    return write_file("terrain.obj", b.data, b.size);
}

static void put_ply_header(buffer *b, const char *format)
{
    char text[400];
    snprintf(text, sizeof text,
             "ply\nformat %s 1.0\nelement vertex %d\nproperty uchar red\n"
             "property double x\nproperty double y\nproperty double z\n"
             "element face %d\nproperty list uchar int vertex_indices\nend_header\n",
             format, SIDE * SIDE, (SIDE - 1) * (SIDE - 1));
    put_text(b, text);
}

static const char *write_ascii_ply(const double offset[3])
{
    static buffer b;
    b.size = 0;
    put_ply_header(&b, "ascii");
    for (int i = 0; i < SIDE * SIDE; i++) {
        char line[100];
        double p[3];
        point(i % SIDE, i / SIDE, offset, p);
        snprintf(line, sizeof line, "200 %.7f %.7f %.7f\n", p[0], p[1], p[2]);
        put_text(&b, line);
    }
    put_faces(&b, "4 %d %d %d %d\n", 0);
    return write_file("terrain.ply", b.data, b.size);
}

static void put_number(buffer *b, const void *number, size_t size, bool big)
{
    const uint16_t one = 1;
    const bool swap = (*(const unsigned char *)&one == 0) != big;
    unsigned char bytes[8];
    for (size_t i = 0; i < size; i++)
        bytes[i] = ((const unsigned char *)number)[swap ? size - 1 - i : i];
    put(b, bytes, size);
}

static const char *write_binary_ply(const double offset[3], bool big)
{
    static buffer b;
    b.size = 0;
    put_ply_header(&b, big ? "binary_big_endian" : "binary_little_endian");
    for (int i = 0; i < SIDE * SIDE; i++) {
        double p[3];
        point(i % SIDE, i / SIDE, offset, p);
        put(&b, "\xc8", 1);
        for (int k = 0; k < 3; k++)
            put_number(&b, &p[k], sizeof p[k], big);
    }
    for (int i = 0; i < (SIDE - 1) * (SIDE - 1); i++) {
        const int32_t a = i / (SIDE - 1) * SIDE + i % (SIDE - 1);
        const int32_t corners[4] = {a, a + SIDE, a + SIDE + 1, a + 1};
        put(&b, "\x04", 1);
        for (int k = 0; k < 4; k++)
            put_number(&b, &corners[k], sizeof corners[k], big);
    }
    return write_file("terrain.ply", b.data, b.size);
}

/* The depth buffer of the terrain, from a camera that is moved with it. */
static void cast(const char *path, const double offset[3], float depth[WIDTH * HEIGHT])
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    double lower[3], upper[3];
    scene_view view = {.projection = CRV_PERSPECTIVE,
                       .eye = {offset[0] + 5, offset[1] + 4, offset[2] + 6},
                       .target = {offset[0], offset[1], offset[2]},
                       .up = {0, 1, 0},
                       .vfov_rad = 0.8f};
    if (scene_load(path, &s, &log))
        fail_msg("%s", m.error);
    assert_int_equal(m.errors + m.warnings, 0);
    scene_bounds(s, lower, upper);
    for (int i = 0; i < 3; i += 2) {
        assert_true(fabs(lower[i] - offset[i] + 6.0) < 1e-6);
        assert_true(fabs(upper[i] - offset[i] - 6.0) < 1e-6);
    }
    const scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    scene_gbuffer g = render(s, &request);
    memcpy(depth, g.depth[0], WIDTH * HEIGHT * sizeof *depth);
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* Floats of 6 units have steps of 5e-7; a ray that grazes a slope makes ten of that. */
static void assert_same(const float *a, const float *b)
{
    int surface = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        surface += isfinite(a[i]);
        if (isfinite(a[i]) && isfinite(b[i]))
            assert_true(fabs((double)a[i] - (double)b[i]) < 5e-6 * (double)a[i]);
    }
    assert_true(surface > WIDTH * HEIGHT / 4);
}

static void test_terrain(void **state)
{
    static float near_depth[WIDTH * HEIGHT], far_depth[WIDTH * HEIGHT];
    (void)state;
    cast(write_obj(nowhere), nowhere, near_depth);
    cast(write_obj(far_away), far_away, far_depth);
    assert_same(near_depth, far_depth);
    cast(write_ascii_ply(far_away), far_away, far_depth);
    assert_same(near_depth, far_depth);
    for (int big = 0; big < 2; big++) {
        cast(write_binary_ply(nowhere, big), nowhere, far_depth);
        assert_same(near_depth, far_depth);
        cast(write_binary_ply(far_away, big), far_away, far_depth);
        assert_same(near_depth, far_depth);
    }
}

/* Damaged PLYs are left to the reader of them: nothing is read beyond their end. */
static void test_cut_ply(void **state)
{
    char copy[30000];
    const char *path = write_binary_ply(far_away, false);
    FILE *file = fopen(path, "rb");
    (void)state;
    assert_non_null(file);
    const size_t size = fread(copy, 1, sizeof copy, file);
    fclose(file);
    for (size_t length = 100; length < size; length += 977) {
        scene *s = NULL;
        if (scene_load(write_file("cut.ply", copy, length), &s, NULL) == 0)
            scene_free(s);
    }
}

/* A model whose own size is large has zero for its origin. */
static void test_near_is_not_moved(void **state)
{
    float local[3];
    const double world[3] = {1.0, 2.0, 1e-3};
    scene *s = load_text("near.obj", "v 0 0 0\nv 9 0 0\nv 0 9 90\nf 1 2 3\n");
    (void)state;
    scene_local_point(s, world, local);
    for (int i = 0; i < 3; i++)
        assert_true(fabsf(local[i] - (float)world[i]) <= 0.0f);
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_terrain),
        cmocka_unit_test(test_cut_ply),
        cmocka_unit_test(test_near_is_not_moved),
    };
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
