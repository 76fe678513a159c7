/* SPDX-License-Identifier: MIT */
#include "vulkan_engine.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <setjmp.h>

#include <cmocka.h>

engine the_engine;

int engine_tests_begin(void)
{
    if (engine_open(&the_engine, 1) == 0)
        return 0;
    printf("SKIPPED: no Vulkan 1.3 device, or no validation layer\n");
    return getenv("CI") ? 1 : 77;
}

int engine_tests_setup(void **state)
{
    *state = &the_engine;
    return 0;
}

int engine_tests_end(int failed)
{
    engine_close(&the_engine); /* the layer tells of every object that is left */
    return failed || the_engine.h.complaints;
}

void the_validation_layer_is_silent(void **state)
{
    const engine *g = *state;
    assert_int_equal(g->h.complaints, 0);
}

int engine_open(engine *e, int validate)
{
    *e = (engine){0};
    if (host_open(&e->h, validate) != 0)
        return -1;
    for (int i = 0; i < ENGINE_COMMANDS; i++)
        e->frames[i] = host_frame_make(&e->h);
    return 0;
}

void engine_close(engine *e)
{
    for (int i = 0; i < ENGINE_COMMANDS; i++)
        host_frame_free(&e->h, &e->frames[i]);
    host_close(&e->h);
}

crv_vulkan_host engine_host(const engine *e)
{
    crv_vulkan_host device;
    crv_vulkan_host_init(&device, sizeof device);
    device.get_instance_proc_addr = vkGetInstanceProcAddr;
    device.instance = e->h.instance;
    device.physical_device = e->h.physical;
    device.device = e->h.device;
    device.queue_family = e->h.family;
    device.queue = e->h.queue;
    device.has_synchronization2 = VK_TRUE;
    device.has_storage_image_write_without_format = VK_TRUE;
    device.has_shader_float16 = e->h.has_float16;
    return device;
}

VkCommandBuffer engine_begin(engine *e, int which)
{
    host_frame_begin(&e->h, &e->frames[which]);
    return e->frames[which].commands;
}

void engine_submit(engine *e, int which)
{
    host_frame_submit(&e->h, &e->frames[which]);
}

void engine_wait(engine *e)
{
    host_check(vkDeviceWaitIdle(e->h.device), "wait");
}

static int is_depth(VkFormat format)
{
    return format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT;
}

/* A barrier has to name all aspects of an image. */
static VkImageAspectFlags aspects_of(VkFormat format)
{
    if (is_depth(format) && format >= VK_FORMAT_D16_UNORM_S8_UINT)
        return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    return is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

static VkBufferImageCopy whole(VkImageAspectFlags aspect, int width, int height)
{
    return (VkBufferImageCopy){.imageSubresource = {aspect, 0, 0, 1},
                               .imageExtent = {(uint32_t)width, (uint32_t)height, 1}};
}

host_image engine_upload(engine *e, VkFormat format, int width, int height,
                         const void *bytes, size_t size)
{
    const host_use nothing = {VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED};
    const host_use written = {VK_PIPELINE_STAGE_2_COPY_BIT,
                              VK_ACCESS_2_TRANSFER_WRITE_BIT,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    const host_use sampled = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const VkBufferImageCopy copy =
        whole(is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT,
              width, height);
    const VkImageUsageFlags drawn =
        is_depth(format) ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : 0;
    host_image image = host_image_make(&e->h, format, width, height,
                                       VK_IMAGE_USAGE_SAMPLED_BIT
                                           | VK_IMAGE_USAGE_TRANSFER_DST_BIT | drawn);
    host_buffer buffer = host_buffer_make(&e->h, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    memcpy(buffer.bytes, bytes, size);
    const VkCommandBuffer commands = engine_begin(e, 0);
    host_barrier(commands, image.image, aspects_of(format), nothing, written);
    vkCmdCopyBufferToImage(commands, buffer.buffer, image.image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    host_barrier(commands, image.image, aspects_of(format), written, sampled);
    engine_submit(e, 0);
    engine_wait(e);
    host_buffer_free(&e->h, &buffer);
    return image;
}

host_image engine_result(engine *e, VkFormat format, int width, int height)
{
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(e->h.physical, format, &properties);
    const VkImageUsageFlags drawn =
        properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT
            ? VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT
            : 0;
    return host_image_make(&e->h, format, width, height,
                           VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT
                               | VK_IMAGE_USAGE_TRANSFER_SRC_BIT
                               | VK_IMAGE_USAGE_TRANSFER_DST_BIT | drawn);
}

void *engine_download(engine *e, const host_image *image, int width, int height,
                      size_t size)
{
    return engine_download_layer(e, image, 0, width, height, size);
}

void *engine_download_layer(engine *e, const host_image *image, int layer, int width,
                            int height, size_t size)
{
    host_buffer buffer = host_buffer_make(&e->h, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = engine_begin(e, 0);
    host_readback(commands, image->image, layer, width, height, &buffer);
    engine_submit(e, 0);
    engine_wait(e);
    void *bytes = malloc(size);
    if (bytes)
        memcpy(bytes, buffer.bytes, size);
    host_buffer_free(&e->h, &buffer);
    return bytes;
}

host_image engine_filled(engine *e, VkFormat format, int width, int height, float value)
{
    const host_use nothing = {VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED};
    const host_use cleared = {VK_PIPELINE_STAGE_2_CLEAR_BIT,
                              VK_ACCESS_2_TRANSFER_WRITE_BIT,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    const host_use read = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkClearColorValue colour = {.float32 = {value, value, value, value}};
    const VkImageSubresourceRange range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    const host_image image = engine_result(e, format, width, height);
    const VkCommandBuffer commands = engine_begin(e, 0);
    host_barrier(commands, image.image, VK_IMAGE_ASPECT_COLOR_BIT, nothing, cleared);
    vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         &colour, 1, &range);
    host_barrier(commands, image.image, VK_IMAGE_ASPECT_COLOR_BIT, cleared, read);
    engine_submit(e, 0);
    engine_wait(e);
    return image;
}

engine_array engine_array_make(engine *e, VkFormat format, int width, int height)
{
    engine_array a = {.image = host_image_make_layers(
                          &e->h, format, width, height, 2,
                          VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT)};
    for (uint32_t i = 0; i < 2; i++) {
        const VkImageViewCreateInfo view = {
            .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
            .image = a.image.image,
            .viewType = VK_IMAGE_VIEW_TYPE_2D,
            .format = format,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, i, 1}};
        host_check(vkCreateImageView(e->h.device, &view, NULL, &a.layer[i]), "view");
    }
    return a;
}

void engine_array_free(engine *e, engine_array *a)
{
    for (int i = 0; i < 2; i++)
        vkDestroyImageView(e->h.device, a->layer[i], NULL);
    host_image_free(&e->h, &a->image);
}
