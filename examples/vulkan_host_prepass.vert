/* SPDX-License-Identifier: MIT */
#version 460

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 world_normal;

layout(push_constant) uniform Push {
    mat4 view_projection;
};

void main()
{
    world_normal = normal;
    gl_Position = view_projection * vec4(position, 1);
}
