/* SPDX-License-Identifier: MIT */
/*
 * Texture coordinates over a triangle: a linear map, so that the change of the point with
 * them is the same all over it.
 */
#include "raycast.h"

/* Coordinates are floats: a triangle whose area in the map is below what their rounding
 * makes of a line has none. */
#define ROUNDING 2.5e-7

static double magnitude(const double uv[2])
{
    return fmax(fabs(uv[0]), fabs(uv[1]));
}

bool surface_texture(const scene *s, const pixel_ray *ray, const surface_hit *hit,
                     texture_frame *out)
{
    const uint32_t *index = s->mesh.indices + 3 * (size_t)hit->triangle;
    double uv[3][2], edge[2][2], weight[3], largest = 0.0;
    vec3 corner[3], side[2];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++)
            uv[i][k] = (double)s->mesh.uvs[2 * (size_t)index[i] + (size_t)k];
        largest = fmax(largest, magnitude(uv[i]));
    }
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            edge[i][k] = uv[i + 1][k] - uv[0][k];
    const double area = edge[0][0] * edge[1][1] - edge[1][0] * edge[0][1];
    const double longest = fmax(magnitude(edge[0]), magnitude(edge[1]));
    /* False for NaN, which stands for no coordinates, too. */
    if (!(fabs(area) > ROUNDING * largest * longest))
        return false;
    surface_weights(s, ray, hit, corner, weight);
    out->u = weight[0] * uv[0][0] + weight[1] * uv[1][0] + weight[2] * uv[2][0];
    out->v = weight[0] * uv[0][1] + weight[1] * uv[1][1] + weight[2] * uv[2][1];
    side[0] = v3_sub(corner[1], corner[0]);
    side[1] = v3_sub(corner[2], corner[0]);
    /* side[i] = edge[i][0] tangent + edge[i][1] bitangent, solved. */
    out->tangent = v3_scale(v3_along(v3_scale(side[0], edge[1][1]), side[1], -edge[0][1]),
                            1.0 / area);
    out->bitangent = v3_scale(
        v3_along(v3_scale(side[1], edge[0][0]), side[0], -edge[1][0]), 1.0 / area);
    return true;
}
