/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "level.glsl"

/* Makes level push.pass of depth layer push.layer from level 0; the output image is that
 * level of that layer. No level waits for another. */
void main()
{
    const ivec2 at = pixel_of_invocation();
    if (!in_output(at))
        return;
    const ivec2 last = ivec2(params.width - 1, params.height - 1);
    const ivec2 source = min(source_of(at, push.pass), last);
    write_output(at, vec4(texelFetch(depth_image, ivec3(source, push.layer), 0).r));
}
