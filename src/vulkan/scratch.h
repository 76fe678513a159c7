/* SPDX-License-Identifier: MIT */
/* The images between the steps of a recording. All recordings of a pass share them: each
 * waits for the one before. */
#ifndef CRV_VULKAN_SCRATCH_H
#define CRV_VULKAN_SCRATCH_H

#include "vulkan/program.h"

enum {
    CRV__SCRATCH_DEPTH, /* an array of layers, planar, with coarser levels if read */
    CRV__SCRATCH_NORMALS,
    CRV__SCRATCH_ACCESSIBILITY, /* the estimate */
    CRV__SCRATCH_FILTERED,      /* only if there is a filter */
    CRV__SCRATCH_DEINTERLEAVED, /* depth, only if the program reads it so */
    CRV__SCRATCH_MAP,           /* only if the setup has one; lies as depth does */
    CRV__SCRATCH_SUMS, /* of an estimate's parts, two, only if there are several */
    CRV__SCRATCH_BENT = CRV__SCRATCH_SUMS + 2, /* bent normals, if they are computed */
    CRV__SCRATCH_BENT_FILTERED,                /* as the filtered accessibility */
    CRV__SCRATCH_BENT_SUMS,                    /* two, what SUMS have no room for */
    CRV__SCRATCH_IMAGES = CRV__SCRATCH_BENT_SUMS + 2
};

typedef struct crv__scratch {
    const crv__device *device;
    crv__image image[CRV__SCRATCH_IMAGES]; /* those that are not there have no .image */
} crv__scratch;

typedef struct crv__scratch_desc {
    VkFormat normal_format, accessibility_format, bent_format;
} crv__scratch_desc;

/* For frames up to the setup's size. Destroy also after an error. */
crv_status crv__scratch_create(crv__scratch *s, const crv__program *program,
                               const crv__setup *setup, const crv__scratch_desc *desc);
void crv__scratch_destroy(crv__scratch *s);

/* Bytes of device memory. */
uint64_t crv__scratch_bytes(const crv__scratch *s);

#endif
