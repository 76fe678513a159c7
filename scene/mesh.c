/* SPDX-License-Identifier: MIT */
#include "mesh.h"

#include <stdlib.h>
#include <string.h>

#define DEFAULT_ALBEDO 0.8

void mesh_free(mesh *m)
{
    free(m->positions);
    free(m->normals);
    free(m->uvs);
    free(m->indices);
    free(m->materials);
    free(m->palette);
    for (size_t i = 0; i < m->mask_count; i++)
        free(m->masks[i].alpha);
    free(m->masks);
    memset(m, 0, sizeof *m);
}

/* Resizes one array to hold count elements and `spare` bytes. */
static bool resize(void *array, size_t count, size_t element_size, size_t spare)
{
    void *old;
    if (count > (SIZE_MAX - spare) / element_size)
        return false;
    memcpy(&old, array, sizeof old);
    void *grown = realloc(old, count * element_size + spare);
    if (!grown)
        return false;
    memcpy(array, &grown, sizeof grown);
    return true;
}

/* At least `needed`, and half as much again as there is, so that appending is cheap. */
static size_t grown_capacity(size_t capacity, size_t needed)
{
    size_t grown = capacity + capacity / 2 + 64;
    return grown > needed ? grown : needed;
}

static bool set_vertex_capacity(mesh *m, size_t capacity)
{
    if (capacity > UINT32_MAX || !resize(&m->positions, capacity, 3 * sizeof(float), 4)
        || !resize(&m->normals, capacity, 3 * sizeof(float), 0)
        || !resize(&m->uvs, capacity, 2 * sizeof(float), 0)) {
        m->failed = true;
        return false;
    }
    m->vertex_capacity = capacity;
    return true;
}

static bool set_triangle_capacity(mesh *m, size_t capacity)
{
    if (capacity > UINT32_MAX || !resize(&m->indices, capacity, 3 * sizeof(uint32_t), 0)
        || !resize(&m->materials, capacity, sizeof(uint32_t), 0)) {
        m->failed = true;
        return false;
    }
    m->triangle_capacity = capacity;
    return true;
}

void mesh_reserve(mesh *m, size_t vertices, size_t triangles)
{
    if (m->failed)
        return;
    if (m->vertex_capacity - m->vertex_count < vertices
        && !set_vertex_capacity(m, m->vertex_count + vertices))
        return;
    if (m->triangle_capacity - m->triangle_count < triangles)
        set_triangle_capacity(m, m->triangle_count + triangles);
}

static float clamped(double value)
{
    if (!(value > 0.0))
        return 0.0f;
    return value < 1.0 ? (float)value : 1.0f;
}

/* Room for one more of the palette or the masks. */
static bool make_room(mesh *m, void *array, size_t count, size_t *capacity, size_t size)
{
    if (m->failed || count < *capacity)
        return !m->failed;
    const size_t grown = grown_capacity(*capacity, 1);
    m->failed = !resize(array, grown, size, 0);
    if (!m->failed)
        *capacity = grown;
    return !m->failed;
}

void mesh_set_colour(mesh *m, double r, double g, double b)
{
    if (!make_room(m, &m->palette, m->palette_count, &m->palette_capacity,
                   sizeof *m->palette))
        return;
    m->palette[m->palette_count] =
        (mesh_material){.albedo = {clamped(r), clamped(g), clamped(b)}, .mask = -1};
    m->material = (uint32_t)m->palette_count++;
}

int32_t mesh_add_mask(mesh *m, const mesh_mask *mask)
{
    if (!make_room(m, &m->masks, m->mask_count, &m->mask_capacity, sizeof *m->masks)) {
        free(mask->alpha);
        return -1;
    }
    m->masks[m->mask_count] = *mask;
    return (int32_t)m->mask_count++;
}

void mesh_set_mask(mesh *m, int32_t mask)
{
    if (!m->failed && m->palette_count > 0)
        m->palette[m->material].mask = mask;
}

/* Beyond this many times its size from zero a mesh loses to rounding what rays notice:
 * floats there are 1e-6 of the size apart. */
#define FAR 16.0

