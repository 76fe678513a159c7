/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "normals.glsl"

/*
 * The host's first depth layer to planar depth, and its normals, or none, to unit normals
 * in view space that face the camera; background: 0. In one go: a second dispatch would
 * have to read that depth again.
 */
void main()
{
    const ivec2 at = pixel_of_invocation();
    take_tile();
    if (!in_output(at))
        return;
    const float d = depth_in_tile(at);
    const vec3 n = is_surface(d) ? final_normal(at, d) : vec3(0);
    write_output(at, vec4(d));
    write_vectors(at, NORMALS_OCTAHEDRAL != 0 ? vec4(octahedral_encoded(n), 0, 0)
                                              : vec4(n, 0));
}
