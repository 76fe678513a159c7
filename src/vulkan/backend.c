/* SPDX-License-Identifier: MIT */
/* Plans on a device: what the CPU has converted is copied there, computed and copied
 * back. */
#include "vulkan/commands.h"
#include "vulkan/slot.h"

#include <string.h>

typedef struct plan_state {
    crv__program program;
    crv__slot slot;
    crv__buffer staging; /* depth layers, normals; accessibility in and out */
    crv__commands commands;
    int filter_only; /* what was run last */
} plan_state;

/* Where things lie in the staging buffer. */
typedef struct staging_layout {
    size_t normals, accessibility, size;
} staging_layout;

static staging_layout layout_of(const crv__setup *setup)
{
    const crv__rectangle r = crv__setup_rectangle(setup);
    const size_t pixels = (size_t)setup->desc.width * (size_t)setup->desc.height;
    staging_layout layout;
    layout.normals = pixels * (size_t)setup->desc.layers * sizeof(float);
    layout.normals = (layout.normals + 15) / 16 * 16; /* of the size of a texel */
    layout.accessibility = layout.normals + pixels * 4 * sizeof(float);
    layout.size =
        layout.accessibility + (size_t)r.width * (size_t)r.height * sizeof(float);
    return layout;
}

static void plan_destroy(const crv__setup *setup, void *data)
{
    plan_state *state = data;
    const crv__device *d = crv__device_of(setup->context);
    crv__commands_destroy(&state->commands, d);
    crv__buffer_destroy(&state->staging, d);
    crv__slot_destroy(&state->slot);
    crv__program_destroy(&state->program);
    crv__release(&setup->context->allocator, state, 1, sizeof *state);
}

static crv_status plan_create(const crv__setup *setup, const crv__plane *rectangle,
                              void **out)
{
    enum { LEVEL_PX = 16 };
    const crv_depth_layout depth = setup->context->depth_layout;
    const crv__program_desc program = {
        .edge = depth == CRV_DEPTH_APART
                    ? crv__apart_edge(crv__device_of(setup->context), setup)
                    : 1,
        .half = setup->context->half_filters,
        .level_px = depth == CRV_DEPTH_LEVELS ? LEVEL_PX : 0};
    const crv__device *d = crv__device_of(setup->context);
    const crv__slot_desc slot = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32_SFLOAT,
                                 d->timestamp_bits > 0};
    (void)rectangle; /* the setup's own */
    crv_status status = crv__setup_check(d, setup);
    if (status)
        return status;
    plan_state *state = crv__allocate(&setup->context->allocator, 1, sizeof *state);
    if (!state)
        return crv__fail(&d->logger, CRV_ERROR_OUT_OF_MEMORY, "plan: out of memory");
    status = crv__program_create(&state->program, d, setup, &program);
    if (status == CRV_OK)
        status = crv__slot_create(&state->slot, &state->program, setup, &slot);
    if (status == CRV_OK)
        status = crv__buffer_create(&state->staging, d, layout_of(setup).size,
                                    VK_BUFFER_USAGE_TRANSFER_SRC_BIT
                                        | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    if (status == CRV_OK)
        status = crv__commands_create(&state->commands, d, "plans");
    if (status)
        plan_destroy(setup, state);
    else
        *out = state;
    return status;
}

/* ---- a run ---- */

static void pack_plane(const crv__plane *plane, float *out)
{
    for (int32_t y = 0; y < plane->height; y++)
        memcpy(out + (size_t)y * (size_t)plane->width,
               crv__plane_at(plane, plane->x0, plane->y0 + y),
               (size_t)plane->width * sizeof *out);
}

static void unpack_plane(const float *in, const crv__plane *plane)
{
    for (int32_t y = 0; y < plane->height; y++)
        memcpy(crv__plane_at(plane, plane->x0, plane->y0 + y),
               in + (size_t)y * (size_t)plane->width, (size_t)plane->width * sizeof *in);
}