void mesh_choose_origin(mesh *m, vec3 lower, vec3 upper)
{
    const vec3 size = v3_sub(upper, lower), centre = v3_scale(v3_add(lower, upper), 0.5);
    const double extent = fmax(size.x, fmax(size.y, size.z));
    const double farthest = fmax(fabs(centre.x), fmax(fabs(centre.y), fabs(centre.z)));
    if (!(extent > 0.0) || !(farthest > FAR * extent) || !isfinite(farthest))
        return;
    /* A multiple of a power of two has few digits, which the cameras' numbers keep. */
    const double unit = exp2(floor(log2(extent)));
    m->origin[0] = unit * round(centre.x / unit);
    m->origin[1] = unit * round(centre.y / unit);
    m->origin[2] = unit * round(centre.z / unit);
}

/* The position is from the mesh's origin. */
static uint32_t add_local_vertex(mesh *m, vec3 position, vec3 normal)
{
    size_t index = m->vertex_count;
    if (m->failed)
        return 0;
    if (index == m->vertex_capacity
        && !set_vertex_capacity(m, grown_capacity(m->vertex_capacity, 1)))
        return 0;
    v3_store(position, m->positions + 3 * index);
    v3_store(v3_normalise(normal), m->normals + 3 * index);
    m->uvs[2 * index] = m->uvs[2 * index + 1] = NAN;
    m->vertex_count++;
    return (uint32_t)index;
}

uint32_t mesh_add_vertex(mesh *m, vec3 position, vec3 normal)
{
    const vec3 origin = v3(m->origin[0], m->origin[1], m->origin[2]);
    return add_local_vertex(m, v3_sub(position, origin), normal);
}

void mesh_set_uv(mesh *m, uint32_t vertex, double u, double v)
{
    if (m->failed)
        return;
    m->uvs[2 * (size_t)vertex] = (float)u;
    m->uvs[2 * (size_t)vertex + 1] = (float)v;
}

bool mesh_usable_position(vec3 p)
{
    return fabs(p.x) <= MESH_MAX_COORDINATE && fabs(p.y) <= MESH_MAX_COORDINATE
           && fabs(p.z) <= MESH_MAX_COORDINATE;
}

vec3 mesh_face_normal(vec3 a, vec3 b, vec3 c)
{
    vec3 ab = v3_sub(b, a), ac = v3_sub(c, a), bc = v3_sub(c, b);
    vec3 normal = v3_cross(ab, ac);
    double longest = fmax(v3_dot(ab, ab), fmax(v3_dot(ac, ac), v3_dot(bc, bc)));
    return v3_length(normal) > 1e-12 * longest ? normal : v3(0.0, 0.0, 0.0);
}

/* A normal that cannot be used becomes the face's, on a vertex of its own: other
 * triangles may share the old one. */
static uint32_t with_usable_normal(mesh *m, uint32_t vertex, vec3 face_normal)
{
    double length = v3_length(mesh_normal(m, vertex));
    if (length > 0.5 && length < 2.0)
        return vertex;
    const uint32_t copy = add_local_vertex(m, mesh_position(m, vertex), face_normal);
    if (!m->failed)
        memcpy(m->uvs + 2 * (size_t)copy, m->uvs + 2 * (size_t)vertex,
               2 * sizeof *m->uvs);
    return copy;
}

void mesh_add_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    if (m->failed)
        return;
    vec3 pa = mesh_position(m, a);
    vec3 pb = mesh_position(m, b);
    vec3 pc = mesh_position(m, c);
    vec3 normal = mesh_face_normal(pa, pb, pc);
    if (!mesh_usable_position(pa) || !mesh_usable_position(pb)
        || !mesh_usable_position(pc) || !(v3_dot(normal, normal) > 0.0)) {
        m->dropped_triangles++;
        return;
    }
    if (m->palette_count == 0)
        mesh_set_colour(m, DEFAULT_ALBEDO, DEFAULT_ALBEDO, DEFAULT_ALBEDO);
    a = with_usable_normal(m, a, normal);
    b = with_usable_normal(m, b, normal);
    c = with_usable_normal(m, c, normal);
    if (m->failed
        || (m->triangle_count == m->triangle_capacity
            && !set_triangle_capacity(m, grown_capacity(m->triangle_capacity, 1))))
        return;
    uint32_t *corner = m->indices + 3 * m->triangle_count;
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
    m->materials[m->triangle_count++] = m->material;
}
