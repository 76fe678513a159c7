/* SPDX-License-Identifier: MIT */
#include "vulkan/slot.h"

#include "core/noise.h"

#include <string.h>

/* ---- numbers ---- */

/* Offsets of storage and uniform buffers: every device takes a multiple of this. */
enum { OFFSET_ALIGNMENT = 256 };

/* Where the numbers lie in their buffer, by binding. */
typedef struct numbers_layout {
    size_t offset[CRV__BIND_DEPTH], size[CRV__BIND_DEPTH], total;
} numbers_layout;

static numbers_layout layout_of(const crv__setup *setup)
{
    const size_t edge = (size_t)setup->options.noise_size;
    const size_t points = setup->pattern ? (size_t)setup->options.samples : 1;
    numbers_layout l = {
        .size = {[CRV__BIND_PARAMS] = sizeof(crv__params),
                 [CRV__BIND_NOISE] = edge * edge * sizeof(crv__noise_texel),
                 [CRV__BIND_DIRECTIONS] =
                     (size_t)setup->options.directions * 2 * sizeof(float),
                 /* Methods without points still have the binding. */
                 [CRV__BIND_PATTERN] = points * 4 * sizeof(float)}};
    for (int i = 0; i < CRV__BIND_DEPTH; i++) {
        l.offset[i] = l.total;
        l.total +=
            (l.size[i] + OFFSET_ALIGNMENT - 1) / OFFSET_ALIGNMENT * OFFSET_ALIGNMENT;
    }
    return l;
}

/* The angle that the noise turns by, at most. */
static double sector_of(const crv__setup *setup)
{
    const double turn = 6.28318530717958647692;
    return setup->method->pattern_fill ? turn : turn / setup->options.directions;
}

void crv__slot_fill(const crv__slot *s, const crv__setup *setup,
                    const crv__params *params, uint32_t noise_index)
{
    const numbers_layout l = layout_of(setup);
    char *bytes = s->numbers.block.mapped;
    memcpy(bytes + l.offset[CRV__BIND_PARAMS], params, sizeof *params);
    crv__noise_advance(setup->noise, setup->options.noise_size, sector_of(setup),
                       noise_index,
                       (crv__noise_texel *)(void *)(bytes + l.offset[CRV__BIND_NOISE]));
    memcpy(bytes + l.offset[CRV__BIND_DIRECTIONS], setup->directions,
           l.size[CRV__BIND_DIRECTIONS]);
    if (setup->pattern)
        memcpy(bytes + l.offset[CRV__BIND_PATTERN], setup->pattern,
               l.size[CRV__BIND_PATTERN]);
}

/* ---- descriptors ---- */

void crv__slot_bind_image(const crv__slot *s, VkDescriptorSet set, uint32_t binding,
                          VkImageView view, VkImageLayout layout)
{
    const crv__device *d = s->program->device;
    const VkDescriptorImageInfo image = {d->pipelines->sampler, view, layout};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = set,
                                        .dstBinding = binding,
                                        .descriptorCount = 1,
                                        .descriptorType = crv__binding_type(binding),
                                        .pImageInfo = &image};
    d->vk.UpdateDescriptorSets(d->device, 1, &write, 0, NULL);
}

/* What a step reads and writes: accessibility, and bent normals if they are computed; or
 * the sums of both. */
typedef struct pair {
    VkImageView accessibility, bent;
} pair;

/* Without bent normals, the same image twice: no shader writes to it as such. */
static pair pair_of(const crv__slot *s, int accessibility, int bent)
{
    const VkImageView first = s->scratch->image[accessibility].view,
                      second = s->scratch->image[bent].view;
    return (pair){first, second ? second : first};
}

