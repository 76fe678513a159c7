/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "input.glsl"

/* Copies the rectangle inside the guard band to the host's image. */
void main()
{
    const ivec2 at = pixel_of_invocation();
    if (in_output(at))
        write_output(at, vec4(input_at(at)));
}
