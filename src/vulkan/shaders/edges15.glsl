/* SPDX-License-Identifier: MIT */
/*
 * Two one-dimensional passes, each of three levels that take the neighbours 1, 2 and then
 * 4 pixels away. Packed edges and lonely pixels: Filip Strugar, XeGTAO, Intel, 2021;
 * levels of growing distance: Holger Dammertz, Daniel Sewtz, Johannes Hanika, Hendrik
 * Lensch, HPG 2010. src/filters/edges15.c
 */
#ifndef EDGES15_GLSL
#define EDGES15_GLSL

#include "common.glsl"

const int RADIUS = 7, LAST_STEP = 4;
const int WINDOW = RADIUS + 1; /* slopes read one texel more */
const float STRICT = 0.25, LONELY = 0.1;
const float NEAR_WEIGHT = 0.5, NEAR_EVENNESS = 0.25;
const float FAR_WEIGHT = 1.0 / 3, FAR_EVENNESS = 0.5;
#define LONGER_SIDE                                                                      \
    (gl_WorkGroupSize.x > gl_WorkGroupSize.y ? gl_WorkGroupSize.x : gl_WorkGroupSize.y)
#define TILE_TEXELS                                                                      \
    (gl_WorkGroupSize.x * gl_WorkGroupSize.y + 2 * WINDOW * LONGER_SIDE)

#include "tap.glsl"

/* From each texel to the one a level's step further along the pass's axis; 0 if one of
 * them is no tap. */
shared float tile_edge[TILE_TEXELS];

/* How much the levels before the last found: at an invocation's pixel. */
float found = 1;

ivec2 axis_of_pass()
{
    return filter_pass() == 0 ? ivec2(1, 0) : ivec2(0, 1);
}

ivec2 window_before()
{
    return WINDOW * axis_of_pass();
}

ivec2 window_after()
{
    return WINDOW * axis_of_pass();
}

bool is_tap(int index)
{
    return !is_nan(tile_value[index]);
}

/* Of two texels, q `apart` after p; `stride` between neighbours. */
float edge_between(int p, int q, int apart, int stride)
{
    const vec4 first = tile_surface[p], second = tile_surface[q];
    const float rise = second.w - first.w;
    vec2 slope = vec2(0);
    if (filter_uses_slope())
        slope = vec2(slope_along(p, stride, first.w), slope_along(q, stride, second.w));
    const vec2 off = abs(vec2(rise) - float(apart) * slope);
    const float less = min(off.x, off.y), more = max(off.x, off.y);
    const float deviation =
        (apart == 1 ? less + STRICT * (more - less) : less) / params.filter_depth;
    const float turned = 1 - dot(first.xyz, second.xyz);
    const float likeness = 1 - turned * params.filter_normal;
    const bool are_taps = all(bvec2(is_tap(p), is_tap(q)));
    return are_taps ? max(0, min(1 - deviation, likeness)) : 0;
}

/* The weights before and after, nearer to the smaller one by a portion. */
vec2 evened(vec2 sides, float portion)
{
    return sides - portion * (sides - vec2(min(sides.x, sides.y)));
}

/* Own weight, before, after. */
vec3 weights_at(int index, int reach, int apart)
{
    const vec2 edges = vec2(tile_edge[index - reach], tile_edge[index]);
    if (apart == 1) {
        const float least = LONELY * max(0, 1 - edges.x - edges.y);
        const vec2 sides = NEAR_WEIGHT * max(edges, vec2(least));
        return vec3(1, is_tap(index - reach) ? sides.x : 0,
                    is_tap(index + reach) ? sides.y : 0);
    }
    if (apart < LAST_STEP)
        return vec3(1, evened(NEAR_WEIGHT * edges, NEAR_EVENNESS));
    const float enough = min(1, 2 * found);
    return vec3(enough * enough, evened(FAR_WEIGHT * edges, FAR_EVENNESS * enough));
}

/* A level's mean at a texel, and in `bent` that of the bent normals. */
float mean_at(int index, int reach, int apart, out vec3 bent)
{
    const vec3 w = weights_at(index, reach, apart);
    const float total = w.x + w.y + w.z;
    bent = vec3(0);
    add_bent(bent, index, w.x / total);
    add_bent(bent, index - reach, w.y / total);
    add_bent(bent, index + reach, w.z / total);
    const float before = is_tap(index - reach) ? tile_value[index - reach] : 0;
    const float after = is_tap(index + reach) ? tile_value[index + reach] : 0;
    return (w.x * tile_value[index] + w.y * before + w.z * after) / total;
}

/* What an invocation does for all texels of the tile, one after the other. */
const int GROUP = int(gl_WorkGroupSize.x * gl_WorkGroupSize.y);
const int TURNS = (int(TILE_TEXELS) + GROUP - 1) / GROUP;

void take_edges(ivec2 size, int apart)
{
    const bool is_across = axis_of_pass().x == 1;
    const int count = size.x * size.y, length = is_across ? size.x : size.y;
    const int stride = is_across ? 1 : size.x;
    for (int index = int(gl_LocalInvocationIndex); index < count; index += GROUP) {
        const int place = is_across ? index % size.x : index / size.x;
        if (place > 0 && place + apart + 1 < length)
            tile_edge[index] = edge_between(index, index + apart * stride, apart, stride);
    }
    barrier();
}

/* A level but the last, in place. */
void take_level(ivec2 size, int apart)
{
    const bool is_across = axis_of_pass().x == 1;
    const int count = size.x * size.y, length = is_across ? size.x : size.y;
    const int reach = apart * (is_across ? 1 : size.x);
    float values[TURNS];
    vec3 bents[TURNS];
    for (int turn = 0; turn < TURNS; turn++) {
        const int index = int(gl_LocalInvocationIndex) + turn * GROUP;
        const int place = is_across ? index % size.x : index / size.x;
        values[turn] = uintBitsToFloat(0x7fc00000u);
        bents[turn] = vec3(0);
        if (index < count && place > apart && place + apart + 1 < length && is_tap(index))
            values[turn] = mean_at(index, reach, apart, bents[turn]);
    }
    const ivec2 own = ivec2(gl_LocalInvocationID.xy) + window_before();
    const vec3 w = weights_at(own.y * size.x + own.x, reach, apart);
    found *= (w.x + w.y + w.z) / (1 + 2 * NEAR_WEIGHT);
    barrier();
    for (int turn = 0; turn < TURNS; turn++) {
        const int index = int(gl_LocalInvocationIndex) + turn * GROUP;
        if (index >= count || is_nan(values[turn]))
            continue;
        tile_value[index] = values[turn];
        if (BENT_NORMAL != 0)
            tile_bent[index] = bents[turn];
    }
    barrier();
}

void take_levels(ivec2 size)
{
    for (int apart = 1; apart < LAST_STEP; apart *= 2) {
        take_edges(size, apart);
        take_level(size, apart);
    }
    take_edges(size, LAST_STEP);
}

#define PREPARE_TILE(size) take_levels(size)

float filtered(int index, int row)
{
    const int stride = axis_of_pass().x == 1 ? 1 : row;
    return mean_at(index, LAST_STEP * stride, LAST_STEP, filtered_bent);
}

#endif
