/* SPDX-License-Identifier: MIT */
/* crv_vulkan_pass: passes in the host's command buffer. */
#include "vulkan/formats.h"
#include "vulkan/pass.h"

#include "base/structs.h"
#include "core/camera.h"
#include "core/gbuffer.h"
#include "core/options.h"

#include <string.h>

struct crv_vulkan_pass {
    crv_context *context;
    crv__setup setup;
    crv_vulkan_pass_desc desc;
    crv__pass pass;
};

/* ---- what a pass is created for ---- */

static const crv__struct DESC = {.name = "pass desc",
                                 .init = "crv_vulkan_pass_desc_init()",
                                 .first = CRV__SIZE_TO(crv_vulkan_pass_desc, frames),
                                 .size = sizeof(crv_vulkan_pass_desc)};
static const crv_vulkan_pass_desc DESC_DEFAULTS = {.frames = 2,
                                                   .depth_format = VK_FORMAT_D32_SFLOAT,
                                                   .result_format = VK_FORMAT_R8_UNORM,
                                                   .level_px = 16};

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
                         "pass: %d recordings in flight; use 1 to %d", desc->frames,
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
    if (desc->depth_layout < CRV_VULKAN_DEPTH_LINEAR
        || desc->depth_layout > CRV_VULKAN_DEPTH_LEVELS)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: depth_layout is %d; use one of crv_vulkan_depth_layout",
                         (int)desc->depth_layout);
    if (desc->level_px < 1)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: level_px is %d; use 1 or more", desc->level_px);
    if (desc->half_filters < CRV_VULKAN_HALF_AUTO
        || desc->half_filters > CRV_VULKAN_HALF_ON)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: half_filters is %d; use one of crv_vulkan_half",
                         (int)desc->half_filters);
    return CRV_OK;
}

/* ---- life ---- */

static crv_status create_parts(crv_vulkan_pass *p)
{
    const crv__pass_desc desc = {.converts = true,
                                 .timestamps = p->desc.timestamps != VK_FALSE,
                                 .slots = p->desc.frames,
                                 .depth_layout = p->desc.depth_layout,
                                 .level_px = p->desc.level_px,
                                 .half_filters = p->desc.half_filters,
                                 .bent = p->desc.bent_normal_format != 0,
                                 .bent_form =
                                     crv__format_is_octahedral(p->desc.bent_normal_format)
                                         ? CRV__BENT_OCTAHEDRAL
                                         : CRV__BENT_UNIT};
    if (crv__setup_patterns(&p->setup))
        return crv__fail(&p->context->logger, CRV_ERROR_OUT_OF_MEMORY,
                         "pass: out of memory");
    return crv__pass_create(&p->pass, crv__device_of(p->context), &p->setup, &desc);
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
    if (status == CRV_OK && full.bent_normal_format && !setup.options.method->bent_normal)
        return crv__fail(
            logger, CRV_ERROR_INVALID_ARGUMENT,
            "pass: %s gives no bent normals; leave bent_normal_format "
            "UNDEFINED, or choose a method whose crv_method.bent_normal is 1",
            setup.options.method->name);
    if (status)
        return status;
    status = crv__setup_check(d, &setup);
    if (status)
        return status;
    crv_vulkan_pass *p = crv__allocate(&context->allocator, 1, sizeof *p);
    if (!p)
        return crv__fail(logger, CRV_ERROR_OUT_OF_MEMORY, "pass: out of memory");
    p->context = context;
    context->children++;
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
    crv__pass_destroy(&p->pass, allocator);
    crv__setup_release(&p->setup);
    p->context->children--;
    crv__release(allocator, p, 1, sizeof *p);
}

/* Of the options that noise and points depend on, all others are fixed. */
static bool patterns_differ(const crv_options *a, const crv_options *b)
{
    return a->seed != b->seed || a->noise_index != b->noise_index || a->tau < b->tau
           || a->tau > b->tau || a->u < b->u || a->u > b->u;
}

