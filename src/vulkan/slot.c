/* SPDX-License-Identifier: MIT */
#include "vulkan/slot.h"

#include <string.h>

/* ---- descriptors ---- */

void crv__bind_image(const crv__program *p, VkDescriptorSet set, uint32_t binding,
                     VkImageView view, VkImageLayout layout)
{
    const crv__device *d = p->device;
    const VkDescriptorImageInfo image = {d->pipelines->sampler, view, layout};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = set,
                                        .dstBinding = binding,
                                        .descriptorCount = 1,
                                        .descriptorType = crv__binding_type(binding),
                                        .pImageInfo = &image};
    d->vk.UpdateDescriptorSets(d->device, 1, &write, 0, NULL);
}

/* Every binding gets something, since some drivers look at those that no shader reads. */
static void bind_all(crv__slot *s, VkDescriptorSet set, VkImageView input,
                     VkImageView output)
{
    const crv__device *d = s->program->device;
    VkDescriptorBufferInfo buffers[CRV__BIND_DEPTH];
    VkWriteDescriptorSet writes[CRV__BIND_DEPTH];
    memcpy(buffers, s->program->table, sizeof buffers);
    buffers[CRV__BIND_PARAMS] =
        (VkDescriptorBufferInfo){s->params.buffer, 0, sizeof(crv__params)};
    for (uint32_t i = 0; i < CRV__BIND_DEPTH; i++)
        writes[i] =
            (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set,
                                   .dstBinding = i,
                                   .descriptorCount = 1,
                                   .descriptorType = crv__binding_type(i),
                                   .pBufferInfo = &buffers[i]};
    d->vk.UpdateDescriptorSets(d->device, CRV__BIND_DEPTH, writes, 0, NULL);
    const VkImageView views[CRV__BINDINGS] = {[CRV__BIND_DEPTH] = s->depth.view,
                                              [CRV__BIND_NORMALS] = s->normals.view,
                                              [CRV__BIND_INPUT] = input,
                                              [CRV__BIND_OUTPUT] = output,
                                              [CRV__BIND_HOST_DEPTH] = s->normals.view,
                                              [CRV__BIND_HOST_NORMALS] = s->normals.view,
                                              [CRV__BIND_NORMALS_OUTPUT] =
                                                  s->normals.view};
    for (uint32_t i = CRV__BIND_DEPTH; i < CRV__BINDINGS; i++)
        crv__bind_image(s->program, set, i, views[i], VK_IMAGE_LAYOUT_GENERAL);
}

enum {
    PARTS_FROM = CRV_MAX_LAYERS + 2 + CRV__MOST_PASSES,
    LEVELS_FROM = PARTS_FROM + 2,
    SETS = LEVELS_FROM + CRV_MAX_LAYERS * CRV__MOST_LEVELS
};

static VkResult create_sets(crv__slot *s)
{
    const crv__device *d = s->program->device;
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, SETS},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, SETS * 3},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, SETS * 2},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, SETS * 5}};
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = SETS,
        .poolSizeCount = 4,
        .pPoolSizes = sizes};
    VkResult result =
        d->vk.CreateDescriptorPool(d->device, &pool, d->callbacks, &s->pool);
    if (result)
        return result;
    VkDescriptorSet sets[SETS];
    VkDescriptorSetLayout layouts[SETS];
    for (int i = 0; i < SETS; i++)
        layouts[i] = d->pipelines->set_layout;
    const VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = s->pool,
        .descriptorSetCount = SETS,
        .pSetLayouts = layouts};
    result = d->vk.AllocateDescriptorSets(d->device, &info, sets);
    if (result)
        return result;
    memcpy(s->depth_set, sets, sizeof s->depth_set);
    s->estimate_set = sets[CRV_MAX_LAYERS];
    s->apart_set = sets[CRV_MAX_LAYERS + 1];
    memcpy(s->filter_set, sets + CRV_MAX_LAYERS + 2, sizeof s->filter_set);
    memcpy(s->part_set, sets + PARTS_FROM, sizeof s->part_set);
    memcpy(s->level_set, sets + LEVELS_FROM, sizeof s->level_set);
    return VK_SUCCESS;
}

/* The sets of an estimate: one, or two that hand sums to and fro and one that ends. */
static void bind_estimate(crv__slot *s, VkImageView accessibility, VkImageView unused)
{
    const int32_t parts = s->program->parts;
    const VkImageView depth = s->apart.image ? s->apart.view
                              : s->depth.all ? s->depth.all
                                             : s->depth.view;
    const VkImageView sums[2] = {s->sums[0].view, s->sums[1].view};
    bind_all(s, s->estimate_set, parts > 1 ? sums[parts % 2] : unused, accessibility);
    crv__bind_image(s->program, s->estimate_set, CRV__BIND_DEPTH, depth,
                    VK_IMAGE_LAYOUT_GENERAL);
    for (int i = 0; parts > 1 && i < 2; i++) {
        bind_all(s, s->part_set[i], sums[1 - i], sums[i]);
        crv__bind_image(s->program, s->part_set[i], CRV__BIND_DEPTH, depth,
                        VK_IMAGE_LAYOUT_GENERAL);
    }
}

