/* SPDX-License-Identifier: MIT */
/*
 * Alchemy ambient obscurance.
 * Morgan McGuire, Brian Osman, Michael Bukowski, Padraic Hennessy: The Alchemy
 * Screen-Space Ambient Obscurance Algorithm, HPG 2011.
 *
 * A = max(0, 1 - 2 sigma/s Sum max(0, v.n - d beta) / (v.v + eps))^k (eq. 10) over s
 * samples of a disk of the radius around P, parallel to the image; sigma = R * intensity
 * and k = contrast are applied in estimate.glsl. src/methods/alchemy.c
 */
#ifndef ALCHEMY_GLSL
#define ALCHEMY_GLSL

#include "frame.glsl"
#include "level.glsl"

/* Samples for a projected radius: in `bands` steps from samples/bands to all of them. */
int sample_count(float radius_px)
{
    precise float band = ceil(float(params.bands) * radius_px / params.band_px);
    const int used =
        band < float(params.bands) ? (band > 1 ? int(band) : 1) : params.bands;
    return (pattern_count() * used + params.bands - 1) / params.bands;
}

/* The term of eq. 10 of the first layer's point at this texel that lies within the
 * radius, H(R - r) in eq. 9. `offset` is the way to it on the image plane. */
float obscurance_of(vec3 ray, float d, vec3 n, vec2 offset, ivec2 texel, int level)
{
    const float eps = params.alchemy_eps * params.radius * params.radius;
    float result = 0;
    bool found = false;
    for (int layer = 0; layer < layer_count(); layer++) {
        const float depth = depth_in_level(texel, layer, level);
        const vec3 v = between(ray, d, offset, depth);
        const float squared = dot(v, v);
        const float term = max(0, dot(v, n) - d * params.alchemy_bias) / (squared + eps);
        const bool counts = all(
            bvec3(is_surface(depth), !found, squared <= params.radius * params.radius));
        result = counts ? term : result;
        found = found || counts;
    }
    return result;
}

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 ray = view_ray(unproject(at, d), d), n = normal_at(at);
    const vec2 radius_px = projected_radius(d);
    const int count = sample_count(max(radius_px.x, radius_px.y));
    float sum = sums_before(at).x;
    for (int i = part_begin(); i < part_end(count); i++) {
        const vec2 disk = turned(noise, pattern[i].xy); /* prefixes are well spread too */
        precise vec2 place = vec2(float(at.x) + 0.5 + disk.x * radius_px.x,
                                  float(at.y) + 0.5 - disk.y * radius_px.y);
        const vec2 inside = clamped_place(place);
        const int level = level_at(length(disk * radius_px));
        const ivec2 texel = standing_for(ivec2(inside), level);
        const float term =
            obscurance_of(ray, d, n, image_offset(at, texel), texel, level);
        sum += inside == place ? term : 0; /* beyond is background */
    }
    keep_sums(at, vec2(sum, 0));
    return 1 - 2 * params.radius * sum / float(count);
}

#endif
