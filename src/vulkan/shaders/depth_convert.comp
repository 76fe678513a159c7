/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "depth.glsl"

/* A depth layer of the host's to planar depth; convert.comp does the first one. */
void main()
{
    const ivec2 at = pixel_of_invocation();
    if (in_output(at))
        write_output(at, vec4(planar_depth(at)));
}
