/* SPDX-License-Identifier: MIT */
/*
 * A 5x5 Gaussian, each tap divided by its depth deviation from the centre.
 * Rouslan Dimitrov, Louis Bavoil, Miguel Sainz: Horizon-Split Ambient Occlusion, 2008,
 * section 4.1.3. src/filters/gauss5.c
 */
#ifndef GAUSS5_GLSL
#define GAUSS5_GLSL

#include "tap.glsl"

const int REACH = 2;
const float BINOMIAL[REACH + 1] = {6, 4, 1}; /* the 5-tap Gaussian, unscaled */

float filtered(ivec2 at)
{
    const Centre centre = centre_at(at);
    float sum = 0, weights = 0;
    for (int dy = -REACH; dy <= REACH; dy++) {
        for (int dx = -REACH; dx <= REACH; dx++) {
            Tap tap;
            if (!tap_at(centre, ivec2(dx, dy), tap))
                continue;
            /* An eighth keeps the centre, whose deviation is 0, finite. */
            const float weight = BINOMIAL[abs(dx)] * BINOMIAL[abs(dy)] * tap.likeness
                                 / (tap.deviation + 0.125);
            sum += weight * tap.value;
            weights += weight;
        }
    }
    return sum / weights; /* the centre weighs 36 * 8 */
}

#endif
