/* SPDX-License-Identifier: MIT */
#include "vulkan/memory.h"

/* The first memory type of `bits` that has all of `needed`; UINT32_MAX: none. */
static uint32_t memory_type(const crv__device *d, uint32_t bits,
                            VkMemoryPropertyFlags needed)
{
    for (uint32_t i = 0; i < d->heaps.memoryTypeCount; i++) {
        if ((bits >> i & 1) && (d->heaps.memoryTypes[i].propertyFlags & needed) == needed)
            return i;
    }
    return UINT32_MAX;
}

static void release(const crv__device *d, crv_vulkan_block *block)
{
    if (!block->memory)
        return;
    if (d->memory.release)
        d->memory.release(d->memory.user, block);
    else
        d->vk.FreeMemory(d->device, block->memory, d->callbacks);
    *block = (crv_vulkan_block){0};
}

static VkResult allocate(const crv__device *d, const VkMemoryRequirements *requirements,
                         VkMemoryPropertyFlags needed, crv_vulkan_block *out)
{
    if (d->memory.allocate)
        return d->memory.allocate(d->memory.user, requirements, needed, out);
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = requirements->size,
        .memoryTypeIndex = memory_type(d, requirements->memoryTypeBits, needed)};
    if (info.memoryTypeIndex == UINT32_MAX)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    VkResult result = d->vk.AllocateMemory(d->device, &info, d->callbacks, &out->memory);
    if (result == VK_SUCCESS && (needed & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)) {
        result =
            d->vk.MapMemory(d->device, out->memory, 0, VK_WHOLE_SIZE, 0, &out->mapped);
        if (result)
            release(d, out);
    }
    return result;
}

crv_status crv__buffer_create(crv__buffer *b, const crv__device *d, const char *name,
                              VkDeviceSize size, VkBufferUsageFlags usage)
{
    const VkMemoryPropertyFlags needed =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    VkResult result = d->vk.CreateBuffer(d->device, &info, d->callbacks, &b->buffer);
    if (result)
        return crv__device_fail(d, result, "buffer");
    crv__device_name(d, VK_OBJECT_TYPE_BUFFER, (uint64_t)b->buffer, name);
    VkMemoryRequirements requirements;
    d->vk.GetBufferMemoryRequirements(d->device, b->buffer, &requirements);
    b->size = requirements.size;
    result = allocate(d, &requirements, needed, &b->block);
    if (result == VK_SUCCESS)
        result = d->vk.BindBufferMemory(d->device, b->buffer, b->block.memory,
                                        b->block.offset);
    return result ? crv__device_fail(d, result, "memory of a buffer") : CRV_OK;
}

void crv__buffer_destroy(crv__buffer *b, const crv__device *d)
{
    d->vk.DestroyBuffer(d->device, b->buffer, d->callbacks);
    release(d, &b->block);
    *b = (crv__buffer){0};
}

static VkResult create_view(const crv__device *d, const crv__image *i,
                            VkImageViewType type, VkImageSubresourceRange range,
                            VkImageView *out)
{
    const VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = i->image,
                                        .viewType = type,
                                        .format = i->desc.format,
                                        .subresourceRange = range};
    const VkResult result = d->vk.CreateImageView(d->device, &info, d->callbacks, out);
    if (result == VK_SUCCESS)
        crv__device_name(d, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)*out, i->desc.name);
    return result;
}

static VkResult create_views(const crv__device *d, crv__image *i)
{
    const int32_t layers = i->desc.layers;
    const VkImageViewType type =
        layers ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    VkImageSubresourceRange range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0,
                                     VK_REMAINING_ARRAY_LAYERS};
    VkResult result = create_view(d, i, type, range, &i->view);
    range.levelCount = VK_REMAINING_MIP_LEVELS;
    if (result == VK_SUCCESS && i->desc.levels > 1)
        result = create_view(d, i, type, range, &i->all);
    for (int32_t k = 0; layers <= CRV_MAX_LAYERS && k < layers; k++) {
        for (int32_t m = 0; result == VK_SUCCESS && m < i->desc.levels; m++)
            result =
                create_view(d, i, VK_IMAGE_VIEW_TYPE_2D,
                            (VkImageSubresourceRange){VK_IMAGE_ASPECT_COLOR_BIT,
                                                      (uint32_t)m, 1, (uint32_t)k, 1},
                            &i->part[k][m]);
    }
    return result;
}

crv_status crv__image_create(crv__image *i, const crv__device *d,
                             const crv__image_desc *desc)
{
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = desc->format,
        .extent = {(uint32_t)desc->width, (uint32_t)desc->height, 1},
        .mipLevels = (uint32_t)desc->levels,
        .arrayLayers = desc->layers ? (uint32_t)desc->layers : 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT
                 | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    i->desc = *desc;
    VkResult result = d->vk.CreateImage(d->device, &info, d->callbacks, &i->image);
    if (result)
        return crv__device_fail(d, result, "image");
    crv__device_name(d, VK_OBJECT_TYPE_IMAGE, (uint64_t)i->image, desc->name);
    VkMemoryRequirements requirements;
    d->vk.GetImageMemoryRequirements(d->device, i->image, &requirements);
    i->size = requirements.size;
    result = allocate(d, &requirements, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, &i->block);
    if (result == VK_SUCCESS)
        result =
            d->vk.BindImageMemory(d->device, i->image, i->block.memory, i->block.offset);
    if (result == VK_SUCCESS)
        result = create_views(d, i);
    return result ? crv__device_fail(d, result, "memory of an image") : CRV_OK;
}

void crv__image_destroy(crv__image *i, const crv__device *d)
{
    for (int32_t k = 0; k < CRV_MAX_LAYERS * CRV__MOST_LEVELS; k++)
        d->vk.DestroyImageView(
            d->device, i->part[k / CRV__MOST_LEVELS][k % CRV__MOST_LEVELS], d->callbacks);
    d->vk.DestroyImageView(d->device, i->all, d->callbacks);
    d->vk.DestroyImageView(d->device, i->view, d->callbacks);
    d->vk.DestroyImage(d->device, i->image, d->callbacks);
    release(d, &i->block);
    *i = (crv__image){0};
}
