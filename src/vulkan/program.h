/* SPDX-License-Identifier: MIT */
/* The pipelines of one method and filter. */
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
    int32_t pixel_stride;     /* pixels from one invocation to the next */
} crv__pipeline;

/* What a program does beside estimate and filter. */
typedef struct crv__program_desc {
    bool octahedral; /* normals are two numbers */
    bool converts;   /* the host's images are converted on the device */
    int32_t edge;    /* of the phases by which depth is deinterleaved, px; 1: it is not */
    bool half;       /* filters compute in half floats if the device can */
    int32_t level_px; /* distance from which coarser levels of depth are read; 0: never */
    bool bent;        /* bent normals are computed, too */
    crv__bent_form bent_form; /* of the last step */
} crv__program_desc;

typedef struct crv__program {
    const crv__device *device;
    /* Only if the host's images are converted: the first layer with the normals, the
     * other layers. */
    crv__pipeline convert, depth;
    crv__pipeline deinterleave, prefilter; /* only if the desc says so */
    crv__pipeline map;                     /* only if the setup has one */
    crv__pipeline estimate, filter[CRV__MOST_PASSES];
    crv__program_desc desc;
    int32_t parts;       /* dispatches of the estimate */
    int32_t part_size;   /* directions or points in each */
    int32_t part_rounds; /* of loops for a pixel in each, at most */
    /* Of loops, between which a plan waits for the device: a small part of a second. */
    int64_t submission_rounds;
    int32_t passes; /* of the filter */
} crv__program;

/* UNSUPPORTED with a line if the device cannot compute it. */
crv_status crv__setup_check(const crv__device *d, const crv__setup *setup);

/* The edge of the phases by which depth can be deinterleaved, px; 1: it cannot be. All
 * pixels of a workgroup then have one place in the noise tile. */
int32_t crv__deinterleave_edge(const crv__device *d, const crv__setup *setup);

/* Whether the filter of these options computes in half floats. */
bool crv__program_uses_half(const crv__program *p, const crv_options *options);

/* Destroy also after an error. */
crv_status crv__program_create(crv__program *p, const crv__device *device,
                               const crv__setup *setup, const crv__program_desc *desc);
void crv__program_destroy(crv__program *p);

#endif