/* Every binding gets something, since some drivers look at those that no shader reads. */
static void bind_all(crv__slot *s, const numbers_layout *l, VkDescriptorSet set,
                     pair input, pair output)
{
    const crv__device *d = s->program->device;
    VkDescriptorBufferInfo buffers[CRV__BIND_DEPTH];
    VkWriteDescriptorSet writes[CRV__BIND_DEPTH];
    for (uint32_t i = 0; i < CRV__BIND_DEPTH; i++) {
        buffers[i] =
            (VkDescriptorBufferInfo){s->numbers.buffer, l->offset[i], l->size[i]};
        writes[i] =
            (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set,
                                   .dstBinding = i,
                                   .descriptorCount = 1,
                                   .descriptorType = crv__binding_type(i),
                                   .pBufferInfo = &buffers[i]};
    }
    d->vk.UpdateDescriptorSets(d->device, CRV__BIND_DEPTH, writes, 0, NULL);
    const crv__image *image = s->scratch->image;
    const VkImageView normals = image[CRV__SCRATCH_NORMALS].view,
                      depth = image[CRV__SCRATCH_DEPTH].view,
                      map = image[CRV__SCRATCH_MAP].view;
    const VkImageView views[CRV__BINDINGS] = {
        [CRV__BIND_DEPTH] = depth,
        [CRV__BIND_NORMALS] = normals,
        [CRV__BIND_INPUT] = input.accessibility,
        [CRV__BIND_OUTPUT] = output.accessibility,
        [CRV__BIND_HOST_DEPTH] = normals,
        [CRV__BIND_VECTORS] = input.bent ? input.bent : normals,
        [CRV__BIND_VECTORS_OUTPUT] = output.bent ? output.bent : normals,
        [CRV__BIND_MAP] = map ? map : depth};
    for (uint32_t i = CRV__BIND_DEPTH; i < CRV__BINDINGS; i++)
        crv__slot_bind_image(s, set, i, views[i], VK_IMAGE_LAYOUT_GENERAL);
}

/* Depth as estimates read it. */
static VkImageView depth_of_estimate(const crv__slot *s)
{
    const crv__image *depth = &s->scratch->image[CRV__SCRATCH_DEPTH],
                     *other = &s->scratch->image[CRV__SCRATCH_DEINTERLEAVED];
    return other->image ? other->view : depth->all ? depth->all : depth->view;
}

/* The sets of an estimate: one, or two that hand sums to and fro and one that ends. */
static void bind_estimate(crv__slot *s, const numbers_layout *l, pair first, pair second)
{
    const int32_t parts = s->program->parts;
    const VkImageView depth = depth_of_estimate(s);
    const pair sums[2] = {pair_of(s, CRV__SCRATCH_SUMS, CRV__SCRATCH_BENT_SUMS),
                          pair_of(s, CRV__SCRATCH_SUMS + 1, CRV__SCRATCH_BENT_SUMS + 1)};
    bind_all(s, l, s->estimate_set, parts > 1 ? sums[parts % 2] : second, first);
    crv__slot_bind_image(s, s->estimate_set, CRV__BIND_DEPTH, depth,
                         VK_IMAGE_LAYOUT_GENERAL);
    for (int i = 0; parts > 1 && i < 2; i++) {
        bind_all(s, l, s->part_set[i], sums[1 - i], sums[i]);
        crv__slot_bind_image(s, s->part_set[i], CRV__BIND_DEPTH, depth,
                             VK_IMAGE_LAYOUT_GENERAL);
    }
}

static void bind_sets(crv__slot *s, const crv__setup *setup)
{
    const crv__image *image = s->scratch->image, *depth = &image[CRV__SCRATCH_DEPTH];
    const numbers_layout l = layout_of(setup);
    const pair first = pair_of(s, CRV__SCRATCH_ACCESSIBILITY, CRV__SCRATCH_BENT);
    const pair filtered = pair_of(s, CRV__SCRATCH_FILTERED, CRV__SCRATCH_BENT_FILTERED);
    const pair second = filtered.accessibility ? filtered : first;
    for (int32_t i = 0; i < depth->desc.layers; i++) {
        if (s->depth_set[i])
            bind_all(s, &l, s->depth_set[i], first,
                     (pair){depth->part[i][0], VK_NULL_HANDLE});
        for (int32_t m = 1; m < depth->desc.levels; m++)
            bind_all(s, &l, s->level_set[i][m], first,
                     (pair){depth->part[i][m], VK_NULL_HANDLE});
    }
    bind_estimate(s, &l, first, second);
    for (int32_t i = 0; i < s->program->passes; i++)
        bind_all(s, &l, s->filter_set[i], i % 2 ? second : first, i % 2 ? first : second);
    if (s->map_set) {
        bind_all(s, &l, s->map_set, first,
                 (pair){image[CRV__SCRATCH_MAP].view, VK_NULL_HANDLE});
        crv__slot_bind_image(s, s->map_set, CRV__BIND_DEPTH, depth_of_estimate(s),
                             VK_IMAGE_LAYOUT_GENERAL);
    }
    if (s->deinterleave_set)
        bind_all(s, &l, s->deinterleave_set, first,
                 (pair){image[CRV__SCRATCH_DEINTERLEAVED].view, VK_NULL_HANDLE});
}

