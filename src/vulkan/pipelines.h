/* SPDX-License-Identifier: MIT */
/*
 * The pipelines of a device. Compiling takes longer than all else that a plan does, and a
 * new size needs the same pipelines: unused ones are kept for a while.
 */
#ifndef CRV_VULKAN_PIPELINES_H
#define CRV_VULKAN_PIPELINES_H

#include "vulkan/device.h"

/* The bindings of set 0 (shaders/common.glsl). */
enum {
    CRV__BIND_PARAMS,
    CRV__BIND_NOISE,
    CRV__BIND_DIRECTIONS,
    CRV__BIND_PATTERN,
    CRV__BIND_DEPTH,
    CRV__BIND_NORMALS,
    CRV__BIND_INPUT,
    CRV__BIND_OUTPUT,
    CRV__BIND_HOST_DEPTH,
    CRV__BIND_VECTORS, /* the host's normals; bent normals, or their sums */
    CRV__BIND_VECTORS_OUTPUT,
    CRV__BIND_MAP,
    CRV__BINDINGS
};

/* How a step leaves bent normals (shaders/bent.glsl). */
typedef enum crv__bent_form {
    CRV__BENT_AS_SUMMED, /* of any length: for further steps, and for plans */
    CRV__BENT_UNIT,
    CRV__BENT_OCTAHEDRAL
} crv__bent_form;

/* Specialisation constants, by id (shaders/common.glsl). */
enum {
    CRV__SPEC_SIZE_X,
    CRV__SPEC_SIZE_Y,
    CRV__SPEC_FALLOFF,
    CRV__SPEC_DIRECTIONS,
    CRV__SPEC_STEPS,
    CRV__SPEC_NORMAL_RAYS,
    CRV__SPEC_SAMPLES,
    CRV__SPEC_ATTENUATION,
    CRV__SPEC_LAYERS,
    CRV__SPEC_ORTHOGRAPHIC,
    CRV__SPEC_NOISE_SIZE,
    CRV__SPEC_FILTER_SLOPE,
    CRV__SPEC_LAYERS_SOLID,
    CRV__SPEC_PIXEL_STRIDE,
    CRV__SPEC_SPACING,
    CRV__SPEC_NORMALS_OCTAHEDRAL,
    CRV__SPEC_DEPTH_EDGE,
    CRV__SPEC_BIASED,
    CRV__SPEC_FILTER_PASS,
    CRV__SPEC_LOD_PX,
    CRV__SPEC_IN_PARTS,
    CRV__SPEC_BENT_NORMAL,
    CRV__SPEC_BENT_FORM,
    CRV__SPECS
};

enum { CRV__KEPT_PIPELINES = 64 };

typedef struct crv__kept_pipeline {
    VkPipeline pipeline;
    int32_t shader; /* in crv__shaders */
    int32_t specs[CRV__SPECS];
    int32_t users;
    uint64_t last_use;
} crv__kept_pipeline;

struct crv__pipelines {
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    crv__kept_pipeline kept[CRV__KEPT_PIPELINES];
    uint64_t clock;
};

/* Sets d->pipelines. Close also after an error. */
crv_status crv__pipelines_open(crv__device *d);
void crv__pipelines_close(crv__device *d);

/* Fixes nothing but the workgroup's edge: shaders read the rest from buffers. */
void crv__specs_clear(int32_t specs[CRV__SPECS], int32_t group);

VkDescriptorType crv__binding_type(uint32_t binding);

/* The pipeline of a shader with these constants; to be given back. */
crv_status crv__pipeline_take(const crv__device *d, const char *shader,
                              const int32_t specs[CRV__SPECS], VkPipeline *out);
/* VK_NULL_HANDLE does nothing. */
void crv__pipeline_give(const crv__device *d, VkPipeline pipeline);

#endif
