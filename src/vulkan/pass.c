/* SPDX-License-Identifier: MIT */
/* Passes in the host's command buffer. */
#include "vulkan/formats.h"
#include "vulkan/slot.h"

#include "base/structs.h"
#include "core/camera.h"
#include "core/gbuffer.h"

#include <string.h>

struct crv_vulkan_pass {
    crv_context *context;
    const crv__device *device;
    crv__setup setup;
    crv_vulkan_pass_desc desc;
    crv__program program;
    crv__slot slots[CRV_VULKAN_MAX_FRAMES];
    int recorded[CRV_VULKAN_MAX_FRAMES];
};

/* ---- what a pass is made for ---- */

static const crv__struct DESC = {.name = "pass desc",
                                 .init = "crv_vulkan_pass_desc_init()",
                                 .first = CRV__SIZE_TO(crv_vulkan_pass_desc, frames),
                                 .size = sizeof(crv_vulkan_pass_desc)};
static const crv_vulkan_pass_desc DESC_DEFAULTS = {.frames = 2,
                                                   .depth_format = VK_FORMAT_D32_SFLOAT,
                                                   .result_format = VK_FORMAT_R8_UNORM};

crv_status crv_vulkan_pass_desc_init(crv_vulkan_pass_desc *desc, size_t struct_size)
{
    return crv__struct_init(&DESC, desc, struct_size, &DESC_DEFAULTS);
}

static crv_status take_desc(const crv_logger *logger, const crv_vulkan_pass_desc *from,
                            crv_vulkan_pass_desc *desc)
{
    *desc = DESC_DEFAULTS;
    const crv_status status = crv__struct_take(&DESC, logger, from, desc);
    if (status)
        return status;
    if (desc->frames < 1 || desc->frames > CRV_VULKAN_MAX_FRAMES)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: %d frames in flight; 1 to %d", desc->frames,
                         CRV_VULKAN_MAX_FRAMES);
    if (desc->normals < CRV_VULKAN_NORMALS_NONE
        || desc->normals > CRV_VULKAN_NORMALS_OCT_HALVED)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: normals is %d; use one of crv_vulkan_normals",
                         (int)desc->normals);
    if (desc->normal_space != CRV_NORMAL_VIEW && desc->normal_space != CRV_NORMAL_WORLD)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: normal space %d is neither view nor world",
                         (int)desc->normal_space);
    if (desc->level_px < 0)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: level_px is %d; 0 or more", desc->level_px);
    if (desc->half_filters < CRV_VULKAN_HALF_AUTO
        || desc->half_filters > CRV_VULKAN_HALF_ON)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: half_filters is %d; use one of crv_vulkan_half",
                         (int)desc->half_filters);
    return CRV_OK;
}

/* The smallest format that keeps the error far below what can be seen, where the device
 * has it; every device has the other. */
static VkFormat preferred(const crv__device *d, VkFormat small, VkFormat sure)
{
    const VkFormatFeatureFlags both =
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    return crv__format_has(d, small, both) ? small : sure;
}

/* ---- life ---- */

static int wants_half(const crv__device *d, crv_vulkan_half half)
{
    return half == CRV_VULKAN_HALF_ON
           || (half == CRV_VULKAN_HALF_AUTO
               && d->properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU);
}

static crv_status create_parts(crv_vulkan_pass *p)
{
    const crv__device *d = p->device;
    const crv__slot_desc slot = {
        .normal_format =
            preferred(d, VK_FORMAT_R16G16B16A16_SNORM, VK_FORMAT_R32G32B32A32_SFLOAT),
        .accessibility_format = preferred(d, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R32_SFLOAT),
        .timestamps = p->desc.timestamps && d->timestamp_bits > 0};
    const crv__program_desc program = {
        .converts = 1,
        .half = wants_half(d, p->desc.half_filters),
        .edge = p->desc.deinterleave ? crv__apart_edge(d, &p->setup) : 1,
        .level_px = p->desc.deinterleave ? 0 : p->desc.level_px};
    if (crv__setup_patterns(&p->setup))
        return crv__fail(&d->logger, CRV_ERROR_OUT_OF_MEMORY, "pass: out of memory");
    crv_status status = crv__program_create(&p->program, d, &p->setup, &program);
    for (int32_t i = 0; status == CRV_OK && i < p->desc.frames; i++)
        status = crv__slot_create(&p->slots[i], &p->program, &p->setup, &slot);
    return status;
}

