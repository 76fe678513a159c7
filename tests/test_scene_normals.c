/* SPDX-License-Identifier: MIT */
#include "test_scene_support.h"

#include "normals.h"

#include <stdlib.h>
#include <string.h>

#define CREASE_RAD (60.0 * PI / 180.0)

static const uint32_t cube_faces[36] = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5,
                                        0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6,
                                        0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};

static void assert_direction(const float n[3], double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    assert_true(fabs((double)n[0] - x / length) < 1e-6);
    assert_true(fabs((double)n[1] - y / length) < 1e-6);
    assert_true(fabs((double)n[2] - z / length) < 1e-6);
}

/* Right angles stay edges although the faces share their vertices. */
static void test_cube_keeps_edges(void **state)
{
    float positions[24], normals[108];
    (void)state;
    for (int v = 0; v < 8; v++)
        for (int i = 0; i < 3; i++)
            positions[3 * v + i] = (float)(v >> (2 - i) & 1);
    assert_true(smooth_normals(positions, 8, cube_faces, 12, CREASE_RAD, normals));
    for (int corner = 0; corner < 36; corner++) {
        /* Two triangles a face, in the order -x +x -y +y -z +z. */
        int axis = corner / 12, sign = corner / 6 % 2 ? 1 : -1;
        assert_direction(normals + 3 * corner, axis == 0 ? sign : 0, axis == 1 ? sign : 0,
                         axis == 2 ? sign : 0);
    }
}

/* The golden rectangle's corners. Around a vertex faces are turned by 41.8 degrees
 * against the next and by 70.5 against the one after it. */
static void icosahedron(float positions[36], uint32_t faces[60])
{
    static const uint32_t f[60] = {0, 11, 5, 0, 5,  1,  0,  1,  7,  0,  7, 10, 0, 10, 11,
                                   1, 5,  9, 5, 11, 4,  11, 10, 2,  10, 7, 6,  7, 1,  8,
                                   3, 9,  4, 3, 4,  2,  3,  2,  6,  3,  6, 8,  3, 8,  9,
                                   4, 9,  5, 2, 4,  11, 6,  2,  10, 8,  6, 7,  9, 8,  1};
    const float g = (float)(0.5 * (1.0 + sqrt(5.0)));
    const float p[36] = {-1, g,  0, 1, g,  0, -1, -g, 0, 1, -g, 0,  0, -1, g,  0, 1, g, 0,
                         -1, -g, 0, 1, -g, g, 0,  -1, g, 0, 1,  -g, 0, -1, -g, 0, 1};
    memcpy(positions, p, sizeof p);
    memcpy(faces, f, sizeof f);
}

/* All angles are alike there: the normals are radial. */
static void test_icosahedron_is_smooth(void **state)
{
    float positions[36], normals[180], apart[180];
    uint32_t faces[60], own[60];
    (void)state;
    icosahedron(positions, faces);
    assert_true(smooth_normals(positions, 12, faces, 20, 71.0 * PI / 180.0, normals));
    for (int corner = 0; corner < 60; corner++) {
        const float *p = positions + 3 * faces[corner];
        assert_direction(normals + 3 * corner, (double)p[0], (double)p[1], (double)p[2]);
    }
    /* The same where every triangle has vertices of its own. */
    for (uint32_t corner = 0; corner < 60; corner++) {
        memcpy(apart + 3 * corner, positions + 3 * faces[corner], 3 * sizeof *apart);
        own[corner] = corner;
    }
    float again[180];
    assert_true(smooth_normals(apart, 60, own, 20, 71.0 * PI / 180.0, again));
    assert_memory_equal(again, normals, sizeof normals);
    /* And edges where the crease angle is below the one between the faces. */
    assert_true(smooth_normals(positions, 12, faces, 20, 41.0 * PI / 180.0, normals));
    assert_true(memcmp(normals, again, sizeof normals) != 0);
}

/* Two triangles over a common edge along x, folded by this angle. */
static void fold(double angle_rad, float normals[18])
{
    const float p[12] = {
        0, 0, 0, 1, 0, 0, 0, 0, 1, 0, (float)sin(angle_rad), (float)-cos(angle_rad)};
    const uint32_t f[6] = {0, 2, 1, 0, 1, 3};
    assert_true(smooth_normals(p, 4, f, 2, CREASE_RAD, normals));
}

static void test_crease_angle(void **state)
{
    float normals[18];
    (void)state;
    fold(59.0 * PI / 180.0, normals);
    /* Both have a right angle at the first vertex: the mean is the bisector. */
    assert_direction(normals, 0, cos(29.5 * PI / 180.0), sin(29.5 * PI / 180.0));
    fold(61.0 * PI / 180.0, normals);
    assert_direction(normals, 0, 1, 0);
}

/* A cone's tip where 20 000 faces meet must not take 20 000^2 steps. */
static void test_huge_fan(void **state)
{
    enum { FACES = 20000 };
    float *positions = malloc(3 * (FACES + 1) * sizeof *positions);
    uint32_t *faces = malloc(3 * FACES * sizeof *faces);
    float *normals = malloc(9 * FACES * sizeof *normals);
    (void)state;
    assert_true(positions && faces && normals);
    memset(positions, 0, 3 * sizeof *positions);
    for (uint32_t i = 0; i < FACES; i++) {
        double angle = 2.0 * PI * i / FACES;
        float *p = positions + 3 * (i + 1);
        p[0] = (float)cos(angle);
        p[1] = -0.2f;
        p[2] = (float)-sin(angle);
        faces[3 * i] = 0;
        faces[3 * i + 1] = 1 + i;
        faces[3 * i + 2] = 1 + (i + 1) % FACES;
    }
    assert_true(smooth_normals(positions, FACES + 1, faces, FACES, CREASE_RAD, normals));
    /* The tip's is along the axis; sampling every 40th face keeps the symmetry. */
    for (size_t i = 0; i < FACES; i++)
        assert_true(normals[9 * i + 1] > 0.9999f);
    free(positions);
    free(faces);
    free(normals);
}

/* A triangle without area gets no normal and does not disturb its neighbours. */
static void test_degenerate(void **state)
{
    const float p[15] = {0, 0, 0, 1, 0, 0, 0, 0, -1, 2, 0, 0, NAN, 0, 0};
    const uint32_t f[9] = {0, 1, 2, 0, 1, 3, 0, 1, 4};
    float normals[27];
    (void)state;
    assert_true(smooth_normals(p, 5, f, 3, CREASE_RAD, normals));
    for (int corner = 0; corner < 3; corner++)
        assert_direction(normals + 3 * corner, 0, 1, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cube_keeps_edges),
        cmocka_unit_test(test_icosahedron_is_smooth), cmocka_unit_test(test_crease_angle),
        cmocka_unit_test(test_huge_fan), cmocka_unit_test(test_degenerate)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
