/* SPDX-License-Identifier: MIT */
/* A pass: the pipelines of one method and filter, the images between its steps, and what
 * each recording in flight needs. In a host's command buffer it is a crv_vulkan_pass;
 * with a command buffer of its own it is a plan. */
#ifndef CRV_VULKAN_PASS_H
#define CRV_VULKAN_PASS_H

#include "vulkan/record.h"

typedef struct crv__pass {
    const crv__device *device;
    crv_options options; /* for which it was created */
    crv__program program;
    crv__scratch scratch;
    crv__slot *slots;
    int32_t slot_count;
} crv__pass;

typedef struct crv__pass_desc {
    bool converts; /* the host's images are converted on the device */
    /* Normals as x, y, z and accessibility in 32 bits; else normals as two octahedral
     * numbers of 32 bits and accessibility in 16. */
    bool single;
    bool timestamps; /* if the device has them */
    int32_t slots;   /* recordings in flight */
    crv_vulkan_depth_layout depth_layout;
    int32_t level_px;
    crv_vulkan_half half_filters;
    bool bent;                /* bent normals, too */
    crv__bent_form bent_form; /* in which they are left */
} crv__pass_desc;

/* The setup has its patterns. Destroy also after an error. */
crv_status crv__pass_create(crv__pass *p, const crv__device *d, const crv__setup *setup,
                            const crv__pass_desc *desc);
void crv__pass_destroy(crv__pass *p, const crv_allocator *allocator);

/* Bytes of device memory. */
uint64_t crv__pass_bytes(const crv__pass *p);

/* The option that pipelines or memory have fixed to another value; NULL: there is none,
 * and the pass computes these options as well. */
const char *crv__pass_fixes(const crv__pass *p, const crv_options *options);

#endif
