/* SPDX-License-Identifier: MIT */
/* How fast the device fetches depth by each path in each pattern (shaders/fetch.comp), by
 * its own clock: what chooses the path that the methods take. */
#include "shared/params.h"
#include "shared/push.h"
#include "vulkan/commands.h"
#include "vulkan/memory.h"
#include "vulkan/pipelines.h"
#include "vulkan/slot.h"

/* 16 MiB of depth in each layout; what is looked at from is the first part of it. */
enum { EDGE = 2048, APART = 4, WRITTEN = 1024, GROUP = 8, A_PIXEL = 64, REPEATS = 4 };
enum { BYTES = EDGE * EDGE * 4, MOST_DISPATCHES = 64 };

typedef struct fetching {
    crv__commands commands;
    crv__buffer staging, rows, small; /* small: in place of tables that nobody reads */
    crv__image plain, apart;
    VkDescriptorPool pool;
    VkDescriptorSet sets[2]; /* of plain, of apart */
    crv__stopwatch watch;
} fetching;

/* ---- what is fetched ---- */

/* Depths that no compression makes smaller than those of a picture: between 1 and 2. */
static void fill(float *depth)
{
    uint32_t bits = 1;
    for (int i = 0; i < EDGE * EDGE; i++) {
        bits = bits * 1664525u + 1013904223u; /* Numerical Recipes */
        depth[i] = 1 + (float)(bits >> 9) * 0x1p-23f;
    }
}

static crv_status create_memory(fetching *f, const crv__device *d)
{
    const crv__image_desc plain = {VK_FORMAT_R32_SFLOAT, EDGE, EDGE, 1, 1},
                          apart = {VK_FORMAT_R32_SFLOAT, EDGE / APART, EDGE / APART,
                                   APART * APART, 1};
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                             target = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    crv_status status = crv__stopwatch_create(&f->watch, d);
    if (status == CRV_OK)
        status = crv__commands_create(&f->commands, d, "measurements");
    if (status == CRV_OK)
        status =
            crv__buffer_create(&f->staging, d, BYTES, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    if (status == CRV_OK)
        status = crv__buffer_create_local(&f->rows, d, BYTES, storage | target);
    if (status == CRV_OK)
        status = crv__buffer_create(&f->small, d, sizeof(crv__params),
                                    storage | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    if (status == CRV_OK)
        status = crv__image_create(&f->plain, d, &plain);
    if (status == CRV_OK)
        status = crv__image_create(&f->apart, d, &apart);
    return status;
}

static VkBufferImageCopy whole(const crv__image *image)
{
    const crv__image_desc *i = &image->desc;
    return (VkBufferImageCopy){
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, (uint32_t)i->layers},
        .imageExtent = {(uint32_t)i->width, (uint32_t)i->height, 1}};
}

/* The same numbers into both images, and from one of them into the rows. */
static crv_status upload(fetching *f, const crv__device *d)
{
    const crv__access copied = {CRV__COPIED_TO.stages,
                                CRV__COPIED_TO.access | CRV__COPIED_FROM.access};
    const crv__access fetched = {CRV__SAMPLED.stages,
                                 CRV__SAMPLED.access | VK_ACCESS_2_SHADER_STORAGE_READ_BIT
                                     | CRV__WRITTEN.access};
    const crv__image *images[] = {&f->plain, &f->apart};
    fill(f->staging.block.mapped);
    const crv_status status = crv__commands_begin(&f->commands, d);
    if (status)
        return status;
    const VkCommandBuffer commands = f->commands.buffer;
    for (int i = 0; i < 2; i++) {
        const VkBufferImageCopy copy = whole(images[i]);
        crv__record_layout(d, commands, images[i]->image, VK_IMAGE_LAYOUT_UNDEFINED,
                           VK_IMAGE_LAYOUT_GENERAL, CRV__EARLIER, CRV__COPIED_TO);
        d->vk.CmdCopyBufferToImage(commands, f->staging.buffer, images[i]->image,
                                   VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    }
    crv__record_barrier(d, commands, CRV__COPIED_TO, copied);
    const VkBufferImageCopy copy = whole(&f->plain);
    d->vk.CmdCopyImageToBuffer(commands, f->plain.image, VK_IMAGE_LAYOUT_GENERAL,
                               f->rows.buffer, 1, &copy);
    crv__record_barrier(d, commands, copied, fetched);
    return crv__commands_run(&f->commands, d);
}

/* ---- descriptors ---- */

static void bind(const fetching *f, const crv__device *d, const crv__image *image,
                 VkDescriptorSet set)
{
    const VkDescriptorBufferInfo rows = {f->rows.buffer, 0, BYTES},
                                 small = {f->small.buffer, 0, sizeof(crv__params)};
    /* The bindings that no shader reads here get a plain view, for drivers that look. */
    const VkDescriptorImageInfo all = {d->pipelines->sampler, image->view,
                                       VK_IMAGE_LAYOUT_GENERAL},
                                one = {d->pipelines->sampler, f->plain.part[0][0],
                                       VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet writes[CRV__BINDINGS];
    for (uint32_t i = 0; i < CRV__BINDINGS; i++) {
        const int is_read = i == CRV__BIND_DEPTH || i == CRV__BIND_OUTPUT;
        writes[i] =
            (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set,
                                   .dstBinding = i,
                                   .descriptorCount = 1,
                                   .descriptorType = crv__binding_type(i),
                                   .pBufferInfo = i == CRV__BIND_PATTERN ? &rows : &small,
                                   .pImageInfo = is_read ? &all : &one};
    }
    d->vk.UpdateDescriptorSets(d->device, CRV__BINDINGS, writes, 0, NULL);
}

static VkResult create_sets(fetching *f, const crv__device *d)
{
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 6},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 10}};
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 2,
        .poolSizeCount = sizeof sizes / sizeof sizes[0],
        .pPoolSizes = sizes};
    VkResult result =
        d->vk.CreateDescriptorPool(d->device, &pool, d->callbacks, &f->pool);
    if (result)
        return result;
    const VkDescriptorSetLayout layouts[] = {d->pipelines->set_layout,
                                             d->pipelines->set_layout};
    const VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = f->pool,
        .descriptorSetCount = 2,
        .pSetLayouts = layouts};
    result = d->vk.AllocateDescriptorSets(d->device, &info, f->sets);
    if (result)
        return result;
    bind(f, d, &f->plain, f->sets[0]);
    bind(f, d, &f->apart, f->sets[1]);
    return VK_SUCCESS;
}

