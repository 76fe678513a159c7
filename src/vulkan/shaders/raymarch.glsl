/* SPDX-License-Identifier: MIT */
/*
 * Ray marching through the depth buffer: the baseline of Dimitrov, Bavoil, Sainz 2008
 * (Figure 12): Nd azimuths, and on each Nn rays whose z^2 is stratified uniformly in
 * [0, 1], which is cosine density. src/methods/raymarch.c
 */
#ifndef RAYMARCH_GLSL
#define RAYMARCH_GLSL

#include "march.glsl"

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 n = normal_at(at), origin = lifted(unproject(at, d), n);
    vec3 tangent, bitangent;
    tangents_of(n, tangent, bitangent);
    const int rays = max(normal_ray_count(), 1);
    float occlusion = sums_before(at).x;
    BentSums bent = bent_sums_before(at);
    for (int i = part_begin(); i < part_end(direction_count()); i++) {
        const vec3 t = slice_tangent(noise, i, tangent, bitangent);
        for (int k = 0; k < rays; k++) {
            precise float z2 = (float(k) + stratum_at(noise, i)) / float(rays);
            const vec3 direction = raised(n, t, z2);
            const float blocked = marched(origin, direction, noise.beta);
            occlusion += blocked;
            if (BENT_NORMAL != 0)
                bent_add(bent, direction, 1, blocked);
        }
    }
    keep_bent_sums(at, vec2(occlusion, 0), bent);
    const float total = float(direction_count() * rays), a = 1 - occlusion / total;
    if (BENT_NORMAL != 0)
        bent_normal = bent_of(bent, n, a, BENT_COSINE * total);
    return a;
}

#endif
