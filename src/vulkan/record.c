/* SPDX-License-Identifier: MIT */
/* Commands: barriers and dispatches. */
#include "vulkan/slot.h"

const crv__access CRV__EARLIER = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                  VK_ACCESS_2_MEMORY_WRITE_BIT};
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

static VkImageMemoryBarrier2 image_barrier(VkImage image, VkImageLayout before,
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

void crv__record_layout(const crv__device *d, VkCommandBuffer commands, VkImage image,
                        VkImageLayout before, VkImageLayout after, crv__access from,
                        crv__access to)
{
    const VkImageMemoryBarrier2 barrier = image_barrier(image, before, after, from, to);
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .imageMemoryBarrierCount = 1,
                                   .pImageMemoryBarriers = &barrier};
    d->vk.CmdPipelineBarrier2(commands, &info);
}

void crv__slot_record_begin(crv__slot *s, VkCommandBuffer commands)
{
    const crv__device *d = s->program->device;
    const crv__access earlier = CRV__EARLIER;
    const crv__access writes = {
        VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
        VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT
            | VK_ACCESS_2_TRANSFER_WRITE_BIT};
    const VkImage images[] = {s->depth.image,
                              s->normals.image,
                              s->accessibility[0].image,
                              s->accessibility[1].image,
                              s->apart.image,
                              s->sums[0].image,
                              s->sums[1].image};
    enum { IMAGES = sizeof images / sizeof images[0] };
    VkImageMemoryBarrier2 barriers[IMAGES];
    uint32_t count = 0;
    for (int i = 0; i < IMAGES; i++) {
        if (images[i])
            barriers[count++] = image_barrier(images[i], VK_IMAGE_LAYOUT_UNDEFINED,
                                              VK_IMAGE_LAYOUT_GENERAL, earlier, writes);
    }
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .imageMemoryBarrierCount = count,
                                   .pImageMemoryBarriers = barriers};
    d->vk.CmdPipelineBarrier2(commands, &info);
    s->query_count = 0;
    if (!s->queries)
        return;
    d->vk.CmdResetQueryPool(commands, s->queries, 0, CRV__MOST_STEPS + 1);
    d->vk.CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, s->queries,
                             (uint32_t)s->query_count++);
}

void crv__slot_record_step(crv__slot *s, VkCommandBuffer commands,
                           const crv__pipeline *pipeline, VkDescriptorSet set,
                           const crv__push *push)
{
    const crv__program *p = s->program;
    const crv__device *d = p->device;
    const int32_t step = pipeline->interleave, tile = pipeline->group * step;
    const int32_t tile_x = tile * pipeline->lanes_x, tile_y = tile * pipeline->lanes_y;
    d->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline->pipeline);
    d->vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                                d->pipelines->layout, 0, 1, &set, 0, NULL);
    d->vk.CmdPushConstants(commands, d->pipelines->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           sizeof *push, push);
    d->vk.CmdDispatch(commands,
                      (uint32_t)((push->out_width + tile_x - 1) / tile_x * step),
                      (uint32_t)((push->out_height + tile_y - 1) / tile_y * step), 1);
}

void crv__push_out(crv__push *push, crv__rectangle r)
{
    push->out_x = r.x;
    push->out_y = r.y;
    push->out_width = r.width;
    push->out_height = r.height;
}

void crv__record_between(const crv__device *d, VkCommandBuffer commands)
{
    crv__record_barrier(
        d, commands, CRV__WRITTEN,
        (crv__access){CRV__SAMPLED.stages, CRV__SAMPLED.access | CRV__WRITTEN.access});
}

void crv__slot_record_layouts(crv__slot *s, VkCommandBuffer commands, crv__push *push)
{
    const crv__program *p = s->program;
    const crv__image_desc *depth = &s->depth.desc;
    if (p->deinterleave.pipeline) {
        crv__push_out(push, (crv__rectangle){0, 0, depth->width, depth->height});
        crv__slot_record_step(s, commands, &p->deinterleave, s->apart_set, push);
        crv__slot_record_time(s, commands);
    }
    if (!p->prefilter.pipeline)
        return;
    for (push->layer = 0; push->layer < depth->layers; push->layer++) {
        for (push->pass = 1; push->pass < depth->levels; push->pass++) {
            crv__push_out(push, (crv__rectangle){0, 0, depth->width >> push->pass,
                                                 depth->height >> push->pass});
            crv__slot_record_step(s, commands, &p->prefilter,
                                  s->level_set[push->layer][push->pass], push);
        }
    }
    push->layer = push->pass = 0;
    crv__slot_record_time(s, commands);
}

void crv__slot_record_estimate(crv__slot *s, VkCommandBuffer commands, crv__push *push)
{
    const crv__program *p = s->program;
    for (int32_t i = 0; i < p->parts; i++) {
        push->part_begin = i * p->part_size;
        push->part_end = push->part_begin + p->part_size;
        push->is_last_part = i + 1 == p->parts;
        if (i > 0)
            crv__record_between(p->device, commands);
        crv__slot_record_step(s, commands, &p->estimate,
                              push->is_last_part ? s->estimate_set : s->part_set[i % 2],
                              push);
    }
}

void crv__slot_record_time(crv__slot *s, VkCommandBuffer commands)
{
    if (s->queries)
        s->program->device->vk.CmdWriteTimestamp2(commands,
                                                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                                  s->queries, (uint32_t)s->query_count++);
}

crv_status crv__slot_times(const crv__slot *s, double times_ms[CRV__MOST_STEPS])
{
    const crv__device *d = s->program->device;
    uint64_t ticks[CRV__MOST_STEPS + 1];
    const VkResult result = d->vk.GetQueryPoolResults(
        d->device, s->queries, 0, (uint32_t)s->query_count, sizeof ticks, ticks,
        sizeof *ticks, VK_QUERY_RESULT_64_BIT);
    if (result == VK_NOT_READY)
        return CRV_ERROR_NOT_READY;
    if (result)
        return crv__device_fail(d, result, "timestamps");
    for (int32_t i = 0; i + 1 < s->query_count; i++)
        times_ms[i] = crv__device_seconds(d, ticks[i], ticks[i + 1]) * 1e3;
    return CRV_OK;
}