static void pack_normals(const crv__frame *f, float *out)
{
    for (int32_t y = 0; y < f->params->height; y++) {
        for (int32_t x = 0; x < f->params->width; x++, out += 4) {
            const crv__vec3 n = crv__normal_at(f, x, y);
            out[0] = n.x;
            out[1] = n.y;
            out[2] = n.z;
            out[3] = 0;
        }
    }
}

static void pack(const crv__work *work, plan_state *state, const crv__plane *estimate,
                 int filter_only)
{
    const crv__frame *f = work->frame;
    const staging_layout layout = layout_of(work->setup);
    char *bytes = state->staging.block.mapped;
    const size_t pixels = (size_t)f->params->width * (size_t)f->params->height;
    for (int32_t i = 0; i < f->params->layers; i++)
        pack_plane(&f->depth[i], (float *)(void *)bytes + (size_t)i * pixels);
    pack_normals(f, (float *)(void *)(bytes + layout.normals));
    if (filter_only)
        pack_plane(estimate, (float *)(void *)(bytes + layout.accessibility));
    memcpy(state->slot.params.block.mapped, f->params, sizeof *f->params);
}

static VkBufferImageCopy whole(size_t offset, int32_t width, int32_t height,
                               int32_t layers)
{
    return (VkBufferImageCopy){
        .bufferOffset = offset,
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, (uint32_t)layers},
        .imageExtent = {(uint32_t)width, (uint32_t)height, 1}};
}

static void record_upload(const crv__work *work, plan_state *state, int filter_only)
{
    const crv__device *d = state->program.device;
    const crv_gbuffer_desc *g = &work->setup->desc;
    const staging_layout layout = layout_of(work->setup);
    const crv__rectangle *r = &state->slot.rectangle;
    const VkBufferImageCopy depth = whole(0, g->width, g->height, g->layers),
                            normals = whole(layout.normals, g->width, g->height, 1),
                            estimate =
                                whole(layout.accessibility, r->width, r->height, 1);
    const VkBuffer from = state->staging.buffer;
    d->vk.CmdCopyBufferToImage(state->commands.buffer, from, state->slot.depth.image,
                               VK_IMAGE_LAYOUT_GENERAL, 1, &depth);
    d->vk.CmdCopyBufferToImage(state->commands.buffer, from, state->slot.normals.image,
                               VK_IMAGE_LAYOUT_GENERAL, 1, &normals);
    if (filter_only)
        d->vk.CmdCopyBufferToImage(state->commands.buffer, from,
                                   state->slot.accessibility[0].image,
                                   VK_IMAGE_LAYOUT_GENERAL, 1, &estimate);
    crv__record_barrier(d, state->commands.buffer, CRV__COPIED_TO, CRV__SAMPLED);
    crv__slot_record_time(&state->slot, state->commands.buffer);
}

/* Runs the passes; the index of the image that holds the outcome. */
static int32_t record_passes(plan_state *state, int filter_only)
{
    const crv__device *d = state->program.device;
    const crv__rectangle *r = &state->slot.rectangle;
    crv__push push = {.in_x = r->x,
                      .in_y = r->y,
                      .in_width = r->width,
                      .in_height = r->height,
                      .out_x = r->x,
                      .out_y = r->y,
                      .out_width = r->width,
                      .out_height = r->height};
    if (!filter_only) {
        crv__slot_record_layouts(&state->slot, state->commands.buffer, &push);
        if (state->program.deinterleave.pipeline || state->program.prefilter.pipeline)
            crv__record_between(d, state->commands.buffer);
        crv__push_out(&push, *r);
        crv__slot_record_estimate(&state->slot, state->commands.buffer, &push);
        crv__slot_record_time(&state->slot, state->commands.buffer);
    }
    for (push.pass = 0; push.pass < state->program.passes; push.pass++) {
        crv__record_between(d, state->commands.buffer);
        crv__slot_record_step(&state->slot, state->commands.buffer,
                              &state->program.filter[push.pass],
                              state->slot.filter_set[push.pass], &push);
        crv__slot_record_time(&state->slot, state->commands.buffer);
    }
    return state->program.passes % 2;
}

