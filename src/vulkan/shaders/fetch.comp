/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

/*
 * Measures how fast depth can be fetched: 64 depths for each pixel, by one of several
 * paths in one of several patterns (crv_context_device_fetches()). Nothing is written
 * unless their sum is one that none has.
 */
#include "common.glsl"

layout(constant_id = 20) const int PATH = 0;
layout(constant_id = 21) const int PATTERN = 0;

/* crv_fetch_path, crv_fetch_pattern (crevice/context.h) */
const int SAMPLED = 0, STORAGE_IMAGE = 1, BUFFER = 2, GATHER = 3, SHARED = 4;
const int ROW = 0, NEAR = 1, DISK = 2, IN_STEP = 3;

layout(set = 0, binding = 3) readonly buffer Rows
{
    float rows[];
};
layout(set = 0, binding = 7, r32f) uniform image2DArray depth_storage;

const int COUNT = 64, STEPS_OUT = 8;
/* What a workgroup of 8x8 pixels covers in the patterns that fit into shared memory. */
const int TILE = PATTERN == ROW ? 72 * 8 : 24 * 24;
const int TILE_ROW = PATTERN == ROW ? 72 : 24;
shared float tile[TILE];

ivec2 before_tile()
{
    return PATTERN == ROW ? ivec2(32, 0) : ivec2(8);
}

ivec2 size()
{
    return textureSize(depth_image, 0).xy * DEPTH_EDGE;
}

void take_tile()
{
    const ivec2 first = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) - before_tile();
    for (int i = int(gl_LocalInvocationIndex); i < TILE; i += 64) {
        const ivec2 at = first + ivec2(i % TILE_ROW, i / TILE_ROW);
        tile[i] = depth_at(clamp(at, ivec2(0), size() - 1), 0);
    }
    barrier();
}

float fetched(ivec2 at)
{
    if (PATH == SHARED) {
        const ivec2 place =
            at - ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) + before_tile();
        return tile[place.y * TILE_ROW + place.x];
    }
    const ivec3 texel = depth_texel(at, 0);
    if (PATH == SAMPLED)
        return texelFetch(depth_image, texel, 0).r;
    if (PATH == STORAGE_IMAGE)
        return imageLoad(depth_storage, texel).r;
    if (PATH == BUFFER) {
        const ivec2 part = textureSize(depth_image, 0).xy;
        return rows[(texel.z * part.y + texel.y) * part.x + texel.x];
    }
    const vec2 corner = vec2(texel.xy + 1) / vec2(textureSize(depth_image, 0).xy);
    const vec4 four = textureGather(depth_image, vec3(corner, texel.z));
    return four.x + four.y + four.z + four.w;
}

/* The i-th place that is looked at; those beyond the image at its border. */
ivec2 place_of(ivec2 at, vec2 direction, int i)
{
    ivec2 place;
    if (PATTERN == ROW)
        place = ivec2(at.x + i - COUNT / 2, at.y);
    else
        place = ivec2(floor(vec2(at) + 0.5
                            + (float(i % STEPS_OUT) + 0.5) / float(STEPS_OUT)
                                  * (PATTERN == NEAR ? 8 : 64) * direction));
    return PATH == SHARED ? place : clamp(place, ivec2(0), size() - 1);
}

void main()
{
    const ivec2 at = pixel_of_invocation(), phase = at % 4;
    if (PATH == SHARED)
        take_tile();
    const float turn = 0.7853982, angle = turn / 16 * float(phase.y * 4 + phase.x);
    vec2 direction = vec2(cos(angle), sin(angle));
    const int step = PATH == GATHER ? 4 : 1;
    float sum = 0;
    for (int i = 0; i < COUNT; i += step) {
        sum += fetched(place_of(at, direction, i));
        if (i % STEPS_OUT + step >= STEPS_OUT) /* an eighth of a turn */
            direction = 0.70710678 * vec2(direction.x - direction.y,
                                          direction.x + direction.y);
    }
    if (sum < 0)
        imageStore(depth_storage, ivec3(at, 0), vec4(sum));
}
