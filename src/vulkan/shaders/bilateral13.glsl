/* SPDX-License-Identifier: MIT */
/*
 * Two passes of a one-dimensional cross-bilateral filter of 13 taps: Gaussian times
 * proximity in camera-space depth. Morgan McGuire, Brian Osman, Michael Bukowski, Padraic
 * Hennessy: The Alchemy Screen-Space Ambient Obscurance Algorithm, HPG 2011.
 * src/filters/bilateral13.c
 */
#ifndef BILATERAL13_GLSL
#define BILATERAL13_GLSL

#include "tap.glsl"

const int REACH = 6;

/* exp(-k^2 / (2 sigma^2)), sigma = REACH / 2 */
const float GAUSS[REACH + 1] = {1.0,        0.94595947, 0.80073740, 0.60653066,
                                0.41111229, 0.24935221, 0.13533528};

float filtered(ivec2 at)
{
    const Centre centre = centre_at(at);
    const ivec2 axis = push.pass == 0 ? ivec2(1, 0) : ivec2(0, 1);
    float sum = 0, weights = 0;
    for (int k = -REACH; k <= REACH; k++) {
        Tap tap;
        if (!tap_at(centre, k * axis, tap) || tap.deviation >= 1)
            continue;
        const float weight = GAUSS[abs(k)] * (1 - tap.deviation) * tap.likeness;
        sum += weight * tap.value;
        weights += weight;
    }
    return sum / weights; /* the centre weighs 1 */
}

#endif