static void record(const crv__work *work, plan_state *state, int filter_only)
{
    const crv__device *d = state->program.device;
    const crv__rectangle *r = &state->slot.rectangle;
    crv__slot_record_begin(&state->slot, state->commands.buffer);
    record_upload(work, state, filter_only);
    const int32_t outcome = record_passes(state, filter_only);
    const crv__access done = {CRV__WRITTEN.stages | CRV__COPIED_TO.stages,
                              CRV__WRITTEN.access | CRV__COPIED_TO.access};
    const crv__access copies = {CRV__COPIED_FROM.stages,
                                CRV__COPIED_FROM.access | CRV__COPIED_TO.access};
    crv__record_barrier(d, state->commands.buffer, done, copies);
    const VkBufferImageCopy copy =
        whole(layout_of(work->setup).accessibility, r->width, r->height, 1);
    d->vk.CmdCopyImageToBuffer(state->commands.buffer,
                               state->slot.accessibility[outcome].image,
                               VK_IMAGE_LAYOUT_GENERAL, state->staging.buffer, 1, &copy);
    crv__record_barrier(d, state->commands.buffer, CRV__COPIED_TO, CRV__HOST_READS);
    crv__slot_record_time(&state->slot, state->commands.buffer);
    state->filter_only = filter_only;
}

static crv_status run(const crv__work *work, int filter_only, const crv__plane planes[2],
                      const crv__plane **out)
{
    plan_state *state = work->state;
    const crv__device *d = state->program.device;
    if (work->frame->params->use_field)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: height fields and implicit surfaces are for the CPU "
                         "only; use a CPU context, or characteristic=depth");
    pack(work, state, &planes[0], filter_only);
    crv_status status = crv__commands_begin(&state->commands, d);
    if (status)
        return status;
    record(work, state, filter_only);
    status = crv__commands_run(&state->commands, d);
    if (status)
        return status;
    const char *bytes = state->staging.block.mapped;
    *out = &planes[state->program.passes % 2];
    unpack_plane(
        (const float *)(const void *)(bytes + layout_of(work->setup).accessibility),
        *out);
    return CRV_OK;
}

/* ---- times ---- */

/* The steps that a run had between upload and download; their count. */
static int32_t name_steps(const crv__setup *setup, const plan_state *state,
                          crv_device_time *out)
{
    int32_t count = 0;
    if (!state->filter_only && state->program.deinterleave.pipeline)
        out[count++].name = "deinterleave";
    if (!state->filter_only && state->program.prefilter.pipeline)
        out[count++].name = "levels";
    if (!state->filter_only)
        out[count++].name = setup->method->info.name;
    for (int32_t i = 0; i < state->program.passes; i++)
        out[count++].name = setup->filter->info.name;
    return count;
}

static crv_status times(const crv__setup *setup, const void *data, crv_device_time *out,
                        int32_t *count)
{
    const plan_state *state = data;
    const crv__slot *slot = &state->slot;
    if (!slot->queries)
        return crv__fail(&state->program.device->logger, CRV_ERROR_UNSUPPORTED,
                         "plan: the device has no timestamps");
    double times_ms[CRV__MOST_STEPS];
    const crv_status status =
        slot->query_count ? crv__slot_times(slot, times_ms) : CRV_ERROR_NOT_READY;
    if (status == CRV_ERROR_NOT_READY)
        return crv__fail(&state->program.device->logger, status,
                         "plan: no run has ended well, so that there are no times; call "
                         "crv_plan_run() first");
    if (status)
        return status;
    const int32_t steps = name_steps(setup, state, out + 1);
    out[0].name = "upload";
    out[steps + 1].name = "download";
    for (int32_t i = 0; i < steps + 2; i++)
        out[i].time_ms = times_ms[i];
    *count = steps + 2;
    return CRV_OK;
}

static void close_device(crv_context *context)
{
    crv__device_destroy(crv__device_of(context));
}

const crv__backend crv__vulkan_backend = {.name = "vulkan",
                                          .device = CRV_DEVICE_VULKAN,
                                          .open = crv__vulkan_open,
                                          .plan_create = plan_create,
                                          .plan_destroy = plan_destroy,
                                          .run = run,
                                          .times = times,
                                          .close = close_device};
