/* SPDX-License-Identifier: MIT */
/* The main() of filters in half floats, filter.glsl for two pixels: filtered(index in the
 * tile, its row length) of both. */
#ifndef FILTER_HALF_GLSL
#define FILTER_HALF_GLSL

#include "half.glsl"

float result_of(float depth, float x, float a)
{
    if (!is_surface(depth))
        return 1;
    if (x == NO_TAP) /* not part of the picture: stays so */
        return uintBitsToFloat(0x7fc00000u);
    if (x == NO_NORMAL) /* it has no weight itself, as in filter.glsl */
        return 0;
    return a > 0 ? (a < 1 ? a : 1) : 0;
}

void main()
{
    const ivec2 group = ivec2(gl_WorkGroupSize.xy);
    const ivec2 place = ivec2(gl_LocalInvocationID.xy);
    const ivec2 first = ivec2(push.out_x, push.out_y)
                        + ivec2(gl_WorkGroupID.xy) * (group + lane_step());
    const ivec2 at = first + place, other = at + lane_step(), before = window_before();
    const ivec2 size = group + before + window_after();
    take_tile(first - before, size);
    if (!in_output(at))
        return;
    const int index = (place.y + before.y) * size.x + place.x + before.x;
    const vec2 depth = tile_depth[index], a = filtered(index, size.x);
    const vec2 x = vec2(unpackFloat2x16(tile_surface[index].x));
    write_output(at, vec4(result_of(depth.x, x.x, a.x)));
    if (in_output(other))
        write_output(other, vec4(result_of(depth.y, x.y, a.y)));
}

#endif