crv_status crv_vulkan_pass_create(crv_context *context, const crv_options *options,
                                  const crv_gbuffer_desc *gbuffer,
                                  const crv_vulkan_pass_desc *desc, crv_vulkan_pass **out)
{
    if (!context)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_logger *logger = &context->logger;
    const crv__device *d = crv__device_of(context);
    if (!out)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT, "pass: out is NULL");
    if (!d)
        return crv__fail(logger, CRV_ERROR_UNSUPPORTED,
                         "pass: the context has no Vulkan device; make it with "
                         "crv_vulkan_context_create()");
    crv__setup setup;
    crv_vulkan_pass_desc full;
    crv_status status = crv__setup_take(context, options, gbuffer, &setup);
    if (status == CRV_OK)
        status = take_desc(logger, desc, &full);
    if (status == CRV_OK)
        status = crv__formats_check(d, &full);
    if (status)
        return status;
    status = crv__setup_check(d, &setup);
    if (status)
        return status;
    crv_vulkan_pass *p = crv__allocate(&context->allocator, 1, sizeof *p);
    if (!p)
        return crv__fail(logger, CRV_ERROR_OUT_OF_MEMORY, "pass: out of memory");
    p->context = context;
    p->device = d;
    p->setup = setup;
    p->desc = full;
    status = create_parts(p);
    if (status)
        crv_vulkan_pass_destroy(p);
    else
        *out = p;
    return status;
}

void crv_vulkan_pass_destroy(crv_vulkan_pass *p)
{
    if (!p)
        return;
    const crv_allocator *allocator = &p->context->allocator;
    for (int32_t i = 0; i < CRV_VULKAN_MAX_FRAMES; i++)
        crv__slot_destroy(&p->slots[i]);
    crv__program_destroy(&p->program);
    crv__setup_release(&p->setup);
    crv__release(allocator, p, 1, sizeof *p);
}

uint64_t crv_vulkan_pass_bytes(const crv_vulkan_pass *p)
{
    uint64_t bytes = p ? p->program.constants.size : 0;
    for (int32_t i = 0; p && i < p->desc.frames; i++)
        bytes += crv__slot_bytes(&p->slots[i]);
    return bytes;
}

/* ---- a frame ---- */

static const crv__struct FRAME = {.name = "frame",
                                  .init = "crv_vulkan_frame_init()",
                                  .first = CRV__SIZE_TO(crv_vulkan_frame, result_access),
                                  .size = sizeof(crv_vulkan_frame)};

static crv_vulkan_frame default_frame(void)
{
    crv_vulkan_frame frame = {.depth_encoding = crv_depth_format_planar(),
                              .result_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                              .result_stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
                                               | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              .result_access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
    for (int i = 0; i < CRV_MAX_LAYERS; i++)
        frame.depth[i].layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    frame.normals.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return frame;
}

crv_status crv_vulkan_frame_init(crv_vulkan_frame *frame, size_t struct_size)
{
    const crv_vulkan_frame defaults = default_frame();
    return crv__struct_init(&FRAME, frame, struct_size, &defaults);
}

static crv_status check_frame(const crv_vulkan_pass *p, VkCommandBuffer commands,
                              const crv_vulkan_frame *frame)
{
    const crv_logger *logger = &p->context->logger;
    if (!commands)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: the command buffer is NULL");
    if (frame->index < 0 || frame->index >= p->desc.frames)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: index is %d; use 0 to %d, one for each frame in flight",
                         frame->index, p->desc.frames - 1);
    if (!frame->result || !frame->result_view)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: the result's image or view is missing; set result and "
                         "result_view");
    const crv_status status =
        crv__layouts_check(logger, &p->desc, p->setup.desc.layers, frame);
    return status ? status : crv__camera_check(logger, &frame->camera);
}

