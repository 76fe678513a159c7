/* SPDX-License-Identifier: MIT */
/* The main() of every filter: filtered(pixel) of what is part of the picture and not
 * background. */
#ifndef FILTER_GLSL
#define FILTER_GLSL

#include "tap.glsl"

float result_at(ivec2 at)
{
    if (!is_surface(depth_at(at, 0)))
        return 1;
    const float own = input_at(at);
    if (is_nan(own)) /* not part of the picture: stays so */
        return own;
    const float a = filtered(at);
    return a > 0 ? (a < 1 ? a : 1) : 0;
}

void main()
{
    const ivec2 at = pixel_of_invocation();
    if (in_output(at))
        write_output(at, vec4(result_at(at)));
}

#endif
