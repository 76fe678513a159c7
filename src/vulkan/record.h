/* SPDX-License-Identifier: MIT */
/* The one recorder: what a pass and a plan do with a frame. */
#ifndef CRV_VULKAN_RECORD_H
#define CRV_VULKAN_RECORD_H

#include "vulkan/barriers.h"
#include "vulkan/slot.h"

/* Depth layers, normals, accessibility and bent normals in a buffer, on their way to the
 * device and back. */
typedef struct crv__staging {
    crv__buffer buffer;
    /* Where they lie, bytes; depth is first. */
    size_t normals, accessibility, bent, size;
} crv__staging;

/* A frame to be recorded. Depth and normals come from the host's images, or from a
 * staging buffer, to which accessibility then goes back. */
typedef struct crv__job {
    const crv__setup *setup;       /* of this frame's size */
    const crv_vulkan_frame *frame; /* NULL: staging */
    const crv__staging *staging;   /* NULL: frame */
    bool has_normals;              /* of the frame */
    bool filter_only;              /* of staging: its accessibility is the estimate */
    bool with_bent;                /* of staging: bent normals are copied back, too */
    /* Of staging: submits what is recorded, waits, and begins again, when `done` of
     * `total` pieces of the estimate are recorded. What fails ends the recording. */
    crv_status (*submit)(const void *user, int32_t done, int32_t total);
    const void *user;
    crv__push push; /* encodings of the frame */
} crv__job;

/* Records the job with the numbers that crv__slot_fill() left in the slot. With a frame
 * it never fails. */
crv_status crv__record(crv__slot *slot, VkCommandBuffer commands, const crv__job *job);

#endif
