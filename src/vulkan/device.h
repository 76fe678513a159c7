/* SPDX-License-Identifier: MIT */
/* A Vulkan device: the host's, or one of Crevice's own. */
#ifndef CRV_VULKAN_DEVICE_H
#define CRV_VULKAN_DEVICE_H

#include "core/backend.h"
#include "vulkan/loader.h"

#include <stdbool.h>

#include "crevice/vulkan.h"

typedef struct crv__pipelines crv__pipelines;

typedef struct crv__device {
    crv__vk_table vk;
    void *loader; /* NULL: the host's */
    bool owned;   /* instance and device are destroyed with this */
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue; /* VK_NULL_HANDLE: the host gave none */
    uint32_t family, timestamp_bits;
    bool is_lavapipe;
    bool has_half; /* shaderFloat16 is there and on */
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties heaps;
    const VkAllocationCallbacks *callbacks;
    VkPipelineCache cache; /* the host's; VK_NULL_HANDLE: none */
    crv_vulkan_memory memory;
    crv_logger logger;
    crv_allocator allocator;
    crv__pipelines *pipelines;
    crv__debug_table debug;
    /* Of plans, crv_vulkan_context_set_plans(). */
    crv_vulkan_depth_layout plan_layout;
    crv_vulkan_half plan_half;
} crv__device;

extern const crv__backend crv__vulkan_backend;

/* Gives the context a device of Crevice's own by its number, and its backend. */
crv_status crv__vulkan_open(crv_context *context, int32_t index);

/* The context's device; NULL: it has none. */
crv__device *crv__device_of(const crv_context *context);

/* Logs `what` with the name of the result; its status. */
crv_status crv__device_fail(const crv__device *d, VkResult result, const char *what);

/* Names an object for debuggers, if the host has VK_EXT_debug_utils. */
void crv__device_name(const crv__device *d, VkObjectType type, uint64_t handle,
                      const char *name);

/* From one timestamp to a later one. */
double crv__device_seconds(const crv__device *d, uint64_t from, uint64_t to);

/* NULL does nothing. */
void crv__device_destroy(crv__device *d);

#endif
