/* SPDX-License-Identifier: MIT */
/*
 * normals.h: normals for meshes that come without.
 */
#ifndef CREVICE_SCENE_NORMALS_H
#define CREVICE_SCENE_NORMALS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * One normal for each corner: the faces that meet in its position and are turned by no
 * more than crease_rad against the corner's own, weighted by their angles there. Vertices
 * are welded by exactly equal position. positions: 3 floats a vertex; indices: 3 a
 * triangle, in range; corner_normals: 9 floats a triangle, zero if the triangle is
 * degenerate. False: out of memory.
 */
bool smooth_normals(const float *positions, size_t vertex_count, const uint32_t *indices,
                    size_t triangle_count, double crease_rad, float *corner_normals);

#endif
