/* SPDX-License-Identifier: MIT */
/* Buffers and images with their memory. */
#ifndef CRV_VULKAN_MEMORY_H
#define CRV_VULKAN_MEMORY_H

#include "vulkan/device.h"

typedef struct crv__buffer {
    VkBuffer buffer;
    crv_vulkan_block block; /* .mapped: its bytes */
    VkDeviceSize size;      /* of the memory */
} crv__buffer;

/* Host-visible, mapped and coherent. name: for debuggers. */
crv_status crv__buffer_create(crv__buffer *b, const crv__device *d, const char *name,
                              VkDeviceSize size, VkBufferUsageFlags usage);
void crv__buffer_destroy(crv__buffer *b, const crv__device *d);

enum { CRV__MOST_LEVELS = 6 };

typedef struct crv__image_desc {
    const char *name; /* for debuggers */
    VkFormat format;
    int32_t width, height;
    int32_t layers; /* 0: a plain image; else an array */
    int32_t levels; /* 1 to CRV__MOST_LEVELS */
} crv__image_desc;

typedef struct crv__image {
    crv__image_desc desc;
    VkImage image;
    VkImageView view; /* of all layers, level 0 */
    VkImageView all;  /* of all layers and levels; VK_NULL_HANDLE: there is one level */
    /* Of one each, of arrays of up to CRV_MAX_LAYERS. */
    VkImageView part[CRV_MAX_LAYERS][CRV__MOST_LEVELS];
    crv_vulkan_block block;
    VkDeviceSize size;
} crv__image;

/* Storage, sampled and transfer usage. */
crv_status crv__image_create(crv__image *i, const crv__device *d,
                             const crv__image_desc *desc);
void crv__image_destroy(crv__image *i, const crv__device *d);

#endif
