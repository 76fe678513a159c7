/* SPDX-License-Identifier: MIT */
/*
 * Volumetric obscurance by line samples.
 * Bradford Loos, Peter-Pike Sloan: Volumetric Obscurance, I3D 2010.
 *
 * Lines along z of clip space through the full sphere of the radius around P; each is
 * open from where it enters the sphere to the surface: A = min(1, 2 Sum(open length) /
 * Sum(chord length)). src/methods/vo.c says how lengths are measured and why.
 */
#ifndef VO_GLSL
#define VO_GLSL

#include "frame.glsl"

/* The part of the chord [-half_chord, half_chord] in front of the surface at depth z, P
 * being at depth d. */
float open_part(float d, float z, float half_chord)
{
    if (!is_surface(z))
        return 2 * half_chord;
    const float behind = is_orthographic() ? z - d : d - d * (d / z);
    return min(max(behind, -half_chord), half_chord) + half_chord;
}

/* The open length of a line: in front of the first layer, and between a back and the next
 * front if layers come in pairs. */
float open_length(ivec2 texel, float d, float half_chord)
{
    if (!in_buffers(texel))
        return 2 * half_chord;
    float open = 0, closed = 0; /* `closed`: how far the line is decided */
    for (int layer = 0; layer < layer_count(); layer += 2) {
        const float front = open_part(d, depth_at(texel, layer), half_chord);
        open += max(0, front - closed);
        if (!layers_are_solid() || layer + 1 >= layer_count())
            return open;
        closed = max(front, open_part(d, depth_at(texel, layer + 1), half_chord));
    }
    return open + 2 * half_chord - closed;
}

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec2 radius_px = projected_radius(d);
    /* Pixels farther out than this are background anyway, and would not fit an integer.
     */
    if (!(max(radius_px.x, radius_px.y) < 1e9))
        return 1;
    const vec2 before = sums_before(at);
    float open = before.x, total = before.y;
    for (int i = part_begin(); i < part_end(pattern_count()); i++) {
        const vec2 disk = turned(noise, pattern[i].xy);
        precise vec2 place = disk * radius_px;
        const ivec2 way = ivec2(int(roundEven(place.x)), -int(roundEven(place.y)));
        /* The chord of the line through the texel's centre. */
        const vec2 offset = vec2(way) / radius_px;
        precise float rest = 1 - offset.x * offset.x - offset.y * offset.y;
        if (!(rest > 0))
            continue;
        const float half_chord = params.radius * sqrt(rest);
        open += open_length(at + way, d, half_chord);
        total += 2 * half_chord;
    }
    keep_sums(at, vec2(open, total));
    return total > 0 ? min(1, 2 * open / total) : 1;
}

#endif
