/* SPDX-License-Identifier: MIT */
/* Barriers: what waits for what, and which writes it sees. */
#ifndef CRV_VULKAN_BARRIERS_H
#define CRV_VULKAN_BARRIERS_H

#include "vulkan/device.h"

typedef struct crv__access {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
} crv__access;

extern const crv__access CRV__WRITTEN, CRV__SAMPLED, CRV__COPIED_TO, CRV__COPIED_FROM,
    CRV__HOST_READS;

crv__access crv__access_both(crv__access a, crv__access b);

/* `to` waits for `from` and sees what it wrote. */
void crv__record_barrier(const crv__device *d, VkCommandBuffer commands, crv__access from,
                         crv__access to);

/* What was written is sampled next, and images that were sampled are written. */
void crv__record_between(const crv__device *d, VkCommandBuffer commands);

/* An image, or one level and layer of it, on its way from one layout to another. */
VkImageMemoryBarrier2 crv__image_barrier(VkImage image, VkImageLayout before,
                                         VkImageLayout after, crv__access from,
                                         crv__access to);
void crv__record_image_barriers(const crv__device *d, VkCommandBuffer commands,
                                const VkImageMemoryBarrier2 *barriers, uint32_t count);

#endif
