/* SPDX-License-Identifier: MIT */
/*
 * Alchemy ambient obscurance.
 * Morgan McGuire, Brian Osman, Michael Bukowski, Padraic Hennessy: The Alchemy
 * Screen-Space Ambient Obscurance Algorithm, HPG 2011.
 *
 * A = max(0, 1 - 2 sigma/s Sum max(0, v.n - d beta) / (v.v + eps))^k (eq. 10) over s
 * samples of a disk of the radius around P, parallel to the image; sigma = R * intensity
 * and k = contrast are applied where every method applies them. src/methods/alchemy.c
 */
#ifndef ALCHEMY_GLSL
#define ALCHEMY_GLSL

#include "frame.glsl"

/* Samples for a projected radius: in `bands` steps from samples/bands to all of them. */
int sample_count(float radius_px)
{
    precise float band = ceil(float(params.bands) * radius_px / params.band_px);
    const int used =
        band < float(params.bands) ? (band > 1 ? int(band) : 1) : params.bands;
    return (pattern_count() * used + params.bands - 1) / params.bands;
}

/* The term of eq. 10 of the first layer's point at this texel that lies within the
 * radius, H(R - r) in eq. 9. `raised` is d beta. */
float obscurance_of(vec3 P, vec3 n, ivec2 texel, float raised, float eps)
{
    for (int layer = 0; layer < layer_count(); layer++) {
        const float depth = depth_at(texel, layer);
        if (!is_surface(depth))
            continue;
        const vec3 v = unproject(texel, depth) - P;
        const float squared = dot(v, v);
        if (!(squared > params.radius * params.radius))
            return max(0, dot(v, n) - raised) / (squared + eps);
    }
    return 0;
}

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 P = unproject(at, d), n = normal_at(at);
    const vec2 radius_px = projected_radius(d);
    const int count = sample_count(max(radius_px.x, radius_px.y));
    const float eps = params.alchemy_eps * params.radius * params.radius;
    float sum = 0;
    for (int i = 0; i < count; i++) {
        const vec2 disk = turned(noise, pattern[i].xy); /* prefixes are well spread too */
        precise vec2 place = vec2(float(at.x) + 0.5 + disk.x * radius_px.x,
                                  float(at.y) + 0.5 - disk.y * radius_px.y);
        if (place.x >= 0 && place.x < float(params.width) && place.y >= 0
            && place.y < float(params.height))
            sum += obscurance_of(P, n, ivec2(place), d * params.alchemy_bias, eps);
    }
    return 1 - 2 * params.radius * sum / float(count);
}

#endif