static void fill_params(crv_vulkan_pass *p, const crv_vulkan_frame *frame,
                        crv__slot *slot)
{
    crv__params params = {0};
    crv__setup_params(&p->setup, &params);
    crv__camera_params(&p->setup.desc, &frame->camera, &params);
    params.use_depth = p->setup.options.characteristic != CRV_CHARACTERISTIC_FIELD;
    memcpy(slot->params.block.mapped, &params, sizeof params);
}

/* depth.glsl says from where a hardware depth is counted, and why. */
static void fill_depth(crv__push *push, const crv__depth_map *map)
{
    const int reversed = map->format.encoding == CRV_DEPTH_REVERSED;
    const int other_end = reversed == (map->camera->projection == CRV_ORTHOGRAPHIC);
    push->depth_encoding = (int32_t)map->format.encoding;
    push->depth_background = map->format.background;
    push->depth_a = (float)(other_end ? map->a + map->b : map->a);
    push->depth_b = (float)(other_end ? -map->b : map->b);
}

static void fill_normals(crv__push *push, const crv_vulkan_pass *p,
                         const crv_vulkan_frame *frame)
{
    static const float IDENTITY[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    push->normal_encoding = (int32_t)p->desc.normals;
    memcpy(push->to_view,
           p->desc.normal_space == CRV_NORMAL_WORLD ? frame->camera.world_to_view
                                                    : IDENTITY,
           sizeof push->to_view);
}

static void record_converts(crv_vulkan_pass *p, crv__slot *slot, VkCommandBuffer commands,
                            const crv_vulkan_frame *frame, crv__push *push)
{
    const crv_gbuffer_desc *g = &p->setup.desc;
    crv__push_out(push, (crv__rectangle){0, 0, g->width, g->height});
    for (int32_t layer = 0; layer < g->layers; layer++) {
        const VkDescriptorSet set = slot->depth_set[layer];
        const crv_vulkan_input *depth = &frame->depth[layer];
        crv__bind_image(&p->program, set, CRV__BIND_HOST_DEPTH, depth->view,
                        depth->layout);
        if (layer == 0 && p->desc.normals)
            crv__bind_image(&p->program, set, CRV__BIND_HOST_NORMALS, frame->normals.view,
                            frame->normals.layout);
        crv__slot_record_step(slot, commands,
                              layer == 0 ? &p->program.convert : &p->program.depth, set,
                              push);
        crv__slot_record_time(slot, commands);
    }
    if (p->program.deinterleave.pipeline || p->program.prefilter.pipeline)
        crv__record_between(p->device, commands);
    crv__slot_record_layouts(slot, commands, push);
    crv__record_between(p->device, commands);
}

/* The last of them writes the host's image. */
static void record_passes(crv_vulkan_pass *p, crv__slot *slot, VkCommandBuffer commands,
                          const crv_vulkan_frame *frame, crv__push *push)
{
    const crv_gbuffer_desc *g = &p->setup.desc;
    const crv__rectangle result = {g->guard_left, g->guard_top,
                                   g->width - g->guard_left - g->guard_right,
                                   g->height - g->guard_top - g->guard_bottom};
    const int32_t passes = p->program.passes;
    push->in_x = slot->rectangle.x;
    push->in_y = slot->rectangle.y;
    push->in_width = slot->rectangle.width;
    push->in_height = slot->rectangle.height;
    const VkDescriptorSet last =
        passes ? slot->filter_set[passes - 1] : slot->estimate_set;
    crv__bind_image(&p->program, last, CRV__BIND_OUTPUT, frame->result_view,
                    VK_IMAGE_LAYOUT_GENERAL);
    crv__push_out(push, passes ? slot->rectangle : result);
    crv__slot_record_estimate(slot, commands, push);
    crv__slot_record_time(slot, commands);
    for (push->pass = 0; push->pass < passes; push->pass++) {
        crv__record_between(p->device, commands);
        crv__push_out(push, push->pass + 1 < passes ? slot->rectangle : result);
        crv__slot_record_step(slot, commands, &p->program.filter[push->pass],
                              slot->filter_set[push->pass], push);
        crv__slot_record_time(slot, commands);
    }
}

crv_status crv_vulkan_pass_record(crv_vulkan_pass *p, VkCommandBuffer commands,
                                  const crv_vulkan_frame *frame)
{
    if (!p)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_vulkan_frame full = default_frame();
    crv_status status = crv__struct_take(&FRAME, &p->context->logger, frame, &full);
    frame = &full;
    if (status == CRV_OK)
        status = check_frame(p, commands, frame);
    crv__depth_map map;
    if (status == CRV_OK)
        status = crv__depth_map_init(&map, &p->context->logger, &frame->camera,
                                     &frame->depth_encoding);
    if (status == CRV_OK && map.format.encoding > CRV_DEPTH_DISPARITY)
        status = crv__fail(&p->context->logger, CRV_ERROR_UNSUPPORTED,
                           "pass: depth encoding %d is not for images of a pass; use "
                           "planar, radial, hardware, reversed or disparity",
                           (int)map.format.encoding);
    if (status)
        return status;
    crv__slot *slot = &p->slots[frame->index];
    crv__push push = {0};
    fill_params(p, frame, slot);
    fill_depth(&push, &map);
    fill_normals(&push, p, frame);
    crv__slot_record_begin(slot, commands);
    crv__record_layout(p->device, commands, frame->result, VK_IMAGE_LAYOUT_UNDEFINED,
                       VK_IMAGE_LAYOUT_GENERAL, CRV__EARLIER, CRV__WRITTEN);
    record_converts(p, slot, commands, frame, &push);
    record_passes(p, slot, commands, frame, &push);
    crv__record_layout(p->device, commands, frame->result, VK_IMAGE_LAYOUT_GENERAL,
                       frame->result_layout, CRV__WRITTEN,
                       (crv__access){frame->result_stages, frame->result_access});
    p->recorded[frame->index] = 1;
    return CRV_OK;
}

/* ---- times ---- */

static const char *step_name(const crv_vulkan_pass *p, int32_t step)
{
    static const char *const PASSES[2] = {"filter, first pass", "filter, second pass"};
    if (step == 0)
        return "depth and normals";
    if (step < p->setup.desc.layers)
        return "depth";
    step -= p->setup.desc.layers;
    if (p->program.deinterleave.pipeline && step-- == 0)
        return "deinterleave";
    if (p->program.prefilter.pipeline && step-- == 0)
        return "levels";
    if (step-- == 0)
        return p->setup.method->info.name;
    return p->program.passes == 1 ? p->setup.filter->info.name : PASSES[step];
}

crv_status crv_vulkan_pass_times(crv_vulkan_pass *p, int32_t index,
                                 crv_vulkan_time *times, int32_t *count)
{
    if (!p)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv__device *d = p->device;
    if (index < 0 || index >= p->desc.frames || !times || !count)
        return crv__fail(&d->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: times and count must be given, and frame %d of %d", index,
                         p->desc.frames);
    crv__slot *slot = &p->slots[index];
    if (!slot->queries)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "pass: no timestamps; set desc.timestamps, on a queue family "
                         "that has them");
    if (!p->recorded[index])
        return crv__fail(&d->logger, CRV_ERROR_NOT_READY,
                         "pass: nothing was recorded for frame %d, so that there are no "
                         "times; call crv_vulkan_pass_record() first",
                         index);
    double times_ms[CRV__MOST_STEPS];
    const crv_status status = crv__slot_times(slot, times_ms);
    if (status)
        return status;
    *count = slot->query_count - 1;
    for (int32_t i = 0; i < *count; i++)
        times[i] = (crv_vulkan_time){step_name(p, i), times_ms[i]};
    return CRV_OK;
}
