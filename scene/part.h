/* SPDX-License-Identifier: MIT */
/*
 * part.h: triangles of a file in their own space, and where they go in the world.
 */
#ifndef CREVICE_SCENE_PART_H
#define CREVICE_SCENE_PART_H

#include "mesh.h"

/* Rows of an affine map to the world. */
typedef struct transform {
    vec3 row[3];
    vec3 offset;
} transform;

transform transform_identity(void);

/* First `inner`, then `outer`. */
transform transform_compose(const transform *outer, const transform *inner);

vec3 transform_point(const transform *t, vec3 p);
vec3 transform_direction(const transform *t, vec3 v);

/* The map of normals: the inverse transpose times |determinant|, which has the same
 * direction and needs no division. */
typedef struct normal_map {
    vec3 row[3];
    bool mirrors;
} normal_map;

normal_map normal_map_of(const transform *t);
vec3 normal_map_apply(const normal_map *n, vec3 normal);

typedef struct mesh_part {
    size_t vertex_count, triangle_count;
    const float *positions;  /* 3 a vertex */
    const float *normals;    /* 3 a vertex; NULL: computed, crease angle 60 degrees */
    const float *uvs;        /* 2 a vertex, v down over the map; NULL: none */
    const uint32_t *indices; /* 3 a triangle, below vertex_count */
} mesh_part;

/* Adds the triangles with the mesh's current material. */
void mesh_add_part(mesh *m, const mesh_part *part, const transform *t);

/* Grows bounds by all vertices, world space. */
void mesh_part_bound(const mesh_part *part, const transform *t, vec3 *lower, vec3 *upper);

#endif
