/* SPDX-License-Identifier: MIT */
#version 460

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform sampler2D normals;
layout(set = 0, binding = 2) uniform sampler2D accessibility;
layout(push_constant) uniform Push {
    layout(offset = 68) int guard_px; /* how far depth and normals reach beyond the picture */
};
layout(location = 0) out vec4 colour;

vec3 world_normal(ivec2 at)
{
    const vec2 e = texelFetch(normals, at, 0).xy;
    const vec3 n = vec3(e, 1 - abs(e.x) - abs(e.y));
    const float fold = max(-n.z, 0);
    return normalize(vec3(n.x + (n.x >= 0 ? -fold : fold),
                          n.y + (n.y >= 0 ? -fold : fold), n.z));
}

/* Ambient occlusion is for light from all around; the sun is not its business. */
void main()
{
    const ivec2 at = ivec2(gl_FragCoord.xy);
    const vec3 sky = vec3(0.30, 0.42, 0.62);
    if (texelFetch(depth, at + guard_px, 0).r == 0) {
        colour = vec4(sky, 1);
        return;
    }
    const vec3 n = world_normal(at + guard_px);
    const vec3 ambient = mix(vec3(0.20, 0.18, 0.16), sky, 0.5 + 0.5 * n.y);
    const vec3 sun = vec3(0.36, 0.30, 0.20) * max(dot(n, normalize(vec3(0.5, 0.8, 0.3))), 0);
    colour = vec4(ambient * texelFetch(accessibility, at, 0).r + 0.8 * sun, 1);
}
