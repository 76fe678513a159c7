/* SPDX-License-Identifier: MIT */
/* The accessibility that a filter reads. `at` is in pixels of the buffers. */
#ifndef INPUT_GLSL
#define INPUT_GLSL

#include "common.glsl"

bool in_input(ivec2 at)
{
    const ivec2 place = at - ivec2(push.in_x, push.in_y);
    return all(lessThan(uvec2(place), uvec2(push.in_width, push.in_height)));
}

/* The nearest one if not in_input(at). */
float input_at(ivec2 at)
{
    const ivec2 last = ivec2(push.in_width - 1, push.in_height - 1);
    const ivec2 place = at - ivec2(push.in_x, push.in_y);
    return texelFetch(input_image, clamp(place, ivec2(0), last), 0).r;
}

#endif
