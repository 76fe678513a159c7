/* SPDX-License-Identifier: MIT */
/*
 * A 5x5 Gaussian, each tap divided by its depth deviation from the centre.
 * Rouslan Dimitrov, Louis Bavoil, Miguel Sainz: Horizon-Split Ambient Occlusion, 2008,
 * section 4.1.3. src/filters/gauss5.c
 */
#ifndef GAUSS5_GLSL
#define GAUSS5_GLSL

#include "common.glsl"

const int REACH = 2;
#define TILE_TEXELS ((gl_WorkGroupSize.x + 2 * REACH) * (gl_WorkGroupSize.y + 2 * REACH))

#ifdef HALF_FLOATS
ivec2 lane_step()
{
    return ivec2(0, gl_WorkGroupSize.y);
}
#include "half.glsl"
#else
#include "tap.glsl"
#endif

const float BINOMIAL[REACH + 1] = {6, 4, 1}; /* the 5-tap Gaussian, unscaled */

ivec2 window_before()
{
    return ivec2(REACH);
}

ivec2 window_after()
{
    return ivec2(REACH);
}

#ifdef HALF_FLOATS
vec2 filtered(int index, int row)
{
    const Centre centre = centre_at(index, row, ivec2(1));
    f16vec2 sum = f16vec2(0), weights = f16vec2(0);
    for (int dy = -REACH; dy <= REACH; dy++) {
        for (int dx = -REACH; dx <= REACH; dx++) {
            const Taps taps = taps_at(centre, ivec2(dx, dy), 6e4);
            const f16vec2 weight = float16_t(BINOMIAL[abs(dx)] * BINOMIAL[abs(dy)])
                                   * taps.likeness / (taps.deviation + float16_t(0.125));
            sum += weight * taps.value;
            weights += weight;
        }
    }
    return mean_of(centre, sum, weights);
}
#else
float filtered(int index, int row)
{
    const Centre centre = centre_at(index, row, ivec2(1));
    float sum = 0, weights = 0;
    vec3 bent = vec3(0);
    for (int dy = -REACH; dy <= REACH; dy++) {
        for (int dx = -REACH; dx <= REACH; dx++) {
            const Tap tap = tap_at(centre, ivec2(dx, dy));
            /* An eighth keeps the centre, whose deviation is 0, finite. */
            const float weight = BINOMIAL[abs(dx)] * BINOMIAL[abs(dy)] * tap.likeness
                                 / (tap.deviation + 0.125);
            sum += tap.likeness > 0 ? weight * tap.value : 0;
            weights += tap.likeness > 0 ? weight : 0;
            add_bent(bent, tap.index, tap.likeness > 0 ? weight : 0);
        }
    }
    filtered_bent = bent / weights;
    return sum / weights; /* the centre weighs 36 * 8 */
}
#endif

#endif
