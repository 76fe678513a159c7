/* SPDX-License-Identifier: MIT */
#include "vulkan/commands.h"

crv_status crv__commands_create(crv__commands *c, const crv__device *d, const char *what)
{
    if (!d->queue)
        return crv__fail(&d->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "vulkan: %s need a queue; set host.queue", what);
    const VkCommandPoolCreateInfo pool = {.sType =
                                              VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                          .queueFamilyIndex = d->family};
    VkResult result = d->vk.CreateCommandPool(d->device, &pool, d->callbacks, &c->pool);
    if (result)
        return crv__device_fail(d, result, "command pool");
    const VkCommandBufferAllocateInfo buffer = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = c->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1};
    result = d->vk.AllocateCommandBuffers(d->device, &buffer, &c->buffer);
    if (result)
        return crv__device_fail(d, result, "command buffer");
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    result = d->vk.CreateFence(d->device, &fence, d->callbacks, &c->fence);
    return result ? crv__device_fail(d, result, "fence") : CRV_OK;
}

void crv__commands_destroy(crv__commands *c, const crv__device *d)
{
    d->vk.DestroyFence(d->device, c->fence, d->callbacks);
    d->vk.DestroyCommandPool(d->device, c->pool, d->callbacks);
}

crv_status crv__commands_begin(crv__commands *c, const crv__device *d)
{
    const VkCommandBufferBeginInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VkResult result = d->vk.ResetCommandPool(d->device, c->pool, 0);
    if (result == VK_SUCCESS)
        result = d->vk.BeginCommandBuffer(c->buffer, &info);
    return result ? crv__device_fail(d, result, "commands") : CRV_OK;
}

crv_status crv__commands_run(crv__commands *c, const crv__device *d)
{
    VkResult result = d->vk.EndCommandBuffer(c->buffer);
    if (result)
        return crv__device_fail(d, result, "commands");
    const VkCommandBufferSubmitInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
        .commandBuffer = c->buffer};
    const VkSubmitInfo2 submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                                  .commandBufferInfoCount = 1,
                                  .pCommandBufferInfos = &commands};
    result = d->vk.QueueSubmit2(d->queue, 1, &submit, c->fence);
    if (result)
        return crv__device_fail(d, result, "submit");
    result = d->vk.WaitForFences(d->device, 1, &c->fence, VK_TRUE, UINT64_MAX);
    if (result == VK_SUCCESS)
        result = d->vk.ResetFences(d->device, 1, &c->fence);
    return result ? crv__device_fail(d, result, "run") : CRV_OK;
}
