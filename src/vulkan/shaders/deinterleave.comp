/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#define OUTPUT_ARRAY
#include "common.glsl"

/* Deinterleaves the depth layers by phase; DEPTH_EDGE is that of the written image. */
void main()
{
    const ivec2 at = pixel_of_invocation();
    if (!in_output(at))
        return;
    for (int layer = 0; layer < layer_count(); layer++) {
        const float depth = texelFetch(depth_image, ivec3(at, layer), 0).r;
        imageStore(output_image, depth_texel(at, layer), vec4(depth));
    }
}
