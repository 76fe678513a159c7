/* SPDX-License-Identifier: MIT */
/*
 * Ambient occlusion by containment tests.
 * Laszlo Szirmay-Kalos, Tamas Umenhoffer, Balazs Toth, Laszlo Szecsi, Mateu Sbert:
 * Volumetric Ambient Occlusion for Real-Time Rendering and Games, IEEE CG&A 2010.
 *
 * A ~ 1/n Sum I(P + r_i w_i) (eq. 4, 5), directions w_i with cosine density, r_i drawn by
 * the falloff, both in `pattern`; with `steps` > 1 points on the way there are tested as
 * well. src/methods/containment.c
 */
#ifndef CONTAINMENT_GLSL
#define CONTAINMENT_GLSL

#include "characteristic.glsl"

/* Whether the ray from `start` along `offset`, in radii, is free. */
bool is_free(vec3 start, vec3 offset, float beta)
{
    for (int i = 1; i < step_count(); i++) {
        precise float part = (float(i) + 0.5 * beta) / float(step_count());
        precise vec3 q = start + offset * (part * params.radius);
        if (!is_outside(q))
            return false;
    }
    precise vec3 end = start + offset * params.radius;
    return is_outside(end);
}

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 n = normal_at(at), start = lifted(unproject(at, d), n);
    vec3 tangent, bitangent;
    tangents_of(n, tangent, bitangent);
    const float first = falloff_kind() == FALLOFF_ALCHEMY ? 1 : 0;
    float sum = part_begin() > 0 ? sums_before(at).x : first;
    for (int i = part_begin(); i < part_end(pattern_count()); i++) {
        const vec4 point = pattern[i]; /* r_i * direction in radii, and its weight */
        const vec2 disk = turned(noise, point.xy);
        precise vec3 offset = disk.x * tangent + disk.y * bitangent + point.z * n;
        if (is_free(start, offset, noise.beta))
            sum += point.w;
    }
    keep_sums(at, vec2(sum, 0));
    return sum;
}

#endif
