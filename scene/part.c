/* SPDX-License-Identifier: MIT */
#include "part.h"

#include <stdlib.h>

#include "normals.h"

#define CREASE_RAD (60.0 * SCENE_PI / 180.0)

transform transform_identity(void)
{
    return (transform){{v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1)}, v3(0, 0, 0)};
}

vec3 transform_direction(const transform *t, vec3 v)
{
    return v3(v3_dot(t->row[0], v), v3_dot(t->row[1], v), v3_dot(t->row[2], v));
}

vec3 transform_point(const transform *t, vec3 p)
{
    return v3_add(transform_direction(t, p), t->offset);
}

transform transform_compose(const transform *outer, const transform *inner)
{
    const vec3 *r = inner->row;
    const vec3 column[3] = {v3(r[0].x, r[1].x, r[2].x), v3(r[0].y, r[1].y, r[2].y),
                            v3(r[0].z, r[1].z, r[2].z)};
    transform t;
    for (int i = 0; i < 3; i++)
        t.row[i] = v3(v3_dot(outer->row[i], column[0]), v3_dot(outer->row[i], column[1]),
                      v3_dot(outer->row[i], column[2]));
    t.offset = v3_add(outer->offset, transform_direction(outer, inner->offset));
    return t;
}

normal_map normal_map_of(const transform *t)
{
    normal_map n = {{v3_cross(t->row[1], t->row[2]), v3_cross(t->row[2], t->row[0]),
                     v3_cross(t->row[0], t->row[1])},
                    false};
    n.mirrors = v3_dot(t->row[0], n.row[0]) < 0.0;
    if (n.mirrors)
        for (int i = 0; i < 3; i++)
            n.row[i] = v3_scale(n.row[i], -1.0);
    return n;
}

vec3 normal_map_apply(const normal_map *n, vec3 normal)
{
    return v3(v3_dot(n->row[0], normal), v3_dot(n->row[1], normal),
              v3_dot(n->row[2], normal));
}

static uint32_t add_vertex(mesh *m, const mesh_part *part, size_t vertex,
                           const float normal[3], const transform *t, const normal_map *n)
{
    const vec3 position = v3_from(part->positions + 3 * vertex);
    const uint32_t added = mesh_add_vertex(m, transform_point(t, position),
                                           normal_map_apply(n, v3_from(normal)));
    if (part->uvs)
        mesh_set_uv(m, added, (double)part->uvs[2 * vertex],
                    (double)part->uvs[2 * vertex + 1]);
    return added;
}

static void add_triangle(mesh *m, const uint32_t corner[3], bool mirrors)
{
    mesh_add_triangle(m, corner[0], corner[mirrors ? 2 : 1], corner[mirrors ? 1 : 2]);
}

static void add_with_own_normals(mesh *m, const mesh_part *part, const transform *t)
{
    const normal_map n = normal_map_of(t);
    const uint32_t base = (uint32_t)m->vertex_count;
    mesh_reserve(m, part->vertex_count, part->triangle_count);
    for (size_t v = 0; v < part->vertex_count && !m->failed; v++)
        add_vertex(m, part, v, part->normals + 3 * v, t, &n);
    for (size_t i = 0; i < part->triangle_count && !m->failed; i++) {
        const uint32_t *index = part->indices + 3 * i;
        const uint32_t corner[3] = {base + index[0], base + index[1], base + index[2]};
        add_triangle(m, corner, n.mirrors);
    }
}

static void add_with_computed_normals(mesh *m, const mesh_part *part, const transform *t)
{
    const normal_map n = normal_map_of(t);
    float *normals = malloc((9 * part->triangle_count + 1) * sizeof *normals);
    if (!normals
        || !smooth_normals(part->positions, part->vertex_count, part->indices,
                           part->triangle_count, CREASE_RAD, normals)) {
        free(normals);
        m->failed = true;
        return;
    }
    mesh_reserve(m, 3 * part->triangle_count, part->triangle_count);
    for (size_t i = 0; i < part->triangle_count && !m->failed; i++) {
        uint32_t corner[3];
        for (size_t c = 0; c < 3; c++)
            corner[c] = add_vertex(m, part, part->indices[3 * i + c],
                                   normals + 9 * i + 3 * c, t, &n);
        add_triangle(m, corner, n.mirrors);
    }
    free(normals);
}

void mesh_add_part(mesh *m, const mesh_part *part, const transform *t)
{
    if (part->triangle_count == 0 || m->failed)
        return;
    if (part->normals)
        add_with_own_normals(m, part, t);
    else
        add_with_computed_normals(m, part, t);
}

void mesh_part_bound(const mesh_part *part, const transform *t, vec3 *lower, vec3 *upper)
{
    for (size_t v = 0; v < part->vertex_count; v++)
        v3_bound(transform_point(t, v3_from(part->positions + 3 * v)), lower, upper);
}
