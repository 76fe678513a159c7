/* SPDX-License-Identifier: MIT */
#include "gltf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLES = 4, STRIP = 5, FAN = 6 };

void gltf_free_part(gltf_part *p)
{
    free(p->positions);
    free(p->normals);
    free(p->uvs);
    free(p->indices);
    *p = (gltf_part){0};
}

/* An attribute of as many vertices as there are positions; NULL: it is not there, or an
 * error line was written. */
static float *read_attribute(gltf *g, const cJSON *attributes, const char *name,
                             int components, size_t vertex_count)
{
    const int accessor = gltf_index(attributes, name);
    size_t count = 0;
    if (accessor < 0)
        return NULL;
    float *values = gltf_floats(g, accessor, components, &count);
    if (values && count < vertex_count) {
        gltf_refuse(g, "a mesh has attributes for some of its vertices only");
        free(values);
        return NULL;
    }
    return values;
}

/* Corners of the primitive in the order of the file: indices, or 0, 1, 2 ... */
static uint32_t *read_corners(gltf *g, const cJSON *primitive, size_t vertex_count,
                              size_t *count)
{
    const int accessor = gltf_index(primitive, "indices");
    uint32_t *corners;
    if (accessor >= 0) {
        corners = gltf_integers(g, accessor, 1, count);
    } else {
        corners = malloc((vertex_count + 1) * sizeof *corners);
        for (size_t i = 0; corners && i < vertex_count; i++)
            corners[i] = (uint32_t)i;
        *count = vertex_count;
    }
    for (size_t i = 0; corners && i < *count; i++) {
        if (corners[i] >= vertex_count) {
            gltf_refuse(g, "faces lack their vertices");
            free(corners);
            return NULL;
        }
    }
    return corners;
}

/* Triangles of the corners, in the primitive's mode. */
static bool make_triangles(gltf *g, const uint32_t *corners, size_t count, int mode,
                           gltf_part *p)
{
    const size_t triangles = mode == TRIANGLES ? count / 3 : count > 2 ? count - 2 : 0;
    p->indices = malloc((3 * triangles + 1) * sizeof *p->indices);
    if (!p->indices) {
        gltf_refuse(g, "there is no memory for it");
        return false;
    }
    for (size_t t = 0; t < triangles; t++) {
        const size_t odd = t & 1;
        const size_t list[3] = {3 * t, 3 * t + 1, 3 * t + 2};
        const size_t strip[3] = {t, t + 1 + odd, t + 2 - odd};
        const size_t fan[3] = {0, t + 1, t + 2};
        const size_t *of = mode == TRIANGLES ? list : mode == STRIP ? strip : fan;
        for (size_t k = 0; k < 3; k++)
            p->indices[3 * t + k] = corners[of[k]];
    }
    p->part.triangle_count = triangles;
    p->part.indices = p->indices;
    return true;
}

/* positions or normals += weight * the target's. */
static bool add_target(gltf *g, const cJSON *target, const char *name, double weight,
                       size_t vertex_count, float *values)
{
    float *moved = read_attribute(g, target, name, 3, vertex_count);
    for (size_t i = 0; moved && i < 3 * vertex_count; i++)
        values[i] = (float)((double)values[i] + weight * (double)moved[i]);
    free(moved);
    return !g->failed;
}

static bool morph(gltf *g, const cJSON *primitive, const cJSON *weights, gltf_part *p)
{
    const cJSON *target;
    int i = 0;
    cJSON_ArrayForEach(target, gltf_member(primitive, "targets"))
    {
        const cJSON *item = cJSON_GetArrayItem(weights, i++);
        const double weight = cJSON_IsNumber(item) ? item->valuedouble : 0.0;
        if (!(fabs(weight) > 0.0) || !isfinite(weight))
            continue;
        if (!add_target(g, target, "POSITION", weight, p->part.vertex_count, p->positions)
            || (p->normals
                && !add_target(g, target, "NORMAL", weight, p->part.vertex_count,
                               p->normals)))
            return false;
    }
    return true;
}

bool gltf_read_part(gltf *g, const cJSON *object, const cJSON *primitive,
                    const cJSON *weights, int uv_set, gltf_part *out)
{
    const cJSON *attributes = gltf_member(primitive, "attributes");
    const int mode = (int)gltf_number(primitive, "mode", TRIANGLES);
    const int positions = gltf_index(attributes, "POSITION");
    size_t vertex_count = 0, corner_count = 0;
    char uv_name[32];
    *out = (gltf_part){0};
    if (mode < TRIANGLES || mode > FAN || positions < 0)
        return true;
    snprintf(uv_name, sizeof uv_name, "TEXCOORD_%d", uv_set);
    out->positions = gltf_floats(g, positions, 3, &vertex_count);
    if (!out->positions)
        return false;
    out->normals = read_attribute(g, attributes, "NORMAL", 3, vertex_count);
    out->uvs = read_attribute(g, attributes, uv_name, 2, vertex_count);
    out->part = (mesh_part){.vertex_count = vertex_count,
                            .positions = out->positions,
                            .normals = out->normals,
                            .uvs = out->uvs};
    uint32_t *corners =
        g->failed ? NULL : read_corners(g, primitive, vertex_count, &corner_count);
    const bool done =
        corners && make_triangles(g, corners, corner_count, mode, out)
        && morph(g, primitive, weights ? weights : gltf_member(object, "weights"), out);
    free(corners);
    if (!done) {
        gltf_refuse(g, "there is no memory for it");
        gltf_free_part(out);
    }
    return done;
}
