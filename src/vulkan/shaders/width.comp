/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#define OUTPUT_ARRAY
#include "width.glsl"

/* bitmask's map, deinterleaved as depth is. */
void main()
{
    const ivec2 at = pixel_of_invocation();
    if (in_output(at))
        write_output(at, vec4(width_at(at)));
}
