/* SPDX-License-Identifier: MIT */
/*
 * Estimates in parts. Where a pixel has thousands of samples, one dispatch would keep a
 * device busy for so long that drivers take it for lost: such estimates are computed by
 * several dispatches, each of which goes on with the sums of the one before. To lift an
 * algorithm, begin at 0, end at the count, and leave the sums out.
 */
#ifndef PART_GLSL
#define PART_GLSL

#include "common.glsl"

/* 0: all samples at once. */
layout(constant_id = 20) const int IN_PARTS = 0;

/* The directions or points of this dispatch. */
int part_begin()
{
    return IN_PARTS != 0 ? push.part_begin : 0;
}

int part_end(int count)
{
    return IN_PARTS != 0 ? min(push.part_end, count) : count;
}

bool is_last_part()
{
    return IN_PARTS == 0 || push.is_last_part != 0;
}

/* What the parts before have added up; input_image then holds it. */
vec2 sums_before(ivec2 at)
{
    const bool is_first = IN_PARTS == 0 || push.part_begin == 0;
    return is_first
               ? vec2(0)
               : texelFetch(input_image, at - ivec2(push.out_x, push.out_y), 0).rg;
}

/* What bent.glsl adds up. */
struct BentSums {
    vec3 open, blocked;
};

/* The same of bent normals: the rest of input_image, and vector_image. */
BentSums bent_sums_before(ivec2 at)
{
    if (BENT_NORMAL == 0 || IN_PARTS == 0 || push.part_begin == 0)
        return BentSums(vec3(0), vec3(0));
    const ivec2 place = at - ivec2(push.out_x, push.out_y);
    const vec4 rest = texelFetch(vector_image, place, 0);
    return BentSums(vec3(texelFetch(input_image, place, 0).zw, rest.x), rest.yzw);
}

/* Leaves the sums to the next part. */
void keep_sums(ivec2 at, vec2 sums)
{
    if (!is_last_part())
        write_output(at, vec4(sums, 0, 0));
}

void keep_bent_sums(ivec2 at, vec2 sums, BentSums bent)
{
    if (is_last_part())
        return;
    write_output(at, vec4(sums, bent.open.xy));
    if (BENT_NORMAL != 0)
        write_vectors(at, vec4(bent.open.z, bent.blocked));
}

#endif
