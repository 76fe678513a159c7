/* SPDX-License-Identifier: MIT */
/*
 * Volumetric ambient occlusion.
 * Laszlo Szirmay-Kalos, Tamas Umenhoffer, Balazs Toth, Laszlo Szecsi, Mateu Sbert:
 * Volumetric Ambient Occlusion for Real-Time Rendering and Games, IEEE CG&A 2010.
 *
 * The open share of the volume of the tangent sphere (radius R/2, centre P + n R/2), by n
 * pipes along z of clip space: A = Sum dz_i / F (eq. 6, 7), F = 2 R n / 3 (analytic) or
 * the sum of the chords' lengths (weighted importance sampling). src/methods/vao.c
 */
#ifndef VAO_GLSL
#define VAO_GLSL

#include "pipe.glsl"

const int NORMALISER_ANALYTIC = 1;

/* The length of the part of the pipe that is outside. */
float outside_of(Pipe pipe, float d)
{
    if (params.use_depth == 0)
        return pipe.exit_z - pipe.entry_z;
    /* The sphere touches its own surface: far away the rounding of depth would cut it. */
    const float nearer = 1 - 2e-6;
    return open_length(pipe.texel, d * nearer, pipe.entry_z, pipe.exit_z);
}

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 P = unproject(at, d), n = normal_at(at);
    const float radius = 0.5 * params.radius;
    const vec3 offset = n * radius;
    const vec2 before = sums_before(at);
    float open = before.x, chords = before.y;
    for (int i = part_begin(); i < part_end(pattern_count()); i++) {
        Pipe pipe;
        if (!pipe_through(at, P, offset, radius, pattern[i].xy, noise, pipe))
            continue;
        open += outside_of(pipe, d);
        chords += pipe.exit_z - pipe.entry_z;
    }
    keep_sums(at, vec2(open, chords));
    if (params.normaliser == NORMALISER_ANALYTIC)
        return open / (2.0 / 3.0 * params.radius * float(pattern_count()));
    return chords > 0 ? open / chords : 1;
}

#endif
