/* SPDX-License-Identifier: MIT */
/* Marching through view space and looking points up in the depth buffer:
 * src/methods/march.h */
#ifndef MARCH_GLSL
#define MARCH_GLSL

#include "bent.glsl"
#include "falloff.glsl"
#include "frame.glsl"

/* Two unit vectors that span the plane of n, turned as little as possible from the
 * image's axes. */
void tangents_of(vec3 n, out vec3 t, out vec3 b)
{
    precise float scale = 1 / (1 + max(n.z, -0.9999));
    precise float xy = -n.x * n.y * scale;
    precise float tx = 1 - n.x * n.x * scale;
    precise float by = 1 - n.y * n.y * scale;
    t = vec3(tx, xy, -n.x);
    b = vec3(xy, by, -n.y);
}

/* The k-th of the Nd unit vectors equally spaced around n, in the plane of n. */
vec3 slice_tangent(crv__noise_texel noise, int k, vec3 t, vec3 b)
{
    const vec2 d = direction_at(noise, k);
    precise vec3 tangent = d.x * t + d.y * b;
    return tangent;
}

/* The unit vector over the tangent t whose cosine with n squares to z2. */
vec3 raised(vec3 n, vec3 t, float z2)
{
    precise float z = sqrt(z2);
    precise float xy = sqrt(max(0, 1 - z2));
    precise vec3 direction = z * n + xy * t;
    return direction;
}

/* P raised along n by one pixel's footprint at its depth: the height of the steps of a
 * slanted surface's point-sampled depth (2008a, eq. 13). */
vec3 lifted(vec3 P, vec3 n)
{
    precise vec3 point = P + n * (view_unit(-P.z) / min(params.fx, params.fy));
    return point;
}

/* The pixel that a view-space point falls on. False if it is behind the eye or off the
 * buffers. */
bool texel_of(vec3 Q, out ivec2 texel)
{
    const float unit = view_unit(-Q.z);
    precise float inverse = 1 / unit;
    precise vec2 place = vec2(params.cx + params.fx * Q.x * inverse,
                              params.cy - params.fy * Q.y * inverse);
    const vec2 inside = clamped_place(place);
    texel = ivec2(inside);
    return all(bvec2(unit > 0, inside == place));
}

/* The depth of the back of what has its front at depth d in this layer: if layers come
 * in pairs, the next one's; else `thickness` behind the front. */
float back_of(int layer, ivec2 texel, float d, float thickness)
{
    return layers_are_solid() && layer + 1 < layer_count() ? depth_at(texel, layer + 1)
                                                           : d + thickness;
}

int layer_step()
{
    return layers_are_solid() ? 2 : 1;
}

/*
 * Whether something blocks the point Q as seen from `origin`: a surface less than the
 * radius away from the origin with Q behind it, but not behind its back. I is the surface
 * point at Q's pixel, read at the texel's centre and never interpolated.
 */
bool is_blocked(vec3 origin, vec3 Q, out vec3 I)
{
    ivec2 texel;
    I = vec3(0);
    if (!texel_of(Q, texel))
        return false;
    for (int layer = 0; layer < layer_count(); layer += layer_step()) {
        const float d = depth_at(texel, layer);
        if (!(-Q.z > d)) /* in front of it, or background */
            continue;
        if (!(-Q.z < back_of(layer, texel, d, params.thickness)))
            continue;
        I = unproject(texel, d);
        const vec3 to = I - origin;
        if (dot(to, to) < params.radius * params.radius)
            return true;
    }
    return false;
}

/* The point that the i-th of the jittered steps over the radius comes to. */
vec3 stepped(vec3 origin, vec3 direction, int i, float beta)
{
    precise float stride = params.radius / float(step_count());
    precise vec3 Q = origin + direction * ((float(i) + beta) * stride);
    return Q;
}

/* Marches from `origin` along the unit vector `direction`. The falloff's weight of the
 * first thing in the way; 0: there is none. */
float marched(vec3 origin, vec3 direction, float beta)
{
    for (int i = 1; i <= step_count(); i++) {
        vec3 I;
        if (is_blocked(origin, stepped(origin, direction, i, beta), I))
            return falloff(length(I - origin) * params.inv_radius);
    }
    return 0;
}

#endif
