/* SPDX-License-Identifier: MIT */
/*
 * What the filters share: which neighbours belong to the same surface, by depth and
 * normal (src/filters/tap.h). A workgroup first takes all that its windows cover into
 * shared memory, since windows overlap: every texel is fetched once or twice instead of
 * once for each window that it lies in. The file that includes this one defines
 * TILE_TEXELS, how many that are at most.
 */
#ifndef TAP_GLSL
#define TAP_GLSL

#include "input.glsl"

shared vec4 tile_surface[TILE_TEXELS]; /* normal, depth */
shared float tile_value[TILE_TEXELS];  /* accessibility; NaN: no tap */
/* How bent normals deviate from normals, which is what is filtered of them: the mean of
 * the directions themselves would flatten curved surfaces. A single one if there are
 * none. */
shared vec3 tile_bent[(int(TILE_TEXELS) - 1) * BENT_NORMAL + 1];

/* Their mean over the window, if BENT_NORMAL is 1: filtered() sets it. */
vec3 filtered_bent = vec3(0);

/* Takes the texel `at` into the tile; what lies outside the buffers as background. All is
 * fetched first, at the nearest texel, and left out if it does not count. */
void take_texel(int index, ivec2 at)
{
    const ivec2 texel = clamp(at, ivec2(0), ivec2(params.width - 1, params.height - 1));
    const float depth = depth_at(texel, 0), value = input_at(at);
    /* The image may hold 16 bits: 1 - cos of a small angle asks for unit length. */
    const vec3 stored = normal_at(texel);
    const float squared = dot(stored, stored);
    const vec3 normal = squared > 0 ? stored * inversesqrt(squared) : stored;
    const bool is_there = all(bvec2(in_buffers(at), is_surface(depth)));
    tile_surface[index] = vec4(normal, is_there ? depth : INFINITY);
    tile_value[index] =
        all(bvec2(is_there, in_input(at))) ? value : uintBitsToFloat(0x7fc00000u);
    if (BENT_NORMAL != 0) {
        const vec3 bent = texelFetch(vector_image, input_texel(at), 0).xyz;
        tile_bent[index] = dot(bent, bent) > 0 ? bent - normal : vec3(0);
    }
}

/* Adds the deviation of a tap to the sum of them. */
void add_bent(inout vec3 sum, int index, float weight)
{
    if (BENT_NORMAL != 0)
        sum += weight * tile_bent[index];
}

/* Fills the tile with the rectangle of `size` texels from `first` on, row by row. */
void take_tile(ivec2 first, ivec2 size)
{
    const int count = size.x * size.y,
              stride = int(gl_WorkGroupSize.x * gl_WorkGroupSize.y);
    for (int index = int(gl_LocalInvocationIndex); index < count; index += stride)
        take_texel(index, first + ivec2(index % size.x, index / size.x));
    barrier();
}

/* The centre of a filter window: its place in the tile, its depth, and the depth's change
 * from pixel to pixel. */
struct Centre {
    int index, row; /* row: from a texel to the one below */
    float depth;
    vec2 slope;
    vec3 normal;
};

/* The smaller of the two one-sided differences: the one that does not cross an edge. 0 at
 * pixels without neighbours. */
float slope_along(int index, int stride, float d)
{
    const float before = d - tile_surface[index - stride].w;
    const float after = tile_surface[index + stride].w - d;
    const float slope = abs(after) < abs(before) ? after : before;
    return abs(slope) < CRV_STEEPEST_SLOPE ? slope : 0;
}

/* The slope along the axes of which `axes` is 1. */
Centre centre_at(int index, int row, ivec2 axes)
{
    const vec4 own = tile_surface[index];
    Centre c = Centre(index, row, own.w, vec2(0), own.xyz);
    if (filter_uses_slope() && axes.x == 1)
        c.slope.x = slope_along(index, 1, c.depth);
    if (filter_uses_slope() && axes.y == 1)
        c.slope.y = slope_along(index, row, c.depth);
    return c;
}

struct Tap {
    int index; /* in the tile */
    float value;
    float deviation; /* of its depth from what the centre leads one to expect, in units of
                        filter_depth */
    float likeness;  /* of its normal to the centre's, at most 1; 0 or less if there is
                        no such tap: outside the picture, background, a surface turned by
                        filter_normal or more, or one so far off that the deviation
                        overflows */
};

Tap tap_at(Centre c, ivec2 way)
{
    const int index = c.index + way.y * c.row + way.x;
    const vec4 surface = tile_surface[index];
    const float value = tile_value[index];
    const float expected =
        c.depth + float(way.x) * c.slope.x + float(way.y) * c.slope.y;
    const float deviation = abs(surface.w - expected) / params.filter_depth;
    const float turned = 1 - dot(surface.xyz, c.normal);
    const float likeness = min(1, 1 - turned * params.filter_normal);
    const bool is_tap = all(bvec2(!is_nan(value), is_surface(deviation)));
    return Tap(index, value, deviation, is_tap ? likeness : 0);
}

#endif