static void bind_sets(crv__slot *s)
{
    const VkImageView first = s->accessibility[0].view;
    const VkImageView second =
        s->accessibility[1].view ? s->accessibility[1].view : first;
    for (int32_t i = 0; i < s->depth.desc.layers; i++) {
        bind_all(s, s->depth_set[i], first, s->depth.part[i][0]);
        for (int32_t m = 1; m < s->depth.desc.levels; m++)
            bind_all(s, s->level_set[i][m], first, s->depth.part[i][m]);
    }
    bind_estimate(s, first, second);
    bind_all(s, s->filter_set[0], first, second);
    bind_all(s, s->filter_set[1], second, first);
    if (s->apart.image)
        bind_all(s, s->apart_set, first, s->apart.view);
}

/* ---- life ---- */

static crv_status create_queries(crv__slot *s)
{
    const crv__device *d = s->program->device;
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = CRV__MOST_STEPS + 1};
    const VkResult result =
        d->vk.CreateQueryPool(d->device, &info, d->callbacks, &s->queries);
    return result ? crv__device_fail(d, result, "timestamps") : CRV_OK;
}

/* Down to a few texels, or one level where coarser ones are not read. */
static int32_t level_count(const crv__program *p, const crv_gbuffer_desc *g)
{
    int32_t levels = 1;
    while (p->desc.level_px > 0 && levels < CRV__MOST_LEVELS && g->width >> levels > 4
           && g->height >> levels > 4)
        levels++;
    return levels;
}

static crv_status create_images(crv__slot *s, const crv__setup *setup,
                                const crv__slot_desc *desc)
{
    const crv__program *p = s->program;
    const crv_gbuffer_desc *g = &setup->desc;
    const int32_t edge = p->desc.edge;
    const crv__image_desc depth = {VK_FORMAT_R32_SFLOAT, g->width, g->height, g->layers,
                                   level_count(p, g)},
                          normals = {desc->normal_format, g->width, g->height, 0, 1},
                          accessibility = {desc->accessibility_format, s->rectangle.width,
                                           s->rectangle.height, 0, 1},
                          apart = {VK_FORMAT_R32_SFLOAT, (g->width + edge - 1) / edge,
                                   (g->height + edge - 1) / edge, g->layers * edge * edge,
                                   1},
                          sums = {VK_FORMAT_R32G32_SFLOAT, s->rectangle.width,
                                  s->rectangle.height, 0, 1};
    crv_status status = crv__image_create(&s->depth, p->device, &depth);
    if (status == CRV_OK)
        status = crv__image_create(&s->normals, p->device, &normals);
    for (int i = 0; status == CRV_OK && i < (p->passes ? 2 : 1); i++)
        status = crv__image_create(&s->accessibility[i], p->device, &accessibility);
    if (status == CRV_OK && edge > 1)
        status = crv__image_create(&s->apart, p->device, &apart);
    for (int i = 0; status == CRV_OK && i < (p->parts > 1 ? 2 : 0); i++)
        status = crv__image_create(&s->sums[i], p->device, &sums);
    return status;
}

crv_status crv__slot_create(crv__slot *s, const crv__program *program,
                            const crv__setup *setup, const crv__slot_desc *desc)
{
    *s = (crv__slot){.program = program, .rectangle = crv__setup_rectangle(setup)};
    crv_status status =
        crv__buffer_create(&s->params, program->device, sizeof(crv__params),
                           VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    if (status == CRV_OK)
        status = create_images(s, setup, desc);
    if (status == CRV_OK && desc->timestamps)
        status = create_queries(s);
    if (status)
        return status;
    const VkResult result = create_sets(s);
    if (result)
        return crv__device_fail(program->device, result, "descriptors");
    bind_sets(s);
    return CRV_OK;
}

void crv__slot_destroy(crv__slot *s)
{
    if (!s->program)
        return;
    const crv__device *d = s->program->device;
    d->vk.DestroyQueryPool(d->device, s->queries, d->callbacks);
    d->vk.DestroyDescriptorPool(d->device, s->pool, d->callbacks);
    crv__image_destroy(&s->sums[1], d);
    crv__image_destroy(&s->sums[0], d);
    crv__image_destroy(&s->apart, d);
    crv__image_destroy(&s->accessibility[1], d);
    crv__image_destroy(&s->accessibility[0], d);
    crv__image_destroy(&s->normals, d);
    crv__image_destroy(&s->depth, d);
    crv__buffer_destroy(&s->params, d);
    *s = (crv__slot){0};
}

uint64_t crv__slot_bytes(const crv__slot *s)
{
    return s->params.size + s->depth.size + s->normals.size + s->accessibility[0].size
           + s->accessibility[1].size + s->apart.size + s->sums[0].size + s->sums[1].size;
}
