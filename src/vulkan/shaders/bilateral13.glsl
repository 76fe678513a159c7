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

#ifdef HALF_FLOATS
/* The two pixels of an invocation lie side by side across the pass's axis. */
ivec2 lane_step();
#include "half.glsl"
#else
#include "tap.glsl"
#endif

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

#ifdef HALF_FLOATS
ivec2 lane_step()
{
    return ivec2(gl_WorkGroupSize.xy) * (1 - axis_of_pass());
}

vec2 filtered(int index, int row)
{
    const ivec2 axis = axis_of_pass();
    const Centre centre = centre_at(index, row, axis);
    f16vec2 sum = f16vec2(0), weights = f16vec2(0);
    for (int k = -REACH; k <= REACH; k++) {
        const Taps taps = taps_at(centre, k * axis, 1);
        const f16vec2 weight =
            float16_t(GAUSS[abs(k)]) * (f16vec2(1) - taps.deviation) * taps.likeness;
        sum += weight * taps.value;
        weights += weight;
    }
    return mean_of(centre, sum, weights);
}
#else
float filtered(int index, int row)
{
    const ivec2 axis = axis_of_pass();
    const Centre centre = centre_at(index, row, axis);
    float sum = 0, weights = 0;
    vec3 bent = vec3(0);
    for (int k = -REACH; k <= REACH; k++) {
        const Tap tap = tap_at(centre, k * axis);
        const float weight = GAUSS[abs(k)] * (1 - tap.deviation) * tap.likeness;
        const bool counts = all(bvec2(tap.likeness > 0, tap.deviation < 1));
        sum += counts ? weight * tap.value : 0;
        weights += counts ? weight : 0;
        add_bent(bent, tap.index, counts ? weight : 0);
    }
    filtered_bent = bent / weights;
    return sum / weights; /* the centre weighs 1 */
}
#endif

#endif