enum {
    MOST_SETS = CRV_MAX_LAYERS * CRV__MOST_LEVELS + 5 + CRV__MOST_PASSES,
};

/* The sets that the program needs; their count. */
static uint32_t list_sets(crv__slot *s, VkDescriptorSet *sets[MOST_SETS])
{
    const crv__program *p = s->program;
    const crv__image_desc *depth = &s->scratch->image[CRV__SCRATCH_DEPTH].desc;
    uint32_t count = 0;
    sets[count++] = &s->estimate_set;
    for (int32_t i = 0; i < depth->layers; i++) {
        if (p->desc.converts)
            sets[count++] = &s->depth_set[i];
        for (int32_t m = 1; m < depth->levels; m++)
            sets[count++] = &s->level_set[i][m];
    }
    for (int32_t i = 0; i < p->passes; i++)
        sets[count++] = &s->filter_set[i];
    for (int32_t i = 0; p->parts > 1 && i < 2; i++)
        sets[count++] = &s->part_set[i];
    if (p->deinterleave.pipeline)
        sets[count++] = &s->deinterleave_set;
    if (p->map.pipeline)
        sets[count++] = &s->map_set;
    return count;
}

static VkResult create_sets(crv__slot *s)
{
    const crv__device *d = s->program->device;
    VkDescriptorSet *places[MOST_SETS], sets[MOST_SETS];
    VkDescriptorSetLayout layouts[MOST_SETS];
    const uint32_t count = list_sets(s, places);
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, count},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count * 3},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, count * 2},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count * 6}};
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = count,
        .poolSizeCount = sizeof sizes / sizeof sizes[0],
        .pPoolSizes = sizes};
    VkResult result =
        d->vk.CreateDescriptorPool(d->device, &pool, d->callbacks, &s->pool);
    if (result)
        return result;
    for (uint32_t i = 0; i < count; i++)
        layouts[i] = d->pipelines->set_layout;
    const VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = s->pool,
        .descriptorSetCount = count,
        .pSetLayouts = layouts};
    result = d->vk.AllocateDescriptorSets(d->device, &info, sets);
    for (uint32_t i = 0; result == VK_SUCCESS && i < count; i++)
        *places[i] = sets[i];
    return result;
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

crv_status crv__slot_create(crv__slot *s, const crv__program *program,
                            const crv__scratch *scratch, const crv__setup *setup,
                            bool timestamps)
{
    const crv__device *d = program->device;
    *s = (crv__slot){.program = program, .scratch = scratch};
    crv_status status = crv__buffer_create(
        &s->numbers, d, "numbers", layout_of(setup).total,
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    if (status == CRV_OK && timestamps)
        status = create_queries(s);
    if (status)
        return status;
    const VkResult result = create_sets(s);
    if (result)
        return crv__device_fail(d, result, "descriptors");
    bind_sets(s, setup);
    return CRV_OK;
}

void crv__slot_destroy(crv__slot *s)
{
    if (!s->program)
        return;
    const crv__device *d = s->program->device;
    d->vk.DestroyQueryPool(d->device, s->queries, d->callbacks);
    d->vk.DestroyDescriptorPool(d->device, s->pool, d->callbacks);
    crv__buffer_destroy(&s->numbers, d);
    *s = (crv__slot){0};
}

uint64_t crv__slot_bytes(const crv__slot *s)
{
    return s->numbers.size;
}

crv_status crv__slot_times(const crv__slot *s, crv_device_time *times, int32_t *count)
{
    const crv__device *d = s->program->device;
    uint64_t ticks[CRV__MOST_STEPS + 1];
    if (!s->queries)
        return CRV_ERROR_UNSUPPORTED;
    if (!s->step_count)
        return CRV_ERROR_NOT_READY;
    const VkResult result = d->vk.GetQueryPoolResults(
        d->device, s->queries, 0, (uint32_t)s->step_count + 1, sizeof ticks, ticks,
        sizeof *ticks, VK_QUERY_RESULT_64_BIT);
    if (result == VK_NOT_READY)
        return CRV_ERROR_NOT_READY;
    if (result)
        return crv__device_fail(d, result, "timestamps");
    for (int32_t i = 0; i < s->step_count; i++)
        times[i] = (crv_device_time){
            .name = s->steps[i],
            .time_ms = crv__device_seconds(d, ticks[i], ticks[i + 1]) * 1e3};
    *count = s->step_count;
    return CRV_OK;
}
