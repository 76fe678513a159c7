/* SPDX-License-Identifier: MIT */
#version 460

layout(location = 0) in vec3 world_normal;
layout(location = 0) out vec2 octahedral;

/* The direction on an octahedron, its lower half folded out over the corners. */
void main()
{
    const vec3 n =
        world_normal / (abs(world_normal.x) + abs(world_normal.y) + abs(world_normal.z));
    const vec2 signs = vec2(n.x >= 0 ? 1 : -1, n.y >= 0 ? 1 : -1);
    octahedral = n.z >= 0 ? n.xy : (1 - abs(n.yx)) * signs;
}
