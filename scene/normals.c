/* SPDX-License-Identifier: MIT */
/*
 * assimp could compute these, but it takes the faces around a shared vertex for one
 * smooth surface: an indexed cube loses its edges.
 */
#include "normals.h"

#include <stdlib.h>
#include <string.h>

#include "mesh.h"

/* More faces around one position than this are sampled evenly: a fan of n faces would
 * cost n^2. */
#define MAX_FACES_COMPARED 512

/* The corners that meet in each position: corners[first[p]] to corners[first[p + 1] - 1],
 * p = position[vertex]. */
typedef struct neighbours {
    uint32_t *position;
    size_t *first;
    size_t *corners;
} neighbours;

static void neighbours_free(neighbours *n)
{
    free(n->position);
    free(n->first);
    free(n->corners);
}

static size_t hash_position(const float p[3])
{
    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (int i = 0; i < 3; i++) {
        uint32_t bits;
        float value = p[i] + 0.0f; /* -0 and 0 are one place */
        memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return (size_t)hash;
}

static bool same_position(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* position[v] = the first vertex at the same place as v. */
static bool weld(const float *positions, size_t vertex_count, uint32_t *position)
{
    size_t slots = 16;
    uint32_t *table;
    while (slots < 2 * vertex_count)
        slots *= 2;
    table = malloc(slots * sizeof *table);
    if (!table)
        return false;
    memset(table, 0xff, slots * sizeof *table);
    for (size_t v = 0; v < vertex_count; v++) {
        size_t slot = hash_position(positions + 3 * v) & (slots - 1);
        while (table[slot] != UINT32_MAX
               && !same_position(positions + 3 * (size_t)table[slot], positions + 3 * v))
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == UINT32_MAX)
            table[slot] = (uint32_t)v;
        position[v] = table[slot];
    }
    free(table);
    return true;
}

static bool find_neighbours(neighbours *n, const float *positions, size_t vertex_count,
                            const uint32_t *indices, size_t corner_count)
{
    n->position = malloc((vertex_count + 1) * sizeof *n->position);
    n->first = calloc(vertex_count + 1, sizeof *n->first);
    n->corners = malloc((corner_count + 1) * sizeof *n->corners);
    if (!n->position || !n->first || !n->corners
        || !weld(positions, vertex_count, n->position))
        return false;
    for (size_t c = 0; c < corner_count; c++)
        n->first[n->position[indices[c]]]++;
    /* From counts to ends, which filling from behind turns into beginnings. */
    for (size_t v = 1; v <= vertex_count; v++)
        n->first[v] += n->first[v - 1];
    for (size_t c = corner_count; c-- > 0;)
        n->corners[--n->first[n->position[indices[c]]]] = c;
    return true;
}

/* The angle at a corner of its triangle, in radians. */
static double corner_angle(const float *positions, const uint32_t *indices, size_t corner)
{
    size_t base = corner - corner % 3;
    vec3 at = v3_from(positions + 3 * (size_t)indices[corner]);
    vec3 next = v3_from(positions + 3 * (size_t)indices[base + (corner + 1) % 3]);
    vec3 last = v3_from(positions + 3 * (size_t)indices[base + (corner + 2) % 3]);
    vec3 a = v3_sub(next, at), b = v3_sub(last, at);
    return atan2(v3_length(v3_cross(a, b)), v3_dot(a, b));
}

static void measure_faces(const float *positions, const uint32_t *indices,
                          size_t triangle_count, float *face_normals, float *angles)
{
    for (size_t t = 0; t < triangle_count; t++) {
        const uint32_t *corner = indices + 3 * t;
        vec3 normal = mesh_face_normal(v3_from(positions + 3 * (size_t)corner[0]),
                                       v3_from(positions + 3 * (size_t)corner[1]),
                                       v3_from(positions + 3 * (size_t)corner[2]));
        v3_store(v3_normalise(normal), face_normals + 3 * t);
        for (size_t c = 3 * t; c < 3 * t + 3; c++)
            angles[c] = (float)corner_angle(positions, indices, c);
    }
}

static vec3 corner_normal(const neighbours *n, uint32_t vertex, size_t corner,
                          const float *face_normals, const float *angles,
                          double crease_cos)
{
    vec3 own = v3_from(face_normals + 3 * (corner / 3));
    vec3 sum = v3(0.0, 0.0, 0.0);
    size_t first = n->first[n->position[vertex]];
    size_t last = n->first[n->position[vertex] + 1];
    size_t step = 1 + (last - first) / MAX_FACES_COMPARED;
    for (size_t i = first; i < last; i += step) {
        vec3 other = v3_from(face_normals + 3 * (n->corners[i] / 3));
        if (v3_dot(own, other) >= crease_cos)
            sum = v3_along(sum, other, (double)angles[n->corners[i]]);
    }
    /* Zero where sampling passed over all that are alike. */
    return v3_dot(sum, sum) > 0.0 ? v3_normalise(sum) : own;
}

bool smooth_normals(const float *positions, size_t vertex_count, const uint32_t *indices,
                    size_t triangle_count, double crease_rad, float *corner_normals)
{
    neighbours n = {0};
    size_t corner_count = 3 * triangle_count;
    float *face_normals = malloc((corner_count + 1) * sizeof *face_normals);
    float *angles = malloc((corner_count + 1) * sizeof *angles);
    /* An edge of exactly the crease angle counts as smooth, rounding or not. */
    double crease_cos = cos(crease_rad) - 1e-6;
    bool done = face_normals && angles
                && find_neighbours(&n, positions, vertex_count, indices, corner_count);
    if (done) {
        measure_faces(positions, indices, triangle_count, face_normals, angles);
        for (size_t c = 0; c < corner_count; c++)
            v3_store(corner_normal(&n, indices[c], c, face_normals, angles, crease_cos),
                     corner_normals + 3 * c);
    }
    neighbours_free(&n);
    free(face_normals);
    free(angles);
    return done;
}
