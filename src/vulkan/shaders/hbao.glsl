/* SPDX-License-Identifier: MIT */
/*
 * Horizon-based ambient occlusion.
 * Louis Bavoil, Miguel Sainz, Rouslan Dimitrov: Image-Space Horizon-Based Ambient
 * Occlusion, SIGGRAPH 2008 talks.
 *
 * In each of the slices that directions theta cut from the hemisphere, the depth buffer
 * is walked outwards and the horizon h, the largest elevation so far, is kept: A = 1 -
 * 1/(2 pi) Int (sin h - sin t) W dtheta (eq. 3), t the tangent. src/methods/hbao.c is the
 * specification and says why each sample has a tangent of its own.
 */
#ifndef HBAO_GLSL
#define HBAO_GLSL

#include "falloff.glsl"
#include "frame.glsl"

const int SPACING_QUADRATIC = 1;
const int ATTENUATION_SLAB = 0;

/* The shaded point. */
struct Shaded {
    vec3 P, n;
    vec3 ray; /* through P: (0, 0, -1) or P / depth */
};

/* The slice so far. */
struct Slice {
    float horizon;   /* sin h - sin t, 0 while nothing rises over the tangent */
    float occlusion; /* attenuation slab: sum of (sin h' - sin h) W */
    float weight;    /* attenuation horizon: W at the horizon point */
};

/* How far a sample rises over its tangent, raised by the bias: sin h - sin t; -1 where
 * the bias raises the tangent past the zenith. v = S - P, r = |v|; offset is the step on
 * the image plane from P's view ray to S's. */
float rise(Shaded s, vec2 offset, vec3 v, float inverse_r)
{
    /* T is parallel to the plane (P, n) and to that of both view rays, and points to S.
     */
    const float along = dot(s.n.xy, offset), facing = -dot(s.n, s.ray);
    const vec3 T = vec3(facing * offset + along * s.ray.xy, along * s.ray.z);
    const float squared = dot(T, T);
    if (!(squared > 0))
        return -1;
    const float inverse_length = inversesqrt(squared);
    const float sin_t = T.z * inverse_length;
    const float cos_t = sqrt(dot(T.xy, T.xy)) * inverse_length;
    if (cos_t * params.cos_bias <= sin_t * params.sin_bias)
        return -1;
    return v.z * inverse_r - (sin_t * params.cos_bias + cos_t * params.sin_bias);
}

void add_sample(inout Slice slice, Shaded s, vec2 offset, vec3 S)
{
    const vec3 v = S - s.P;
    const float squared = dot(v, v);
    if (!(squared < params.radius * params.radius) || squared == 0)
        return;
    const float inverse_r = inversesqrt(squared);
    const float h = rise(s, offset, v, inverse_r);
    if (h <= slice.horizon)
        return;
    const float W = falloff(squared * inverse_r * params.inv_radius);
    slice.occlusion += (h - slice.horizon) * W;
    slice.horizon = h;
    slice.weight = W;
}

/* The projected radius, capped. */
vec2 sampled_radius(float depth)
{
    const vec2 radius_px = projected_radius(depth);
    const float largest = max(radius_px.x, radius_px.y);
    precise vec2 capped = radius_px * (params.max_radius_px / largest);
    return largest > params.max_radius_px ? capped : radius_px;
}

/* Where the i-th step comes to, as a share of the radius. */
float step_share(int i, float beta)
{
    precise float t = (float(i) + 0.5 + 0.5 * beta) / float(step_count());
    precise float squared = t * t;
    return spacing_kind() == SPACING_QUADRATIC ? squared : t;
}

/* Occlusion of one slice; `reach` is the direction times the projected radius, y down. */
float slice_occlusion(Shaded s, ivec2 at, vec2 reach, float beta)
{
    Slice slice = Slice(0, 0, 0);
    for (int i = 0; i < step_count(); i++) {
        const float t = step_share(i, beta);
        precise vec2 place = vec2(at) + 0.5 + t * reach;
        if (!(place.x >= 0 && place.x < float(params.width) && place.y >= 0
              && place.y < float(params.height)))
            break; /* background from here on */
        const ivec2 texel = ivec2(place);
        if (texel == at)
            continue;
        const vec2 offset = vec2(float(texel.x - at.x) * params.inv_fx,
                                 -float(texel.y - at.y) * params.inv_fy);
        for (int layer = 0; layer < layer_count(); layer++) {
            const float depth = depth_at(texel, layer);
            if (is_surface(depth))
                add_sample(slice, s, offset, unproject(texel, depth));
        }
    }
    return attenuation_kind() == ATTENUATION_SLAB ? slice.occlusion
                                                  : slice.horizon * slice.weight;
}

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 P = unproject(at, d);
    const vec3 ray = is_orthographic() ? vec3(0, 0, -1) : vec3(P.xy / d, -1);
    const Shaded s = Shaded(P, normal_at(at), ray);
    const vec2 radius_px = sampled_radius(d);
    float occlusion = 0;
    for (int k = 0; k < direction_count(); k++) {
        const vec2 direction = direction_at(noise, k);
        precise vec2 reach = vec2(direction.x * radius_px.x, -direction.y * radius_px.y);
        occlusion += slice_occlusion(s, at, reach, noise.beta);
    }
    return 1 - occlusion / float(direction_count());
}

#endif
