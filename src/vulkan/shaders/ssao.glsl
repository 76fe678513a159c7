/* SPDX-License-Identifier: MIT */
/*
 * Screen-space ambient occlusion of CryEngine 2.
 * Martin Mittring: Finding Next Gen: CryEngine 2, SIGGRAPH 2007 courses.
 *
 * Points in the whole sphere of the radius around P; A is the share that lies nearer to
 * the eye than the stored depth. A flat wall gives 0.5; `rescale` doubles that away.
 * src/methods/ssao.c
 */
#ifndef SSAO_GLSL
#define SSAO_GLSL

#include "characteristic.glsl"

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 P = unproject(at, d);
    float outside = sums_before(at).x;
    for (int i = part_begin(); i < part_end(pattern_count()); i++) {
        const vec2 disk = turned(noise, pattern[i].xy);
        precise vec3 q = P + vec3(disk, pattern[i].z) * params.radius;
        outside += is_outside_depth(q, INFINITY) ? 1 : 0;
    }
    keep_sums(at, vec2(outside, 0));
    const float share = outside / float(pattern_count());
    return params.rescale != 0 ? min(1, 2 * share) : share;
}

#endif
