/* SPDX-License-Identifier: MIT */
/* What one frame in flight has to itself: images, the numbers of the frame, descriptors;
 * and how its passes are recorded. */
#ifndef CRV_VULKAN_SLOT_H
#define CRV_VULKAN_SLOT_H

#include "vulkan/program.h"

/* Steps that are timed: the levels of depth count as one. */
enum { CRV__MOST_STEPS = CRV_MAX_LAYERS + 4 + CRV__MOST_PASSES };

typedef struct crv__slot {
    const crv__program *program;
    crv__rectangle rectangle; /* of the accessibility images */
    crv__buffer params;
    crv__image depth, normals, accessibility[2];
    crv__image apart;   /* depth taken apart, where the program says so */
    crv__image sums[2]; /* of the estimate's parts, where there are several */
    VkDescriptorPool pool;
    /* Converts, the first layer with the normals; the estimate, into accessibility[0];
     * filter passes, to and fro. */
    VkDescriptorSet depth_set[CRV_MAX_LAYERS], estimate_set, filter_set[CRV__MOST_PASSES],
        apart_set, part_set[2], level_set[CRV_MAX_LAYERS][CRV__MOST_LEVELS];
    VkQueryPool queries; /* VK_NULL_HANDLE: none */
    int32_t query_count;
} crv__slot;

typedef struct crv__slot_desc {
    VkFormat normal_format, accessibility_format;
    int timestamps;
} crv__slot_desc;

crv_status crv__slot_create(crv__slot *s, const crv__program *program,
                            const crv__setup *setup, const crv__slot_desc *desc);
void crv__slot_destroy(crv__slot *s);

/* Bytes of device memory. */
uint64_t crv__slot_bytes(const crv__slot *s);

/* ---- descriptors ---- */

void crv__bind_image(const crv__program *p, VkDescriptorSet set, uint32_t binding,
                     VkImageView view, VkImageLayout layout);

/* ---- recording ---- */

/* Makes what `from` wrote visible to `to`, and waits for it. */
typedef struct crv__access {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
} crv__access;
extern const crv__access CRV__EARLIER, CRV__WRITTEN, CRV__SAMPLED, CRV__COPIED_TO,
    CRV__COPIED_FROM, CRV__HOST_READS;
void crv__record_barrier(const crv__device *d, VkCommandBuffer commands, crv__access from,
                         crv__access to);

/* Takes an image from `before` to `after`, everything in between waiting. */
void crv__record_layout(const crv__device *d, VkCommandBuffer commands, VkImage image,
                        VkImageLayout before, VkImageLayout after, crv__access from,
                        crv__access to);

/* Takes the slot's own images to GENERAL, whatever they held, after all earlier commands.
 */
void crv__slot_record_begin(crv__slot *s, VkCommandBuffer commands);

void crv__slot_record_step(crv__slot *s, VkCommandBuffer commands,
                           const crv__pipeline *pipeline, VkDescriptorSet set,
                           const crv__push *push);

/* What the next dispatch writes. */
void crv__push_out(crv__push *push, crv__rectangle r);

/* What was written is read next, and images that were read are written. */
void crv__record_between(const crv__device *d, VkCommandBuffer commands);

/* Other layouts of depth, where the program has any: each a step with its time. None
 * waits for another. */
void crv__slot_record_layouts(crv__slot *s, VkCommandBuffer commands, crv__push *push);

/* The estimate, in as many dispatches as the program says; fills the push's part. */
void crv__slot_record_estimate(crv__slot *s, VkCommandBuffer commands, crv__push *push);

/* Milliseconds of the steps whose times were noted since the beginning; NOT_READY, not
 * logged, while they are executed. */
crv_status crv__slot_times(const crv__slot *s, double times_ms[CRV__MOST_STEPS]);

/* Notes the time at which all before is done. */
void crv__slot_record_time(crv__slot *s, VkCommandBuffer commands);

#endif
