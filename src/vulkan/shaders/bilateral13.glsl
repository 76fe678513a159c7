/* SPDX-License-Identifier: MIT */
/*
 * Two passes of a one-dimensional cross-bilateral filter of 13 taps: Gaussian times
 * proximity in camera-space depth. Morgan McGuire, Brian Osman, Michael Bukowski, Padraic
 * Hennessy: The Alchemy Screen-Space Ambient Obscurance Algorithm, HPG 2011.
 * src/filters/bilateral13.c
 */
#ifndef BILATERAL13_GLSL
#define BILATERAL13_GLSL

#include "common.glsl"

const int REACH = 6;
#define LONGER_SIDE                                                                      \
    (gl_WorkGroupSize.x > gl_WorkGroupSize.y ? gl_WorkGroupSize.x : gl_WorkGroupSize.y)
#define TILE_TEXELS (gl_WorkGroupSize.x * gl_WorkGroupSize.y + 2 * REACH * LONGER_SIDE)

#include "tap.glsl"

/* exp(-k^2 / (2 sigma^2)), sigma = REACH / 2 */
const float GAUSS[REACH + 1] = {1.0,        0.94595947, 0.80073740, 0.60653066,
                                0.41111229, 0.24935221, 0.13533528};

ivec2 axis_of_pass()
{
    return filter_pass() == 0 ? ivec2(1, 0) : ivec2(0, 1);
}

ivec2 window_before()
{
    return REACH * axis_of_pass();
}

ivec2 window_after()
{
    return REACH * axis_of_pass();
}

float filtered(int index, int row)
{
    const ivec2 axis = axis_of_pass();
    const Centre centre = centre_at(index, row, axis);
    float sum = 0, weights = 0;
    for (int k = -REACH; k <= REACH; k++) {
        const Tap tap = tap_at(centre, k * axis);
        const float weight = GAUSS[abs(k)] * (1 - tap.deviation) * tap.likeness;
        const bool counts = all(bvec2(tap.likeness > 0, tap.deviation < 1));
        sum += counts ? weight * tap.value : 0;
        weights += counts ? weight : 0;
    }
    return sum / weights; /* the centre weighs 1 */
}

#endif
