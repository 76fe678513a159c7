/* SPDX-License-Identifier: MIT */
/*
 * Scenes of thin things, on which a depth buffer says least: grass, leaves, bars.
 */
#include "builtin.h"

#define GROUND 6.0 /* half its size */

static double between(uint64_t *random, double low, double high)
{
    return low + (high - low) * builtin_random(random);
}

/* A direction with even density. */
static vec3 any_direction(uint64_t *random)
{
    const double z = between(random, -1.0, 1.0), r = sqrt(fmax(0.0, 1.0 - z * z));
    const double angle = between(random, 0.0, 2.0 * SCENE_PI);
    return v3(r * cos(angle), r * sin(angle), z);
}

static void add_ground(mesh *m, const place *world)
{
    mesh_set_colour(m, 0.55, 0.5, 0.42);
    shape_quad(m, world, v3(-GROUND, 0, GROUND), v3(GROUND, 0, GROUND),
               v3(GROUND, 0, -GROUND), v3(-GROUND, 0, -GROUND));
}

static void add_box(mesh *m, const place *at, vec3 centre, double hx, double hy,
                    double hz)
{
    const vec3 half = v3(hx, hy, hz);
    shape_box(m, at, v3_sub(centre, half), v3_add(centre, half), 0.0);
}

static void add_bar(mesh *m, const place *at, vec3 from, vec3 to, double radius)
{
    const vec3 points[2] = {from, to};
    shape_tube(m, at, points, 2, radius, 8);
}

/* A lawn with stones in it. */
void builtin_blades(mesh *m, scene_view *view, const double *p)
{
    enum { TUFTS = 420, BLADES = 22, STONES = 12 };
    const place world = place_at(0, 0, 0);
    uint64_t random = (uint64_t)p[0];
    add_ground(m, &world);
    for (int i = 0; i < TUFTS; i++) {
        const double x = between(&random, -3.2, 3.2);
        const place at = place_at(x, 0.0, between(&random, -3.2, 3.2));
        const double green = builtin_random(&random);
        mesh_set_colour(m, 0.24 + 0.12 * green, 0.36 + 0.10 * green, 0.13);
        builtin_tuft(m, &at, 0.16, between(&random, 0.14, 0.36), BLADES,
                     (uint64_t)(between(&random, 0.0, 1e9)));
    }
    mesh_set_colour(m, 0.5, 0.5, 0.52);
    for (int i = 0; i < STONES; i++) {
        const double x = between(&random, -2.2, 2.2), z = between(&random, -2.2, 2.2);
        const place at =
            place_turned(&world, v3(x, 0, z), between(&random, 0.0, SCENE_PI));
        const double high = between(&random, 0.08, 0.2);
        add_box(m, &at, v3(0, high, 0), between(&random, 0.08, 0.25), high,
                between(&random, 0.08, 0.25));
    }
    *view = builtin_perspective(v3(0.4, 1.5, 3.6), v3(0, 0.1, 0), 45);
}

/* A rhomb that lies anyhow, longer than it is wide. */
static void add_leaf(mesh *m, const place *at, vec3 centre, double length,
                     uint64_t *random)
{
    const vec3 along = v3_scale(any_direction(random), 0.5 * length);
    const vec3 side = v3_cross(along, any_direction(random));
    const vec3 across = v3_scale(v3_normalise(side), 0.2 * length);
    shape_quad(m, at, v3_sub(centre, along), v3_add(centre, across),
               v3_add(centre, along), v3_sub(centre, across));
}

