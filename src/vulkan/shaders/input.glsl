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

/* The nearest texel if not in_input(at). */
ivec2 input_texel(ivec2 at)
{
    const ivec2 last = ivec2(push.in_width - 1, push.in_height - 1);
    return clamp(at - ivec2(push.in_x, push.in_y), ivec2(0), last);
}

float input_at(ivec2 at)
{
    return texelFetch(input_image, input_texel(at), 0).r;
}

#endif
