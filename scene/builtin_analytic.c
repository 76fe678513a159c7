/* SPDX-License-Identifier: MIT */
/*
 * Small scenes: those whose depth and occlusion are known in closed form, and one for
 * height maps.
 */
#include "builtin.h"

scene_view builtin_perspective(vec3 eye, vec3 target, double vfov_deg)
{
    scene_view view = {.projection = CRV_PERSPECTIVE, .up = {0.0f, 1.0f, 0.0f}};
    v3_store_double(eye, view.eye);
    v3_store_double(target, view.target);
    view.vfov_rad = (float)(vfov_deg * SCENE_PI / 180.0);
    view.view_height =
        (float)(2.0 * v3_length(v3_sub(eye, target)) * tan(0.5 * (double)view.vfov_rad));
    return view;
}

static scene_view orthographic(vec3 eye, vec3 up, double height)
{
    scene_view view = builtin_perspective(eye, v3(0, 0, 0), 20);
    view.projection = CRV_ORTHOGRAPHIC;
    view.view_height = (float)height;
    v3_store_double(up, view.up);
    return view;
}

static void add_floor(mesh *m, double half_width, double half_depth)
{
    const place world = place_at(0, 0, 0);
    shape_quad(m, &world, v3(-half_width, 0, half_depth), v3(half_width, 0, half_depth),
               v3(half_width, 0, -half_depth), v3(-half_width, 0, -half_depth));
}

/* Floor y = 0 and wall x = 0, perpendicular. */
void builtin_corner(mesh *m, scene_view *view, const double *p)
{
    const place world = place_at(0, 0, 0);
    (void)p;
    shape_quad(m, &world, v3(0, 0, 8), v3(8, 0, 8), v3(8, 0, -8), v3(0, 0, -8));
    shape_quad(m, &world, v3(0, 0, 8), v3(0, 0, -8), v3(0, 6, -8), v3(0, 6, 8));
    *view = builtin_perspective(v3(5, 3.5, 1), v3(0.8, 0.4, 0), 45);
}

/* Floor y = 0: seen at a slant, or in an orthographic view at this tilt, which it fills
 * with a margin of at least 4 units all around. */
void builtin_plane(mesh *m, scene_view *view, const double *p)
{
    const double tilt = p[0] * SCENE_PI / 180.0;
    if (p[0] < 0.0) {
        add_floor(m, 20, 20);
        *view = builtin_perspective(v3(0, 3, 6), v3(0, 0, 0), 45);
        return;
    }
    /* The picture is 6 units high: the floor that it shows is 6 / cos(tilt) long, and the
     * eye must be before its nearest part. */
    const double distance = 20.0 + 8.0 * tan(tilt);
    add_floor(m, 20, 8.0 / cos(tilt) + 4.0);
    *view = orthographic(v3(0, distance * cos(tilt), distance * sin(tilt)),
                         v3(0, sin(tilt), -cos(tilt)), 6.0);
}

/* A sphere of radius 1 that stands on the floor y = 0 at the origin. */
void builtin_sphere(mesh *m, scene_view *view, const double *p)
{
    const place world = place_at(0, 0, 0);
    if (p[0] > 0.5)
        add_floor(m, 20, 20);
    shape_sphere(m, &world, v3(0, 1, 0), 1.0, 512);
    *view = builtin_perspective(v3(0, 2.2, 5.5), v3(0, 0.85, 0), 40);
}

/*
 * A V groove along Z with its edge at the origin, opening upwards, seen by an
 * orthographic camera that looks down the bisector. Each wall is 8 sqrt(2) units wide.
 */
void builtin_groove(mesh *m, scene_view *view, const double *p)
{
    const place world = place_at(0, 0, 0);
    const double half = 0.5 * p[0] * SCENE_PI / 180.0, width = 8.0 * sqrt(2.0);
    const double x = width * sin(half), y = width * cos(half);
    shape_quad(m, &world, v3(0, 0, 16), v3(x, y, 16), v3(x, y, -16), v3(0, 0, -16));
    shape_quad(m, &world, v3(-x, y, 16), v3(0, 0, 16), v3(0, 0, -16), v3(-x, y, -16));
    *view = orthographic(v3(0, 20, 0), v3(0, 0, -1), 6.0);
}

/* For height maps: floor, wall and a ball of radius 1 between them, all without relief of
 * their own. The map is 2 units large on the flats and about as large on the ball. */
void builtin_relief(mesh *m, scene_view *view, const double *p)
{
    const place world = place_at(0, 0, 0);
    (void)p;
    shape_quad(m, &world, v3(-12, 0, 8), v3(12, 0, 8), v3(12, 0, -2), v3(-12, 0, -2));
    shape_quad(m, &world, v3(-12, 0, -2), v3(12, 0, -2), v3(12, 8, -2), v3(-12, 8, -2));
    const uint32_t ball = (uint32_t)m->vertex_count;
    shape_sphere(m, &world, v3(0, 1, 0), 1.0, 256);
    for (uint32_t v = ball; v < m->vertex_count; v++)
        mesh_set_uv(m, v, 4.0 * (double)m->uvs[2 * (size_t)v],
                    2.0 * (double)m->uvs[2 * (size_t)v + 1]);
    *view = builtin_perspective(v3(1.6, 2.6, 5.4), v3(0, 0.9, -0.4), 40);
}
