/* SPDX-License-Identifier: MIT */
#include "vulkan/barriers.h"

const crv__access CRV__WRITTEN = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                  VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
const crv__access CRV__SAMPLED = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                  VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
const crv__access CRV__COPIED_TO = {VK_PIPELINE_STAGE_2_COPY_BIT,
                                    VK_ACCESS_2_TRANSFER_WRITE_BIT};
const crv__access CRV__COPIED_FROM = {VK_PIPELINE_STAGE_2_COPY_BIT,
                                      VK_ACCESS_2_TRANSFER_READ_BIT};
const crv__access CRV__HOST_READS = {VK_PIPELINE_STAGE_2_HOST_BIT,
                                     VK_ACCESS_2_HOST_READ_BIT};

crv__access crv__access_both(crv__access a, crv__access b)
{
    return (crv__access){a.stages | b.stages, a.access | b.access};
}

void crv__record_barrier(const crv__device *d, VkCommandBuffer commands, crv__access from,
                         crv__access to)
{
    const VkMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                      .srcStageMask = from.stages,
                                      .srcAccessMask = from.access,
                                      .dstStageMask = to.stages,
                                      .dstAccessMask = to.access};
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .memoryBarrierCount = 1,
                                   .pMemoryBarriers = &barrier};
    d->vk.CmdPipelineBarrier2(commands, &info);
}

void crv__record_between(const crv__device *d, VkCommandBuffer commands)
{
    crv__record_barrier(d, commands, CRV__WRITTEN,
                        crv__access_both(CRV__SAMPLED, CRV__WRITTEN));
}

VkImageMemoryBarrier2 crv__image_barrier(VkImage image, VkImageLayout before,
                                         VkImageLayout after, crv__access from,
                                         crv__access to)
{
    return (VkImageMemoryBarrier2){.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                   .srcStageMask = from.stages,
                                   .srcAccessMask = from.access,
                                   .dstStageMask = to.stages,
                                   .dstAccessMask = to.access,
                                   .oldLayout = before,
                                   .newLayout = after,
                                   .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                   .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                   .image = image,
                                   .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0,
                                                        VK_REMAINING_MIP_LEVELS, 0,
                                                        VK_REMAINING_ARRAY_LAYERS}};
}

void crv__record_image_barriers(const crv__device *d, VkCommandBuffer commands,
                                const VkImageMemoryBarrier2 *barriers, uint32_t count)
{
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .imageMemoryBarrierCount = count,
                                   .pImageMemoryBarriers = barriers};
    d->vk.CmdPipelineBarrier2(commands, &info);
}