crv_status crv_vulkan_pass_set_options(crv_vulkan_pass *p, const crv_options *options)
{
    if (!p)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_logger *logger = &p->context->logger;
    crv_options full;
    const crv_status status = crv__options_take(logger, options, &full);
    if (status)
        return status;
    const crv_options before = p->setup.options;
    full.bent_normal = before.bent_normal; /* the desc's format decides */
    const char *key = crv__pass_fixes(&p->pass, &full);
    if (!key)
        key = crv__setup_obstacle(&p->setup, &full);
    if (key)
        return crv__fail(logger, CRV_ERROR_UNSUPPORTED,
                         "pass: %s is fixed when a pass is created; create another one",
                         key);
    crv__setup_revise(&p->setup, &full);
    if (patterns_differ(&before, &full))
        crv__setup_fill(&p->setup);
    return CRV_OK;
}

uint64_t crv_vulkan_pass_bytes(const crv_vulkan_pass *p)
{
    return p ? crv__pass_bytes(&p->pass) : 0;
}

/* ---- a frame ---- */

static const crv__struct FRAME = {.name = "frame",
                                  .init = "crv_vulkan_frame_init()",
                                  .first = CRV__SIZE_TO(crv_vulkan_frame, result_access),
                                  .size = sizeof(crv_vulkan_frame)};

static crv_vulkan_frame default_frame(void)
{
    crv_vulkan_frame frame = {.depth_encoding = crv_depth_format_planar(),
                              .result_layout_before = VK_IMAGE_LAYOUT_UNDEFINED,
                              .result_stages_before =
                                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                              .result_access_before = VK_ACCESS_2_MEMORY_WRITE_BIT,
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

/* A frame may be smaller than the pass, but its result may not be empty. */
static crv_status check_size(const crv_vulkan_pass *p, const crv_vulkan_frame *frame)
{
    const crv_gbuffer_desc *g = &p->setup.desc;
    const int32_t width = frame->width ? frame->width : g->width,
                  height = frame->height ? frame->height : g->height;
    if (width <= g->guard_left + g->guard_right || width > g->width
        || height <= g->guard_top + g->guard_bottom || height > g->height)
        return crv__fail(
            &p->context->logger, CRV_ERROR_INVALID_ARGUMENT,
            "pass: the frame has %d x %d px; the pass takes %d x %d at most, "
            "and more than its guard band",
            width, height, g->width, g->height);
    if (frame->input_x < 0 || frame->input_y < 0 || frame->result_x < 0
        || frame->result_y < 0)
        return crv__fail(&p->context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: input_x, input_y, result_x and result_y are texels of "
                         "the images; use 0 or more");
    return CRV_OK;
}

static crv_status check_frame(const crv_vulkan_pass *p, VkCommandBuffer commands,
                              const crv_vulkan_frame *frame)
{
    const crv_logger *logger = &p->context->logger;
    if (!commands)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: the command buffer is NULL");
    if (frame->index < 0 || frame->index >= p->desc.frames)
        return crv__fail(
            logger, CRV_ERROR_INVALID_ARGUMENT,
            "pass: index is %d; use 0 to %d, one for each recording in flight",
            frame->index, p->desc.frames - 1);
    if (!frame->result || !frame->result_view)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: the result's image or view is missing; set result and "
                         "result_view");
    if (p->desc.bent_normal_format && (!frame->bent_normal || !frame->bent_normal_view))
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: the bent normal's image or view is missing; set "
                         "bent_normal and bent_normal_view");
    crv_status status = check_size(p, frame);
    if (status == CRV_OK)
        status = crv__layouts_check(logger, &p->desc, p->setup.desc.layers, frame);
    return status ? status : crv__camera_check(logger, &frame->camera);
}

/* depth.glsl says from where a depth between planes is counted, and why. */
static void fill_depth(crv__push *push, const crv__depth_map *map)
{
    push->depth_encoding = (int32_t)map->format.encoding;
    push->depth_background = map->format.background;
    push->depth_a = (float)(map->b < 0 ? map->a + map->b : map->a);
    push->depth_b = (float)map->b;
}

