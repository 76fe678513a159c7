/* SPDX-License-Identifier: MIT */
/* hbao alone in a shader of your own: 8 directions of 8 steps, linear falloff. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "shared/params.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform Params { crv__params params; };
layout(binding = 1) uniform sampler2D linear_depth; /* along the view axis, +inf: none */
layout(binding = 2) uniform sampler2D view_normals; /* unit, towards the camera */
layout(binding = 3, r32f) uniform writeonly image2D result;
#include "lifted.glsl"

float depth_at(ivec2 at, int layer) { return texelFetch(linear_depth, at, 0).r; }
vec3 normal_at(ivec2 at) { return texelFetch(view_normals, at, 0).xyz; }
bool is_orthographic() { return false; }
int direction_count() { return 8; }
int step_count() { return 8; }
int spacing_kind() { return 1; }     /* quadratic */
int attenuation_kind() { return 0; } /* slab */
int falloff_kind() { return 1; }     /* linear */
vec2 direction_of(int k) { return vec2(cos(0.785398 * k), sin(0.785398 * k)); }
crv__noise_texel noise_at(ivec2 at) /* a rotation within a direction's sector, a jitter */
{
    const float a = fract(dot(vec2(at), vec2(0.754878, 0.569840))) * 0.785398;
    const float b = fract(dot(vec2(at), vec2(0.569840, 0.754878)));
    return crv__noise_texel(cos(a), sin(a), 1.999 * b - 0.9995, 0);
}
#include "hbao.glsl"

void main()
{
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(params.width, params.height))))
        return;
    const float d = depth_at(at, 0);
    imageStore(result, at, vec4(is_surface(d) ? accessibility(at, d) : 1));
}
