/* SPDX-License-Identifier: MIT */
/*
 * common.glsl: what every shader sees: numbers, images, and what may be fixed when a
 * pipeline is made. To lift an algorithm into a renderer of your own, include lifted.glsl
 * instead.
 */
#ifndef COMMON_GLSL
#define COMMON_GLSL

#include "shared/params.h"
#include "shared/push.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(local_size_x = 8, local_size_y = 8) in;

/* The compiler unrolls and folds what the host fixes; -1: read from `params`. */
layout(constant_id = 2) const int FALLOFF = -1;
layout(constant_id = 3) const int DIRECTIONS = -1;
layout(constant_id = 4) const int STEPS = -1;
layout(constant_id = 5) const int NORMAL_RAYS = -1;
layout(constant_id = 6) const int SAMPLES = -1;
layout(constant_id = 7) const int ATTENUATION = -1;
layout(constant_id = 8) const int LAYERS = -1;
layout(constant_id = 9) const int ORTHOGRAPHIC = -1;
layout(constant_id = 10) const int NOISE_SIZE = -1;
layout(constant_id = 11) const int FILTER_SLOPE = -1;
layout(constant_id = 12) const int LAYERS_SOLID = -1;
layout(constant_id = 14) const int SPACING = -1;
layout(constant_id = 17) const int BIASED = -1; /* 0: bias_deg is 0 */
layout(constant_id = 18) const int FILTER_PASS = -1;
/* 1: bent normals are computed, too; and how they are left: bent.glsl. */
layout(constant_id = 21) const int BENT_NORMAL = 0;
layout(constant_id = 22) const int BENT_FORM = 0;

/* 1, or the edge of the noise tile: see pixel_of_invocation(). */
layout(constant_id = 13) const int PIXEL_STRIDE = 1;
/* 1, or the edge of the phases by which the depth image is deinterleaved: depth_at(). */
layout(constant_id = 16) const int DEPTH_EDGE = 1;
/* 1: the image of normals holds two octahedral numbers instead of x, y, z. */
layout(constant_id = 15) const int NORMALS_OCTAHEDRAL = 0;

layout(std140, set = 0, binding = 0) uniform Params
{
    crv__params params;
};
layout(std430, set = 0, binding = 1) readonly buffer Noise
{
    crv__noise_texel noise_tile[]; /* noise_size * noise_size */
};
layout(std430, set = 0, binding = 2) readonly buffer Directions
{
    vec2 direction_table[]; /* (cos, sin) of 2 pi k / directions */
};
layout(std430, set = 0, binding = 3) readonly buffer Pattern
{
    vec4 pattern[]; /* the method's points */
};
layout(set = 0, binding = 4) uniform sampler2DArray depth_image; /* background: +inf */
layout(set = 0, binding = 5) uniform sampler2D normal_image;
layout(set = 0, binding = 6) uniform sampler2D input_image; /* accessibility */
#ifdef OUTPUT_ARRAY
layout(set = 0, binding = 7) uniform writeonly image2DArray output_image;
#else
layout(set = 0, binding = 7) uniform writeonly image2D output_image;
#endif
layout(set = 0, binding = 8) uniform sampler2D host_depth; /* of one layer */
/* The host's normals; bent normals to be filtered; sums of bent normals. */
layout(set = 0, binding = 9) uniform sampler2D vector_image;
layout(set = 0, binding = 10) uniform writeonly image2D vector_output;
layout(set = 0, binding = 11) uniform sampler2DArray map_image; /* lies as depth does */

layout(push_constant) uniform Push
{
    crv__push push;
};

#define INFINITY uintBitsToFloat(0x7f800000u)

int falloff_kind()
{
    return FALLOFF < 0 ? params.falloff : FALLOFF;
}

int direction_count()
{
    return DIRECTIONS < 0 ? params.directions : DIRECTIONS;
}

int step_count()
{
    return STEPS < 0 ? params.steps : STEPS;
}

int normal_ray_count()
{
    return NORMAL_RAYS < 0 ? params.normal_rays : NORMAL_RAYS;
}

int pattern_count()
{
    return SAMPLES < 0 ? params.samples : SAMPLES;
}

int attenuation_kind()
{
    return ATTENUATION < 0 ? params.attenuation : ATTENUATION;
}

int spacing_kind()
{
    return SPACING < 0 ? params.spacing : SPACING;
}

int layer_count()
{
    return LAYERS < 0 ? params.layers : LAYERS;
}

bool layers_are_solid()
{
    return (LAYERS_SOLID < 0 ? params.layers_solid : LAYERS_SOLID) != 0;
}

bool is_orthographic()
{
    return (ORTHOGRAPHIC < 0 ? params.orthographic : ORTHOGRAPHIC) != 0;
}

int noise_size()
{
    return NOISE_SIZE < 0 ? params.noise_size : NOISE_SIZE;
}

bool filter_uses_slope()
{
    return (FILTER_SLOPE < 0 ? params.filter_slope : FILTER_SLOPE) != 0;
}

int filter_pass()
{
    return FILTER_PASS < 0 ? push.pass : FILTER_PASS;
}