/* Small trees. */
void builtin_leaves(mesh *m, scene_view *view, const double *p)
{
    enum { TREES = 5, LEAVES = 1500 };
    const place world = place_at(0, 0, 0);
    uint64_t random = (uint64_t)p[0];
    add_ground(m, &world);
    for (int i = 0; i < TREES; i++) {
        const double x = -1.6 + 0.8 * i + between(&random, -0.25, 0.25);
        const vec3 crown = v3(x, between(&random, 0.8, 1.3), between(&random, -1.5, 1.0));
        mesh_set_colour(m, 0.36, 0.27, 0.2);
        add_bar(m, &world, v3(crown.x, 0, crown.z), crown, 0.03);
        for (int k = 0; k < LEAVES; k++) {
            const double green = builtin_random(&random);
            const double distance = 0.6 * cbrt(between(&random, 0.02, 1.0));
            const vec3 at = v3_along(crown, any_direction(&random), distance);
            if (k % 50 == 0)
                mesh_set_colour(m, 0.2 + 0.15 * green, 0.4 + 0.1 * green, 0.14);
            add_leaf(m, &world, at, between(&random, 0.06, 0.14), &random);
        }
    }
    *view = builtin_perspective(v3(0.5, 1.5, 4.4), v3(0, 0.75, -0.2), 45);
}

static void add_fence(mesh *m, const place *at, double width, double height)
{
    const int posts = (int)(width / 0.1);
    for (int i = 0; i <= posts; i++) {
        const double x = -0.5 * width + width * i / posts;
        add_bar(m, at, v3(x, 0, 0), v3(x, height, 0), 0.012);
    }
    for (int i = 0; i < 2; i++) {
        const double y = i ? height - 0.05 : 0.15;
        add_bar(m, at, v3(-0.5 * width, y, 0), v3(0.5 * width, y, 0), 0.02);
    }
}

static void add_table(mesh *m, const place *at, uint64_t *random)
{
    for (int leg = 0; leg < 4; leg++) {
        const double x = leg & 1 ? 0.3 : -0.3, z = leg & 2 ? 0.25 : -0.25;
        add_bar(m, at, v3(x, 0, z), v3(x, 0.5, z), 0.02);
    }
    add_box(m, at, v3(0, 0.52, 0), 0.38, 0.02, 0.33);
    for (int i = 0; i < 4; i++)
        add_box(m, at, v3(-0.25 + 0.17 * i, 0.59, between(random, -0.2, 0.2)), 0.05, 0.05,
                0.05);
}

static void add_shelf(mesh *m, const place *at, uint64_t *random)
{
    for (int i = 0; i < 5; i++)
        add_box(m, at, v3(0, 0.3 + 0.35 * i, 0), 0.5, 0.015, 0.2);
    for (int i = 0; i < 40; i++) {
        const double x = between(random, -0.4, 0.4);
        const double y = 0.3 + 0.35 * (i % 5) + 0.1;
        add_box(m, at, v3(x, y, between(random, -0.1, 0.1)), 0.02, 0.085, 0.08);
    }
}

/* A yard: fence, tables, a stair of slats, shelves, poles that lean on the wall. */
void builtin_bars(mesh *m, scene_view *view, const double *p)
{
    const place world = place_at(0, 0, 0), fence = place_at(0, 0, -0.8);
    const place shelf = place_at(-2.8, 0, -2.2);
    uint64_t random = (uint64_t)p[0];
    add_ground(m, &world);
    mesh_set_colour(m, 0.66, 0.64, 0.6);
    shape_quad(m, &world, v3(-GROUND, 0, -2.5), v3(GROUND, 0, -2.5), v3(GROUND, 3, -2.5),
               v3(-GROUND, 3, -2.5));
    mesh_set_colour(m, 0.42, 0.3, 0.22);
    add_fence(m, &fence, 6.0, 0.9);
    for (int i = 0; i < 3; i++) {
        const place at =
            place_turned(&world, v3(-1.6 + 1.5 * i, 0, 0.3), between(&random, -0.4, 0.4));
        add_table(m, &at, &random);
    }
    for (int i = 0; i < 10; i++)
        add_box(m, &world, v3(2.2, 0.1 * i + 0.05, -0.4 - 0.18 * i), 0.5, 0.012, 0.09);
    add_shelf(m, &shelf, &random);
    mesh_set_colour(m, 0.35, 0.38, 0.42);
    for (int i = 0; i < 8; i++) {
        const double foot = between(&random, -2.0, 3.0);
        add_bar(m, &world, v3(foot, 0, -1.7),
                v3(foot + between(&random, -0.8, 0.8), 2.5, -2.46), 0.03);
    }
    *view = builtin_perspective(v3(0.8, 1.5, 3.9), v3(0, 0.55, -0.6), 45);
}
