/* SPDX-License-Identifier: MIT */
/* One command buffer that is recorded, submitted and waited for, again and again. */
#ifndef CRV_VULKAN_COMMANDS_H
#define CRV_VULKAN_COMMANDS_H

#include "vulkan/device.h"

typedef struct crv__commands {
    VkCommandPool pool;
    VkCommandBuffer buffer;
    VkFence fence;
} crv__commands;

/* INVALID_ARGUMENT with a line if the host gave no queue, which `what` needs. Destroy
 * also after an error. */
crv_status crv__commands_create(crv__commands *c, const crv__device *d, const char *what);
void crv__commands_destroy(crv__commands *c, const crv__device *d);

/* Drops what was recorded. */
crv_status crv__commands_begin(crv__commands *c, const crv__device *d);

/* Ends, submits, and waits until all is done. */
crv_status crv__commands_run(crv__commands *c, const crv__device *d);

#endif