bool in_buffers(ivec2 at)
{
    /* Negative numbers are large ones without sign. */
    return all(lessThan(uvec2(at), uvec2(params.width, params.height)));
}

/*
 * Where the depth image has a texel of a layer. With DEPTH_EDGE n it holds n x n layers
 * for each layer, each of them every n-th texel of every n-th row: pixels at a distance
 * of n that march in step (pixel_of_invocation()) then read neighbouring texels.
 */
ivec3 depth_texel(ivec2 at, int layer)
{
    const uint edge = uint(DEPTH_EDGE);
    const uvec2 block = uvec2(at) / edge, phase = uvec2(at) % edge;
    return DEPTH_EDGE <= 1
               ? ivec3(at, layer)
               : ivec3(block, (uint(layer) * edge + phase.y) * edge + phase.x);
}

/* in_buffers(at) */
float depth_at(ivec2 at, int layer)
{
    return texelFetch(depth_image, depth_texel(at, layer), 0).r;
}

/* The method's map at a pixel; beyond the buffers the border's. */
float map_at(ivec2 at)
{
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width - 1, params.height - 1));
    return texelFetch(map_image, depth_texel(inside, 0), 0).r;
}

/* Neither background nor NaN. Bits are compared, since a compiler may take for granted
 * that there are no infinities. */
bool is_surface(float depth)
{
    return floatBitsToUint(depth) < 0x7f800000u;
}

bool is_nan(float value)
{
    return (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u;
}

/* The unit vector of two octahedral numbers: Cigolle et al., A Survey of Efficient
 * Representations for Independent Unit Vectors, JCGT 2014. */
vec3 octahedral_decoded(vec2 e)
{
    vec3 n = vec3(e, 1 - abs(e.x) - abs(e.y));
    const float under = max(-n.z, 0);
    n.x += n.x >= 0 ? -under : under;
    n.y += n.y >= 0 ? -under : under;
    return normalize(n);
}

vec2 octahedral_encoded(vec3 n)
{
    const float sum = abs(n.x) + abs(n.y) + abs(n.z);
    const vec2 e = n.xy / (sum > 0 ? sum : 1);
    if (n.z >= 0)
        return e;
    return vec2((1 - abs(e.y)) * (e.x >= 0 ? 1 : -1),
                (1 - abs(e.x)) * (e.y >= 0 ? 1 : -1));
}

/* View space, facing the camera. */
vec3 normal_at(ivec2 at)
{
    const vec4 stored = texelFetch(normal_image, at, 0);
    return NORMALS_OCTAHEDRAL != 0 ? octahedral_decoded(stored.xy) : stored.xyz;
}

int strided(uint group, uint size, uint local)
{
    const uint edge = uint(PIXEL_STRIDE), block = group / edge, phase = group % edge;
    return int((block * size + local) * edge + phase);
}

/*
 * The pixel of the buffers that this invocation writes. Interleaved evaluation (the 2008
 * papers' 4x4 noise tile, evaluated tile phase by tile phase): all invocations of a
 * workgroup take pixels of one place in the noise tile, so that they turn by the same
 * angle and march in step; neighbouring workgroups take the other places of the same
 * block of pixels, whose texels they share in the cache.
 */
ivec2 pixel_of_invocation()
{
    const ivec2 corner = ivec2(push.out_x, push.out_y);
    if (PIXEL_STRIDE <= 1)
        return corner + ivec2(gl_GlobalInvocationID.xy);
    return corner
           + ivec2(
               strided(gl_WorkGroupID.x, gl_WorkGroupSize.x, gl_LocalInvocationID.x),
               strided(gl_WorkGroupID.y, gl_WorkGroupSize.y, gl_LocalInvocationID.y));
}

bool in_output(ivec2 at)
{
    const ivec2 end = ivec2(push.out_x + push.out_width, push.out_y + push.out_height);
    return all(lessThan(at, end));
}

/* The pixel whose place in the noise tile stands for `at`. Where a workgroup has one
 * place only, one of the workgroup: then a compiler sees that all of it is alike. */
ivec2 noise_pixel(ivec2 at)
{
    if (PIXEL_STRIDE <= 1 || PIXEL_STRIDE % noise_size() != 0)
        return at;
    return ivec2(push.out_x, push.out_y) + ivec2(gl_WorkGroupID.xy) % PIXEL_STRIDE;
}

crv__noise_texel noise_at(ivec2 at)
{
    const ivec2 pixel = noise_pixel(at) + ivec2(params.noise_x, params.noise_y);
    const ivec2 place = pixel % noise_size();
    return noise_tile[place.y * noise_size() + place.x];
}

/* (cos, sin) of the k-th of the equally spaced directions. */
vec2 direction_of(int k)
{
    return direction_table[k];
}

void write_output(ivec2 at, vec4 value)
{
#ifdef OUTPUT_ARRAY
    imageStore(output_image, depth_texel(at, 0), value);
#else
    imageStore(output_image, at + ivec2(push.store_x, push.store_y), value);
#endif
}

void write_vectors(ivec2 at, vec4 value)
{
    imageStore(vector_output, at + ivec2(push.store_x, push.store_y), value);
}

#endif
