/* SPDX-License-Identifier: MIT */
#include "builtin.h"

#define SEGMENTS 5

/* One blade: a tapered ribbon that bends over, seen from both sides. */
static void add_blade(mesh *m, const place *at, vec3 root, double height, double width,
                      double heading, double bend)
{
    vec3 lean = v3(cos(heading), 0.0, sin(heading));
    vec3 across = v3(-sin(heading), 0.0, cos(heading));
    uint32_t first = (uint32_t)m->vertex_count;
    for (int i = 0; i <= SEGMENTS; i++) {
        double t = (double)i / SEGMENTS, half = 0.5 * width * (1.0 - t * t);
        vec3 spine = v3_along(root, lean, height * bend * t * t);
        vec3 along = v3_along(v3(0.0, 1.0 - 0.6 * bend * t, 0.0), lean, 2.0 * bend * t);
        vec3 normal = v3_normalise(v3_cross(across, along));
        spine.y += height * (t - 0.3 * bend * t * t);
        mesh_add_vertex(m, place_point(at, v3_along(spine, across, -half)),
                        place_direction(at, normal));
        if (i < SEGMENTS)
            mesh_add_vertex(m, place_point(at, v3_along(spine, across, half)),
                            place_direction(at, normal));
    }
    for (uint32_t i = 0; i < SEGMENTS; i++) {
        uint32_t v = first + 2 * i;
        mesh_add_triangle(m, v, v + 1, v + 2);
        if (i + 1 < SEGMENTS)
            mesh_add_triangle(m, v + 1, v + 3, v + 2);
    }
}

void builtin_tuft(mesh *m, const place *at, double radius, double height, int blades,
                  uint64_t seed)
{
    uint64_t random = seed;
    for (int i = 0; i < blades; i++) {
        double angle = 2.0 * SCENE_PI * builtin_random(&random);
        double distance = radius * sqrt(builtin_random(&random));
        double heading = angle + 1.2 * (builtin_random(&random) - 0.5);
        /* Outer blades are shorter and bend farther. */
        double outer = distance / radius;
        double tall =
            height * (1.0 - 0.35 * outer) * (0.7 + 0.5 * builtin_random(&random));
        double bend =
            0.15 + 0.55 * outer * builtin_random(&random) + 0.2 * builtin_random(&random);
        double width = 0.016 + 0.01 * builtin_random(&random);
        add_blade(m, at, v3(distance * cos(angle), 0.0, distance * sin(angle)), tall,
                  width, heading, bend);
    }
}
