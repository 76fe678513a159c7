/* SPDX-License-Identifier: MIT */
/*
 * Horizon-based ambient occlusion.
 * Louis Bavoil, Miguel Sainz, Rouslan Dimitrov: Image-Space Horizon-Based Ambient
 * Occlusion, SIGGRAPH 2008 talks.
 *
 * In each of the slices that directions theta cut from the hemisphere, the depth buffer
 * is marched outwards and the horizon h, the largest elevation so far, is kept: A = 1 -
 * 1/(2 pi) Int (sin h - sin t) W dtheta (eq. 3), t the tangent. src/methods/hbao.c is the
 * specification and says why each sample has a tangent of its own.
 */
#ifndef HBAO_GLSL
#define HBAO_GLSL

#include "falloff.glsl"
#include "frame.glsl"
#include "level.glsl"

const int SPACING_QUADRATIC = 1;
const int ATTENUATION_SLAB = 0;

/* The shaded point P, on the image plane at `ray`. */
struct Shaded {
    float depth;
    vec3 ray; /* P / depth; (0, 0, -1) if rays are parallel */
    vec3 n;
    float facing; /* -n.ray */
};

/* The slice so far. */
struct Slice {
    float horizon;   /* sin h - sin t, 0 while nothing rises over the tangent */
    float occlusion; /* attenuation slab: sum of (sin h' - sin h) W */
    float weight;    /* attenuation horizon: W at the horizon point */
};

/*
 * -sin t of the sample's own tangent T, raised by the bias; offset is the way on the
 * image plane from P's view ray to the sample's. T is parallel to the plane (P, n) and to
 * that of both view rays, and points to the sample. -2 if the bias raises the tangent
 * past the zenith.
 */
float tangent_fall(Shaded s, vec2 offset)
{
    const float along = dot(s.n.xy, offset); /* -T.z */
    const vec2 T = s.facing * offset + along * s.ray.xy;
    const float fall = along * inversesqrt(dot(T, T) + along * along);
    if (BIASED == 0)
        return fall;
    const float cos_t = sqrt(max(0, 1 - fall * fall));
    return cos_t * params.cos_bias > -fall * params.sin_bias
               ? fall * params.cos_bias - cos_t * params.sin_bias
               : -2;
}

/* v = S - P of a surface point S. Where S is P, h is NaN, and nothing is added. */
void add_sample(inout Slice slice, Shaded s, vec2 offset, vec3 v, bool is_there)
{
    const float squared = dot(v, v);
    const float inverse_r = inversesqrt(squared);
    const float h = v.z * inverse_r + tangent_fall(s, offset);
    const float W = falloff_within(squared * inverse_r * params.inv_radius);
    const bool raises =
        all(bvec3(is_there, squared<params.radius * params.radius, h> slice.horizon));
    slice.occlusion += raises ? (h - slice.horizon) * W : 0;
    slice.horizon = raises ? h : slice.horizon;
    slice.weight = raises ? W : slice.weight;
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

/* Occlusion of one slice; `span` is the direction times the projected radius, y down. */
float slice_occlusion(Shaded s, ivec2 at, vec2 span, float beta)
{
    Slice slice = Slice(0, 0, 0);
    const float span_px = length(span);
    for (int i = 0; i < step_count(); i++) {
        const float t = step_share(i, beta);
        precise vec2 place = vec2(at) + 0.5 + t * span;
        const vec2 inside = clamped_place(place); /* beyond is background */
        const int level = level_at(t * span_px);
        const ivec2 texel = standing_for(ivec2(inside), level);
        const vec2 offset = image_offset(at, texel);
        for (int layer = 0; layer < layer_count(); layer++) {
            const float depth = depth_in_level(texel, layer, level);
            add_sample(slice, s, offset, between(s.ray, s.depth, offset, depth),
                       all(bvec2(inside == place, is_surface(depth))));
        }
    }
    return attenuation_kind() == ATTENUATION_SLAB ? slice.occlusion
                                                  : slice.horizon * slice.weight;
}

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 ray = view_ray(unproject(at, d), d), n = normal_at(at);
    const Shaded s = Shaded(d, ray, n, -dot(n, ray));
    const vec2 radius_px = sampled_radius(d);
    float occlusion = sums_before(at).x;
    for (int k = part_begin(); k < part_end(direction_count()); k++) {
        const vec2 direction = direction_at(noise, k);
        precise vec2 span = vec2(direction.x * radius_px.x, -direction.y * radius_px.y);
        occlusion += slice_occlusion(s, at, span, noise.beta);
    }
    keep_sums(at, vec2(occlusion, 0));
    return 1 - occlusion / float(direction_count());
}

#endif