static void fill_normals(crv__push *push, const crv_vulkan_pass *p,
                         const crv_vulkan_frame *frame)
{
    static const float IDENTITY[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    push->normal_encoding = (int32_t)p->desc.normals;
    const float *m =
        p->desc.normal_space == CRV_NORMAL_WORLD ? frame->camera.world_to_view : IDENTITY;
    push->to_view_xx = m[0];
    push->to_view_xy = m[1];
    push->to_view_xz = m[2];
    push->to_view_yx = m[3];
    push->to_view_yy = m[4];
    push->to_view_yz = m[5];
    push->to_view_zx = m[6];
    push->to_view_zy = m[7];
    push->to_view_zz = m[8];
}

/* The pass's setup for a frame, which may be smaller and lie elsewhere. */
static crv__setup setup_of(const crv_vulkan_pass *p, const crv_vulkan_frame *frame)
{
    crv__setup setup = p->setup;
    setup.desc.width = frame->width ? frame->width : setup.desc.width;
    setup.desc.height = frame->height ? frame->height : setup.desc.height;
    setup.desc.origin_x += frame->origin_x;
    setup.desc.origin_y += frame->origin_y;
    return setup;
}

static crv__params params_of(const crv__setup *setup, const crv_camera *camera)
{
    crv__params params = {0};
    crv__setup_params(setup, &params);
    crv__camera_params(&setup->desc, camera, &params);
    params.use_depth = setup->options.characteristic != CRV_CHARACTERISTIC_FIELD;
    return params;
}

crv_status crv_vulkan_pass_record(crv_vulkan_pass *p, VkCommandBuffer commands,
                                  const crv_vulkan_frame *given)
{
    if (!p)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_vulkan_frame full = default_frame();
    const crv_vulkan_frame *frame = &full;
    crv_status status = crv__struct_take(&FRAME, &p->context->logger, given, &full);
    if (status == CRV_OK)
        status = check_frame(p, commands, frame);
    crv__depth_map map;
    if (status == CRV_OK)
        status = crv__depth_map_init(&map, &p->context->logger, &frame->camera,
                                     &frame->depth_encoding);
    if (status)
        return status;
    crv__slot *slot = &p->pass.slots[frame->index];
    const crv__setup setup = setup_of(p, frame);
    const crv__params params = params_of(&setup, &frame->camera);
    crv__job job = {.setup = &setup,
                    .frame = frame,
                    .has_normals = p->desc.normals != CRV_VULKAN_NORMALS_NONE};
    fill_depth(&job.push, &map);
    fill_normals(&job.push, p, frame);
    crv__slot_fill(slot, &setup, &params, frame->noise_index);
    crv__record(slot, commands, &job);
    return CRV_OK;
}

/* ---- times ---- */

crv_status crv_vulkan_pass_times(const crv_vulkan_pass *p, int32_t index,
                                 crv_device_time *times, int32_t *count)
{
    if (!p)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_logger *logger = &p->context->logger;
    if (index < 0 || index >= p->desc.frames || !times || !count)
        return crv__fail(
            logger, CRV_ERROR_INVALID_ARGUMENT,
            "pass: times and count must be given, and an index from 0 to %d, "
            "not %d",
            p->desc.frames - 1, index);
    const crv__slot *slot = &p->pass.slots[index];
    const crv_status status = crv__slot_times(slot, times, count);
    if (status == CRV_ERROR_UNSUPPORTED)
        return crv__fail(logger, status,
                         "pass: no timestamps; set desc.timestamps, on a queue family "
                         "that has them");
    if (status == CRV_ERROR_NOT_READY && !slot->step_count)
        return crv__fail(logger, status,
                         "pass: nothing was recorded with index %d; call "
                         "crv_vulkan_pass_record() first",
                         index);
    return status;
}
