/* SPDX-License-Identifier: MIT */
/*
 * Two one-dimensional passes of 7 taps, weighted by the product of the edges on the way
 * to them. Packed edges and lonely pixels: Filip Strugar, XeGTAO, Intel, 2021.
 * src/filters/edges7.c
 */
#ifndef EDGES7_GLSL
#define EDGES7_GLSL

#include "common.glsl"

const int RADIUS = 3;
const int WINDOW = RADIUS + 1; /* slopes read one texel more */
const float LONELY = 0.07;
#define LONGER_SIDE                                                                      \
    (gl_WorkGroupSize.x > gl_WorkGroupSize.y ? gl_WorkGroupSize.x : gl_WorkGroupSize.y)
#define TILE_TEXELS                                                                      \
    (gl_WorkGroupSize.x * gl_WorkGroupSize.y + 2 * WINDOW * LONGER_SIDE)

#include "tap.glsl"

/* From each texel to the next along the pass's axis; 0 if one of them is no tap. */
shared float tile_edge[TILE_TEXELS];

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

float edge_between(int p, int q, int stride)
{
    const vec4 first = tile_surface[p], second = tile_surface[q];
    const float rise = second.w - first.w;
    vec2 slope = vec2(0);
    if (filter_uses_slope())
        slope = vec2(slope_along(p, stride, first.w), slope_along(q, stride, second.w));
    const vec2 off = abs(vec2(rise) - slope);
    const float deviation = (off.x + off.y) * 0.5 / params.filter_depth;
    const float turned = 1 - dot(first.xyz, second.xyz);
    const float likeness = min(1, 1 - turned * params.filter_normal);
    const bool are_taps = all(bvec2(!is_nan(tile_value[p]), !is_nan(tile_value[q])));
    return are_taps ? max(0, 1 - deviation) * max(0, likeness) : 0;
}

/* All edges of a tile, once for the windows that they lie in. */
void take_edges(ivec2 size)
{
    const ivec2 axis = axis_of_pass();
    const int count = size.x * size.y, length = axis.x == 1 ? size.x : size.y;
    const int stride = axis.x == 1 ? 1 : size.x;
    const int group = int(gl_WorkGroupSize.x * gl_WorkGroupSize.y);
    for (int index = int(gl_LocalInvocationIndex); index < count; index += group) {
        const int place = axis.x == 1 ? index % size.x : index / size.x;
        if (place > 0 && place + 2 < length)
            tile_edge[index] = edge_between(index, index + stride, stride);
    }
    barrier();
}

#define PREPARE_TILE(size) take_edges(size)

/* What one side adds to the sum of values and to that of weights, and to that of bent
 * normals; `edge`: from the centre to its first tap. */
vec2 side_of(int index, int stride, float edge, inout vec3 bent)
{
    const int before = stride < 0 ? stride : 0; /* the edge's earlier texel has it */
    vec2 sums = vec2(0);
    float product = edge;
    for (int k = 1; k <= RADIUS; k++) {
        const float value = tile_value[index + k * stride];
        if (k > 1)
            product *= tile_edge[index + (k - 1) * stride + before];
        product = is_nan(value) ? 0 : product;
        const float weight = float(RADIUS + 1 - k) * product;
        sums += is_nan(value) ? vec2(0) : weight * vec2(value, 1);
        add_bent(bent, index + k * stride, weight);
    }
    return sums;
}

float filtered(int index, int row)
{
    const int stride = axis_of_pass().x == 1 ? 1 : row;
    const float before = tile_edge[index - stride], after = tile_edge[index];
    const float least = LONELY * max(0, 1 - before - after);
    vec3 bent = vec3(0);
    add_bent(bent, index, float(RADIUS + 1));
    const vec2 sums = float(RADIUS + 1) * vec2(tile_value[index], 1)
                      + side_of(index, -stride, max(before, least), bent)
                      + side_of(index, stride, max(after, least), bent);
    filtered_bent = bent / sums.y;
    return sums.x / sums.y;
}

#endif
