/* SPDX-License-Identifier: MIT */
/* The pipelines of one method and filter, and the constant buffer that they share. */
#ifndef CRV_VULKAN_PROGRAM_H
#define CRV_VULKAN_PROGRAM_H

#include "shared/push.h"
#include "vulkan/memory.h"
#include "vulkan/pipelines.h"

enum { CRV__MOST_PASSES = 2 }; /* of a filter */

typedef struct crv__pipeline {
    VkPipeline pipeline;
    int32_t group;            /* edge of a workgroup, invocations */
    int32_t lanes_x, lanes_y; /* pixels of an invocation */
    int32_t interleave;       /* pixels from one invocation to the next */
} crv__pipeline;

/* What a program does beside estimate and filter. */
typedef struct crv__program_desc {
    int converts;     /* 0 or 1: the host's images are converted on the device */
    int32_t edge;     /* depth is taken apart by so many px; 1: it is not */
    int half;         /* 0 or 1: filters compute in half floats where the device can */
    int32_t level_px; /* from where coarser levels of depth are read; 0: never */
} crv__program_desc;

typedef struct crv__program {
    const crv__device *device;
    /* Only where the host's images are converted: the first layer with the normals, the
     * other layers. */
    crv__pipeline convert, depth;
    crv__pipeline deinterleave, prefilter; /* only where the desc says so */
    crv__pipeline estimate, filter[CRV__MOST_PASSES];
    crv__program_desc desc;
    /* The estimate takes so many dispatches of so many directions or points. */
    int32_t parts, part_size;
    int32_t passes;                                /* of the filter */
    crv__buffer constants;                         /* noise, directions, pattern */
    VkDescriptorBufferInfo table[CRV__BIND_DEPTH]; /* where they are, by binding */
} crv__program;

/* UNSUPPORTED with a line where the device cannot compute it. */
crv_status crv__setup_check(const crv__device *d, const crv__setup *setup);

/* By how many px depth is taken apart for this setup; 1: it cannot be. A workgroup then
 * has one place of the noise tile. */
int32_t crv__apart_edge(const crv__device *d, const crv__setup *setup);

/* The setup has its patterns. Where it fails, crv__program_destroy() takes back the rest.
 */
crv_status crv__program_create(crv__program *p, const crv__device *device,
                               const crv__setup *setup, const crv__program_desc *desc);
void crv__program_destroy(crv__program *p);

#endif
