/* SPDX-License-Identifier: MIT */
/*
 * mesh.h: triangles that are being collected. Out of memory is remembered, so that code
 * which adds shapes need not check every call; scene_from_mesh() reports it.
 */
#ifndef CREVICE_SCENE_MESH_H
#define CREVICE_SCENE_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vec.h"

/* Coordinates beyond this are dropped as not finite: squares and products of three of
 * them must fit a float inside the ray caster. */
#define MESH_MAX_COORDINATE 1e12

/* Where a picture's alpha leaves a hole in triangles with texture coordinates. */
typedef struct mesh_mask {
    unsigned char *alpha;  /* width * height, row 0 on top; owned */
    int32_t width, height; /* 1 to MESH_MAX_MASK */
    int32_t wrap[2];       /* of u and v */
    float cutoff;          /* there is a surface where alpha / 255 is at least that */
    float map[6];          /* u' = map[0] u + map[1] v + map[2], v' = map[3] u + ... */
} mesh_mask;

enum { MESH_WRAP_REPEAT, MESH_WRAP_CLAMP, MESH_WRAP_MIRROR, MESH_MAX_MASK = 32768 };

typedef struct mesh_material {
    float albedo[3]; /* linear */
    int32_t mask;    /* into masks; -1: none */
} mesh_material;

typedef struct mesh {
    double origin[3]; /* world coordinates of the positions' zero; set before the first
                         vertex: floats cannot hold a bolt at map coordinates */
    float *positions; /* 3 a vertex, and one float more: Embree loads 16 bytes */
    float *normals;   /* 3 a vertex, unit length */
    float *uvs;       /* 2 a vertex, v down over the map; NaN: none */
    size_t vertex_count, vertex_capacity;
    uint32_t *indices;   /* 3 a triangle, counter-clockwise seen from the front */
    uint32_t *materials; /* 1 a triangle, into the palette */
    size_t triangle_count, triangle_capacity;
    mesh_material *palette;
    size_t palette_count, palette_capacity;
    mesh_mask *masks;
    size_t mask_count, mask_capacity;
    uint32_t material;        /* of the triangles to come */
    size_t dropped_triangles; /* degenerate or not finite */
    bool failed;              /* out of memory */
} mesh;

void mesh_free(mesh *m);

/* Makes room for this many more, which saves time and memory; optional. */
void mesh_reserve(mesh *m, size_t vertices, size_t triangles);

/* Further triangles get this linear albedo, clamped to [0, 1], and no mask. */
void mesh_set_colour(mesh *m, double r, double g, double b);

/* Takes the mask, also on failure; its index, or -1. */
int32_t mesh_add_mask(mesh *m, const mesh_mask *mask);

/* Triangles of the colour that was set last get this mask. */
void mesh_set_mask(mesh *m, int32_t mask);

/* Whether there is a surface at these texture coordinates; NaN: yes. */
bool mesh_mask_covers(const mesh_mask *mask, double u, double v);

/* Chooses the origin of an empty mesh for the bounds of what is to come, world space:
 * zero unless the whole is far from it for its size. */
void mesh_choose_origin(mesh *m, vec3 lower, vec3 upper);

/* The position is in world space. Returns the vertex's index. */
uint32_t mesh_add_vertex(mesh *m, vec3 position, vec3 normal);

/* Gives a vertex its texture coordinates. */
void mesh_set_uv(mesh *m, uint32_t vertex, double u, double v);

/* Drops degenerate and non-finite triangles. Vertex normals that are not usable become
 * those of the face. */
void mesh_add_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c);

/* Whether the point has finite coordinates within MESH_MAX_COORDINATE. */
bool mesh_usable_position(vec3 p);

/* The cross product of two edges; zero if the triangle is degenerate: its height is
 * below the rounding of its coordinates. */
vec3 mesh_face_normal(vec3 a, vec3 b, vec3 c);

/* From the mesh's origin. */
static inline vec3 mesh_position(const mesh *m, uint32_t vertex)
{
    return v3_from(m->positions + 3 * (size_t)vertex);
}

static inline vec3 mesh_normal(const mesh *m, uint32_t vertex)
{
    return v3_from(m->normals + 3 * (size_t)vertex);
}

#endif
