/* SPDX-License-Identifier: MIT */
/* Normals: reconstructed from depth where there are none, and made to face the camera. */
#include "core/frame.h"
#include "core/gbuffer.h"

static crv__vec3 cross(crv__vec3 a, crv__vec3 b)
{
    return (crv__vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                       a.x * b.y - a.y * b.x};
}

/* Zero where the length is zero, infinite or NaN. Scaled first: squares of small scenes'
 * lengths underflow. */
static crv__vec3 normalized(crv__vec3 v)
{
    float largest = fmaxf(fabsf(v.x), fmaxf(fabsf(v.y), fabsf(v.z)));
    if (!(largest > 0 && largest < INFINITY) || isnan(v.x) || isnan(v.y) || isnan(v.z))
        return (crv__vec3){0, 0, 0};
    v = (crv__vec3){v.x / largest, v.y / largest, v.z / largest};
    float scale = 1 / sqrtf(crv__dot(v, v));
    return (crv__vec3){v.x * scale, v.y * scale, v.z * scale};
}

/*
 * The edge from the pixel to its neighbours on one axis: towards the neighbour that is
 * nearer in depth, since the other may lie beyond an edge. Without a neighbour the
 * surface is taken to be parallel to the image.
 */
static crv__vec3 edge(const crv__params *p, const crv__plane *depth, int32_t x, int32_t y,
                      int32_t step_x, int32_t step_y, float d)
{
    const crv__vec3 P = crv__unproject(p, x, y, d);
    float best = INFINITY;
    crv__vec3 result = crv__sub(crv__unproject(p, x + step_x, y + step_y, d), P);
    for (int32_t sign = -1; sign <= 1; sign += 2) {
        const int32_t u = x + sign * step_x, v = y + sign * step_y;
        if (!crv__plane_holds(depth, u, v))
            continue;
        const float neighbour = *crv__plane_at(depth, u, v);
        const float difference = fabsf(neighbour - d);
        if (difference < best) { /* never for background */
            best = difference;
            const crv__vec3 v3 = crv__sub(crv__unproject(p, u, v, neighbour), P);
            result =
                (crv__vec3){v3.x * (float)sign, v3.y * (float)sign, v3.z * (float)sign};
        }
    }
    return result;
}

static crv__vec3 from_depth(const crv__params *p, const crv__plane *depth, int32_t x,
                            int32_t y, float d)
{
    const crv__vec3 right = normalized(edge(p, depth, x, y, 1, 0, d));
    const crv__vec3 up = normalized(edge(p, depth, x, y, 0, -1, d));
    return normalized(cross(right, up));
}

/*
 * A shading normal may lean away from the camera. Where it contradicts the surface that
 * depth shows, it belongs to the back of a triangle: turn it round. Otherwise
 * (interpolated at a silhouette) bend it until it faces the camera as surfaces at a
 * silhouette do: if it just did, methods would take the surface for seen edge-on.
 */
static crv__vec3 face_camera(const crv__params *p, const crv__plane *depth, int32_t x,
                             int32_t y, float d, crv__vec3 n)
{
    const float least = 1e-3f; /* cosine that is left to the viewer: 0.06 degrees */
    const float enough = 0.1f;
    crv__vec3 P = crv__unproject(p, x, y, d);
    crv__vec3 view = p->orthographic ? (crv__vec3){0, 0, 1}
                                     : normalized((crv__vec3){-P.x, -P.y, -P.z});
    float facing = crv__dot(n, view);
    if (facing >= least)
        return n;
    if (facing < 0 && crv__dot(n, from_depth(p, depth, x, y, d)) < 0) {
        n = (crv__vec3){-n.x, -n.y, -n.z};
        facing = -facing;
        if (facing >= least)
            return n;
    }
    const float add = (facing < 0 ? enough : least) - facing;
    crv__vec3 bent = normalized(
        (crv__vec3){n.x + add * view.x, n.y + add * view.y, n.z + add * view.z});
    return crv__dot(bent, view) > 0 ? bent : view;
}

void crv__rotated_row(const float rotation[9], const crv__texel_row *from, int32_t count,
                      float *const out[3])
{
    for (int32_t x = 0; x < count; x++) {
        const float v[3] = {crv__texel_at(from, x, 0), crv__texel_at(from, x, 1),
                            crv__texel_at(from, x, 2)};
        for (int i = 0; i < 3; i++)
            out[i][x] = rotation[3 * i] * v[0] + rotation[3 * i + 1] * v[1]
                        + rotation[3 * i + 2] * v[2];
    }
}

void crv__normals_row(const crv__params *p, const crv__plane *depth,
                      const crv__plane *normal, int32_t has_normals, int32_t y)
{
    for (int32_t x = 0; x < p->width; x++) {
        float *const out[3] = {crv__plane_at(&normal[0], x, y),
                               crv__plane_at(&normal[1], x, y),
                               crv__plane_at(&normal[2], x, y)};
        const float d = *crv__plane_at(depth, x, y);
        crv__vec3 n = {0, 0, 0};
        if (d < INFINITY) {
            if (has_normals)
                n = normalized((crv__vec3){*out[0], *out[1], *out[2]});
            if (crv__dot(n, n) == 0)
                n = from_depth(p, depth, x, y, d);
            n = face_camera(p, depth, x, y, d, n);
        }
        *out[0] = n.x;
        *out[1] = n.y;
        *out[2] = n.z;
    }
}
