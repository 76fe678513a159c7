/* SPDX-License-Identifier: MIT */
/*
 * A 4x4 box that leaves out taps whose depth differs by more than filter_depth: with the
 * 4x4 noise tile every window holds each rotation once. Laszlo Szirmay-Kalos, Tamas
 * Umenhoffer, Balazs Toth, Laszlo Szecsi, Mateu Sbert: Volumetric Ambient Occlusion for
 * Real-Time Rendering and Games, IEEE CG&A 2010 (interleaved sampling).
 * src/filters/box4.c
 */
#ifndef BOX4_GLSL
#define BOX4_GLSL

#include "common.glsl"

const int FIRST = -2, LAST = 1;
#define TILE_TEXELS                                                                      \
    ((gl_WorkGroupSize.x + LAST - FIRST) * (gl_WorkGroupSize.y + LAST - FIRST))

#include "tap.glsl"

ivec2 window_before()
{
    return ivec2(-FIRST);
}

ivec2 window_after()
{
    return ivec2(LAST);
}

float filtered(int index, int row)
{
    const Centre centre = centre_at(index, row, ivec2(1));
    float sum = 0, count = 0;
    vec3 bent = vec3(0);
    for (int dy = FIRST; dy <= LAST; dy++) {
        for (int dx = FIRST; dx <= LAST; dx++) {
            const Tap tap = tap_at(centre, ivec2(dx, dy));
            const bool counts = all(bvec2(tap.likeness > 0, tap.deviation <= 1));
            sum += counts ? tap.value : 0;
            count += counts ? 1 : 0;
            add_bent(bent, tap.index, counts ? 1 : 0);
        }
    }
    filtered_bent = bent / count;
    return sum / count; /* the centre is always in */
}

#endif
