/* SPDX-License-Identifier: MIT */
/* The main() of every filter: filtered(index in the tile, its row length) of what is part
 * of the picture and not background. */
#ifndef FILTER_GLSL
#define FILTER_GLSL

#include "bent_output.glsl"
#include "tap.glsl"

float result_of(float depth, float own, int index, int row)
{
    if (!is_surface(depth))
        return 1;
    if (is_nan(own)) /* not part of the picture: stays so */
        return own;
    const float a = filtered(index, row);
    return a > 0 ? (a < 1 ? a : 1) : 0;
}

void main()
{
    const ivec2 at = ivec2(push.out_x, push.out_y) + ivec2(gl_GlobalInvocationID.xy);
    const ivec2 place = ivec2(gl_LocalInvocationID.xy), before = window_before();
    const int row = int(gl_WorkGroupSize.x) + before.x + window_after().x;
    const int rows = int(gl_WorkGroupSize.y) + before.y + window_after().y;
    take_tile(at - place - before, ivec2(row, rows));
#ifdef PREPARE_TILE /* what a filter derives from the tile */
    PREPARE_TILE(ivec2(row, rows));
#endif
    if (!in_output(at))
        return;
    const int index = (place.y + before.y) * row + place.x + before.x;
    const vec4 surface = tile_surface[index];
    write_output(at, vec4(result_of(surface.w, tile_value[index], index, row)));
    if (BENT_NORMAL == 0)
        return;
    if (is_surface(surface.w))
        write_bent_mean(at, surface.xyz + filtered_bent, surface.xyz);
    else
        write_bent_normal(at, vec3(0));
}

#endif
