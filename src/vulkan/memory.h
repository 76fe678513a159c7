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

/* Host-visible, mapped and coherent. */
crv_status crv__buffer_create(crv__buffer *b, const crv__device *d, VkDeviceSize size,
                              VkBufferUsageFlags usage);
void crv__buffer_destroy(crv__buffer *b, const crv__device *d);

typedef struct crv__image {
    VkImage image;
    VkImageView view;                  /* of all layers */
    VkImageView layer[CRV_MAX_LAYERS]; /* of one each, where it is an array */
    crv_vulkan_block block;
    VkDeviceSize size;
    int32_t layers;
} crv__image;

/* Storage, sampled and transfer usage. layers 0: a plain image; else an array. */
crv_status crv__image_create(crv__image *i, const crv__device *d, VkFormat format,
                             int32_t width, int32_t height, int32_t layers);
void crv__image_destroy(crv__image *i, const crv__device *d);

#endif