static void destroy(fetching *f, const crv__device *d)
{
    d->vk.DestroyDescriptorPool(d->device, f->pool, d->callbacks);
    crv__image_destroy(&f->apart, d);
    crv__image_destroy(&f->plain, d);
    crv__buffer_destroy(&f->small, d);
    crv__buffer_destroy(&f->rows, d);
    crv__buffer_destroy(&f->staging, d);
    crv__commands_destroy(&f->commands, d);
    crv__stopwatch_destroy(&f->watch, d);
}

/* ---- a measurement ---- */

static void record(const fetching *f, const crv__device *d, VkPipeline pipeline, int set,
                   int dispatches)
{
    const VkCommandBuffer commands = f->commands.buffer;
    const crv__push push = {.out_width = WRITTEN, .out_height = WRITTEN};
    d->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    d->vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                                d->pipelines->layout, 0, 1, &f->sets[set], 0, NULL);
    d->vk.CmdPushConstants(commands, d->pipelines->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           sizeof push, &push);
    crv__stopwatch_start(&f->watch, d, commands);
    for (int i = 0; i < dispatches; i++) {
        d->vk.CmdDispatch(commands, WRITTEN / GROUP, WRITTEN / GROUP, 1);
        crv__record_between(d, commands);
    }
    crv__stopwatch_stop(&f->watch, d, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

static crv_status run(fetching *f, const crv__device *d, VkPipeline pipeline, int set,
                      int dispatches, double *seconds)
{
    crv_status status = crv__commands_begin(&f->commands, d);
    if (status)
        return status;
    record(f, d, pipeline, set, dispatches);
    status = crv__commands_run(&f->commands, d);
    if (status == CRV_OK)
        status = crv__stopwatch_read(&f->watch, d, seconds);
    *seconds /= dispatches;
    return status;
}

/* The first run says how many make up some milliseconds. */
static crv_status measure(fetching *f, const crv__device *d, int path, int pattern,
                          double *per_s)
{
    const int is_apart = pattern == CRV_FETCH_IN_STEP;
    const double wanted_s = 5e-3;
    int32_t specs[CRV__SPECS];
    VkPipeline pipeline = VK_NULL_HANDLE;
    crv__specs_clear(specs, GROUP);
    specs[CRV__SPEC_INTERLEAVE] = specs[CRV__SPEC_DEPTH_EDGE] = is_apart ? APART : 1;
    specs[CRV__SPEC_FETCH_PATH] = path;
    specs[CRV__SPEC_FETCH_PATTERN] = pattern;
    crv_status status = crv__pipeline_take(d, "fetch", specs, &pipeline);
    double best_s = 0;
    int dispatches = 1;
    for (int i = 0; i < REPEATS && status == CRV_OK; i++) {
        double seconds = 0;
        status = run(f, d, pipeline, is_apart, dispatches, &seconds);
        if (status == CRV_OK && seconds > 0 && (best_s <= 0 || seconds < best_s))
            best_s = seconds;
        const double count = best_s > 0 ? wanted_s / best_s : MOST_DISPATCHES;
        dispatches = count < 1                 ? 1
                     : count > MOST_DISPATCHES ? MOST_DISPATCHES
                                               : (int)count;
    }
    crv__pipeline_give(d, pipeline);
    *per_s = best_s > 0 ? (double)WRITTEN * WRITTEN * A_PIXEL / best_s : 0;
    return status;
}

crv_status crv__device_fetches(crv_context *context,
                               double per_s[CRV_FETCH_PATHS][CRV_FETCH_PATTERNS])
{
    const crv__device *d = crv__device_of(context);
    fetching f = {0};
    crv_status status = create_memory(&f, d);
    if (status == CRV_OK) {
        const VkResult result = create_sets(&f, d);
        status = result ? crv__device_fail(d, result, "descriptors") : upload(&f, d);
    }
    for (int path = 0; path < CRV_FETCH_PATHS; path++) {
        for (int pattern = 0; pattern < CRV_FETCH_PATTERNS; pattern++) {
            const int is_there = path != CRV_FETCH_SHARED || pattern <= CRV_FETCH_NEAR;
            per_s[path][pattern] = 0;
            if (status == CRV_OK && is_there)
                status = measure(&f, d, path, pattern, &per_s[path][pattern]);
        }
    }
    destroy(&f, d);
    return status;
}
