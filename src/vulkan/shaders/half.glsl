/* SPDX-License-Identifier: MIT */
/*
 * Filters in half floats, for devices that have them (shaderFloat16): an invocation
 * filters two pixels, a lane each of every f16vec2, so that one packed instruction does
 * both. They differ by a workgroup's edge along lane_step(), as do their taps, and
 * the tile in shared memory holds such pairs: nothing is shuffled.
 *
 * What keeps the error below 1e-3 of accessibility:
 *   - depth stays in 32 bits; its deviation from what is expected becomes a half float.
 *   - 1 - a.b of unit vectors is |a - b|^2 / 2, whose difference is taken first: a half
 *     float keeps 1 - cos of a small angle that way, and not the other.
 *   - values are taken as differences to the centre's, which weights then scale: an error
 *     of a weight counts by how much the values differ.
 */
#ifndef HALF_GLSL
#define HALF_GLSL

#include "input.glsl"

/* Normals times sqrt(filter_normal / 2), x y z; accessibility. */
shared uvec4 tile_surface[TILE_TEXELS];
shared vec2 tile_depth[TILE_TEXELS]; /* background: +inf */

/* In place of x, farther off than any normal: there is no tap; a tap has no normal, and
 * is like no other. Where normals count, filter_normal is 1 or more (program.c). */
const float NO_TAP = 100, NO_NORMAL = -100;

struct Texel {
    vec3 normal;
    float value, depth;
};

/* What lies outside the buffers is background. All is fetched first, at the nearest
 * texel, and left out if it does not count. */
Texel texel_at(ivec2 at)
{
    const ivec2 texel = clamp(at, ivec2(0), ivec2(params.width - 1, params.height - 1));
    const float depth = depth_at(texel, 0), value = input_at(at);
    const vec3 stored = normal_at(texel);
    const float squared = dot(stored, stored);
    const float scale = squared > 0 ? inversesqrt(squared) : 1;
    const bool is_there = all(bvec2(in_buffers(at), is_surface(depth)));
    const bool is_tap = all(bvec3(is_there, in_input(at), !is_nan(value)));
    const vec3 normal = squared > 0 || params.filter_normal == 0
                            ? stored * (scale * sqrt(0.5 * params.filter_normal))
                            : vec3(NO_NORMAL, 0, 0);
    return Texel(is_tap ? normal : vec3(NO_TAP, 0, 0), is_tap ? value : 0,
                 is_there ? depth : INFINITY);
}

uint packed(float a, float b)
{
    return packFloat2x16(f16vec2(a, b));
}

/* Fills the tile with the rectangles of `size` texels from `first` and from `first` +
 * lane_step() on, row by row. */
void take_tile(ivec2 first, ivec2 size)
{
    const int count = size.x * size.y,
              stride = int(gl_WorkGroupSize.x * gl_WorkGroupSize.y);
    for (int index = int(gl_LocalInvocationIndex); index < count; index += stride) {
        const ivec2 at = first + ivec2(index % size.x, index / size.x);
        const Texel a = texel_at(at), b = texel_at(at + lane_step());
        tile_surface[index] = uvec4(packed(a.normal.x, b.normal.x),
                                    packed(a.normal.y, b.normal.y),
                                    packed(a.normal.z, b.normal.z),
                                    packed(a.value, b.value));
        tile_depth[index] = vec2(a.depth, b.depth);
    }
    barrier();
}

/* As in tap.glsl, a pair of each. */
struct Centre {
    int index, row;
    vec2 depth, slope_x, slope_y;
    f16vec2 nx, ny, nz, value;
};

float slope_between(float before, float d, float after)
{
    const float left = d - before, right = after - d;
    const float slope = abs(right) < abs(left) ? right : left;
    return abs(slope) < CRV_STEEPEST_SLOPE ? slope : 0;
}

vec2 slope_along(int index, int stride, vec2 d)
{
    const vec2 before = tile_depth[index - stride], after = tile_depth[index + stride];
    return vec2(slope_between(before.x, d.x, after.x),
                slope_between(before.y, d.y, after.y));
}

Centre centre_at(int index, int row, ivec2 axes)
{
    const uvec4 own = tile_surface[index];
    Centre c = Centre(index, row, tile_depth[index], vec2(0), vec2(0),
                      unpackFloat2x16(own.x), unpackFloat2x16(own.y),
                      unpackFloat2x16(own.z), unpackFloat2x16(own.w));
    if (filter_uses_slope() && axes.x == 1)
        c.slope_x = slope_along(index, 1, c.depth);
    if (filter_uses_slope() && axes.y == 1)
        c.slope_y = slope_along(index, row, c.depth);
    return c;
}

struct Taps {
    f16vec2 value;     /* less the centre's */
    f16vec2 deviation; /* at most `most`, also where there is no tap */
    f16vec2 likeness;  /* 0 to 1; 0 where there is no tap */
};

Taps taps_at(Centre c, ivec2 way, float most)
{
    const int index = c.index + way.y * c.row + way.x;
    const uvec4 surface = tile_surface[index];
    const vec2 expected =
        c.depth + float(way.x) * c.slope_x + float(way.y) * c.slope_y;
    const vec2 deviation =
        min(abs(tile_depth[index] - expected) * (1 / params.filter_depth), most);
    const f16vec2 x = unpackFloat2x16(surface.x) - c.nx,
                  y = unpackFloat2x16(surface.y) - c.ny,
                  z = unpackFloat2x16(surface.z) - c.nz;
    const f16vec2 turned = x * x + y * y + z * z;
    return Taps(unpackFloat2x16(surface.w) - c.value, f16vec2(deviation),
                max(f16vec2(1) - turned, f16vec2(0)));
}

/* The mean of values, from sums of weights and of weights times values. */
vec2 mean_of(Centre c, f16vec2 sum, f16vec2 weights)
{
    return vec2(c.value) + vec2(sum) / vec2(weights);
}

#endif
