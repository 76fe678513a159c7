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

#include "tap.glsl"

const int FIRST = -2, LAST = 1;

float filtered(ivec2 at)
{
    const Centre centre = centre_at(at);
    float sum = 0, count = 0;
    for (int dy = FIRST; dy <= LAST; dy++) {
        for (int dx = FIRST; dx <= LAST; dx++) {
            Tap tap;
            if (!tap_at(centre, ivec2(dx, dy), tap) || tap.deviation > 1)
                continue;
            sum += tap.value;
            count += 1;
        }
    }
    return sum / count; /* the centre is always in */
}

#endif
