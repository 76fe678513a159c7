/* SPDX-License-Identifier: MIT */
/* Normals: decoded, turned to view space, reconstructed from depth if there are none,
 * and made to face the camera. src/core/normals.c says why. */
#ifndef NORMALS_GLSL
#define NORMALS_GLSL

#include "depth.glsl"
#include "frame.glsl"

/* crv_vulkan_normals (crevice/vulkan.h) */
const int NORMAL_NONE = 0, NORMAL_XYZ = 1, NORMAL_XYZ_HALVED = 2, NORMAL_OCT = 3,
          NORMAL_OCT_HALVED = 4;

/* The planar depth of the workgroup's pixels and of those around them. */
#define TILE_ROW (gl_WorkGroupSize.x + 2)
shared float tile_depth[TILE_ROW * (gl_WorkGroupSize.y + 2)];

ivec2 tile_first()
{
    return ivec2(push.out_x, push.out_y)
           + ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) - 1;
}

/* Every invocation of the workgroup takes part. */
void take_tile()
{
    const ivec2 last = ivec2(params.width - 1, params.height - 1), first = tile_first();
    const uint stride = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
    for (uint i = gl_LocalInvocationIndex; i < tile_depth.length(); i += stride) {
        const ivec2 at = first + ivec2(i % TILE_ROW, i / TILE_ROW);
        tile_depth[i] = planar_depth(clamp(at, ivec2(0), last));
    }
    barrier();
}

float depth_in_tile(ivec2 at)
{
    const ivec2 place = at - tile_first();
    return tile_depth[place.y * int(TILE_ROW) + place.x];
}

/* Zero if the length is zero, infinite or NaN. Scaled first: squares of small scenes'
 * lengths underflow. */
vec3 normalized(vec3 v)
{
    const float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    if (!(largest > 0 && is_surface(largest)) || is_nan(v.x) || is_nan(v.y)
        || is_nan(v.z))
        return vec3(0);
    precise vec3 scaled = v / largest;
    precise float scale = 1 / sqrt(dot(scaled, scaled));
    precise vec3 result = scaled * scale;
    return result;
}

/* The host's normal, in view space; of any length. */
vec3 decoded_normal(vec4 stored)
{
    vec3 n = stored.xyz;
    if (push.normal_encoding == NORMAL_XYZ_HALVED)
        n = n * 2 - 1;
    else if (push.normal_encoding == NORMAL_OCT)
        n = octahedral_decoded(n.xy);
    else if (push.normal_encoding == NORMAL_OCT_HALVED)
        n = octahedral_decoded(n.xy * 2 - 1);
    return vec3(
        push.to_view_xx * n.x + push.to_view_xy * n.y + push.to_view_xz * n.z,
        push.to_view_yx * n.x + push.to_view_yy * n.y + push.to_view_yz * n.z,
        push.to_view_zx * n.x + push.to_view_zy * n.y + push.to_view_zz * n.z);
}

/* The edge from the pixel to its neighbours on one axis: towards the neighbour that is
 * nearer in depth, since the other may lie beyond an edge. Without a neighbour the
 * surface is taken to be parallel to the image. */
vec3 edge_along(ivec2 at, ivec2 way, float d)
{
    const vec3 P = unproject(at, d);
    float best = INFINITY;
    precise vec3 result = unproject(at + way, d) - P;
    for (int side = -1; side <= 1; side += 2) {
        const ivec2 neighbour = at + side * way;
        if (!in_buffers(neighbour))
            continue;
        const float depth = depth_in_tile(neighbour);
        const float difference = abs(depth - d);
        if (is_surface(depth) && difference < best) {
            best = difference;
            result = (unproject(neighbour, depth) - P) * float(side);
        }
    }
    return result;
}

vec3 normal_from_depth(ivec2 at, float d)
{
    precise vec3 right = normalized(edge_along(at, ivec2(1, 0), d));
    precise vec3 up = normalized(edge_along(at, ivec2(0, -1), d));
    precise vec3 normal =
        vec3(right.y * up.z - right.z * up.y, right.z * up.x - right.x * up.z,
             right.x * up.y - right.y * up.x);
    return normalized(normal);
}

/* A shading normal that points away from the camera belongs to the back of a triangle
 * if it contradicts the surface that depth shows: turn it round. Otherwise bend it
 * until it faces the camera as surfaces at a silhouette do. */
vec3 facing_camera(ivec2 at, float d, vec3 n)
{
    const float least = 1e-3; /* cosine that is left to the viewer: 0.06 degrees */
    const float enough = 0.1;
    const vec3 view = is_orthographic() ? vec3(0, 0, 1) : normalized(-unproject(at, d));
    float facing = dot(n, view);
    if (facing >= least)
        return n;
    if (facing < 0 && dot(n, normal_from_depth(at, d)) < 0) {
        n = -n;
        facing = -facing;
        if (facing >= least)
            return n;
    }
    const vec3 bent = normalized(n + ((facing < 0 ? enough : least) - facing) * view);
    return dot(bent, view) > 0 ? bent : view;
}

vec3 final_normal(ivec2 at, float d)
{
    vec3 n = vec3(0);
    if (push.normal_encoding != NORMAL_NONE)
        n = normalized(decoded_normal(
            texelFetch(vector_image, at + ivec2(push.host_x, push.host_y), 0)));
    if (n == vec3(0))
        n = normal_from_depth(at, d);
    return facing_camera(at, d, n);
}

#endif
