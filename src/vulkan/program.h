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
    int32_t group; /* edge of a workgroup, px */
} crv__pipeline;

typedef struct crv__program {
    const crv__device *device;
    crv__pipeline depth, normals; /* only where the host's images are converted */
    crv__pipeline estimate, filter[CRV__MOST_PASSES];
    int32_t passes;                                /* of the filter */
    crv__buffer constants;                         /* noise, directions, pattern */
    VkDescriptorBufferInfo table[CRV__BIND_DEPTH]; /* where they are, by binding */
} crv__program;

/* UNSUPPORTED with a line where the device cannot compute it. */
crv_status crv__setup_check(const crv__device *d, const crv__setup *setup);

/* The setup has its patterns. Where it fails, crv__program_destroy() takes back the rest.
 */
crv_status crv__program_create(crv__program *p, const crv__device *device,
                               const crv__setup *setup, int converts);
void crv__program_destroy(crv__program *p);

#endif
