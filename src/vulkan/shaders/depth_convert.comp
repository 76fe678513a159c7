/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "depth.glsl"

/* The host's depth to planar depth. */
void main()
{
    const ivec2 at = pixel_of_invocation();
    if (in_output(at))
        write_output(at, vec4(planar_depth(at, texelFetch(host_image, at, 0).r)));
}
