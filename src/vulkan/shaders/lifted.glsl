/* SPDX-License-Identifier: MIT */
/*
 * lifted.glsl: in place of common.glsl, part.glsl and level.glsl, to have an algorithm
 * alone in a shader of your own: one depth layer, all samples in one dispatch. The shader
 * declares `params` before it includes this file. docs/gpu.md lists what else it brings;
 * lifted_hbao.comp is a complete one.
 */
#ifndef LIFTED_GLSL
#define LIFTED_GLSL

#define COMMON_GLSL
#define PART_GLSL
#define LEVEL_GLSL

#define INFINITY uintBitsToFloat(0x7f800000u)

#ifndef BENT_NORMAL
#define BENT_NORMAL 0 /* 1: bent_normal of bent.glsl is computed, too */
#endif

const int BIASED = -1; /* params.sin_bias and cos_bias are read */

float depth_at(ivec2 at, int layer); /* the shader's own; layer is 0 */

bool in_buffers(ivec2 at)
{
    return all(lessThan(uvec2(at), uvec2(params.width, params.height)));
}

/* Neither background nor NaN. */
bool is_surface(float depth)
{
    return floatBitsToUint(depth) < 0x7f800000u;
}

int layer_count()
{
    return 1;
}

bool layers_are_solid()
{
    return false;
}

int part_begin()
{
    return 0;
}

int part_end(int count)
{
    return count;
}

vec2 sums_before(ivec2 at)
{
    return vec2(0);
}

void keep_sums(ivec2 at, vec2 sums)
{
}

struct BentSums {
    vec3 open, blocked;
};

BentSums bent_sums_before(ivec2 at)
{
    return BentSums(vec3(0), vec3(0));
}

void keep_bent_sums(ivec2 at, vec2 sums, BentSums bent)
{
}

int level_at(float distance_px)
{
    return 0;
}

ivec2 standing_for(ivec2 texel, int level)
{
    return texel;
}

float depth_in_level(ivec2 texel, int layer, int level)
{
    return depth_at(texel, layer);
}

#endif
