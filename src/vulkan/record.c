/* SPDX-License-Identifier: MIT */
#include "vulkan/record.h"

/* What a recording goes through. */
typedef struct recorder {
    crv__slot *slot;
    const crv__program *program;
    const crv__image *image; /* the scratch's */
    const crv__device *device;
    VkCommandBuffer commands;
    const crv__job *job;
    crv__push push;
    int64_t rounds;          /* of loops, at most, since the last submission */
    crv__rectangle whole;    /* the buffers */
    crv__rectangle estimate; /* the accessibility images */
    crv__rectangle result;   /* what the host's result gets */
} recorder;

static VkImage image_of(const recorder *r, int index)
{
    return r->image[index].image;
}

/* ---- steps: named for debuggers, and timed ---- */

static void begin_label(const recorder *r, const char *name)
{
    const VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                        .pLabelName = name};
    if (r->device->debug.begin_label)
        r->device->debug.begin_label(r->commands, &label);
}

static void end_label(const recorder *r)
{
    if (r->device->debug.end_label)
        r->device->debug.end_label(r->commands);
}

static void begin_step(recorder *r, const char *name)
{
    begin_label(r, name);
    r->slot->steps[r->slot->step_count++] = name;
}

static void end_step(recorder *r)
{
    const crv__slot *s = r->slot;
    if (s->queries)
        r->device->vk.CmdWriteTimestamp2(r->commands,
                                         VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, s->queries,
                                         (uint32_t)s->step_count);
    end_label(r);
}

/* ---- dispatches ---- */

/* What the next dispatch writes: `out`, which begins at texel (x, y) of the image. */
static void set_output(recorder *r, crv__rectangle out, int32_t x, int32_t y)
{
    r->push.out_x = out.x;
    r->push.out_y = out.y;
    r->push.out_width = out.width;
    r->push.out_height = out.height;
    r->push.store_x = x - out.x;
    r->push.store_y = y - out.y;
}

static void dispatch(const recorder *r, const crv__pipeline *pipeline,
                     VkDescriptorSet set)
{
    const crv__device *d = r->device;
    const crv__push *push = &r->push;
    const int32_t step = pipeline->pixel_stride, tile = pipeline->group * step;
    const int32_t tile_x = tile * pipeline->lanes_x, tile_y = tile * pipeline->lanes_y;
    d->vk.CmdBindPipeline(r->commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                          pipeline->pipeline);
    d->vk.CmdBindDescriptorSets(r->commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                                d->pipelines->layout, 0, 1, &set, 0, NULL);
    d->vk.CmdPushConstants(r->commands, d->pipelines->layout, VK_SHADER_STAGE_COMPUTE_BIT,
                           0, sizeof *push, push);
    d->vk.CmdDispatch(r->commands,
                      (uint32_t)((push->out_width + tile_x - 1) / tile_x * step),
                      (uint32_t)((push->out_height + tile_y - 1) / tile_y * step), 1);
}

static void wait_between(const recorder *r)
{
    crv__record_between(r->device, r->commands);
}

/* ---- the images ---- */

/* Barriers of what the host gets, one or two; their number. */
static uint32_t result_barriers(const recorder *r, VkImageLayout before,
                                VkImageLayout after, crv__access from, crv__access to,
                                VkImageMemoryBarrier2 out[2])
{
    const crv_vulkan_frame *f = r->job->frame;
    const VkImage images[2] = {f->result, f->bent_normal};
    const uint32_t count = r->program->desc.bent ? 2 : 1;
    for (uint32_t i = 0; i < count; i++) {
        out[i] = crv__image_barrier(images[i], before, after, from, to);
        out[i].subresourceRange = (VkImageSubresourceRange){
            VK_IMAGE_ASPECT_COLOR_BIT, f->result_level, 1, f->result_layer, 1};
    }
    return count;
}

/* Those of the pass, whatever they held, after the recording before has done with them;
 * the result, after its last users. */
static void record_images(const recorder *r)
{
    const crv_vulkan_frame *f = r->job->frame;
    const crv__access written = crv__access_both(CRV__WRITTEN, CRV__COPIED_TO);
    const crv__access used = crv__access_both(
        written, (crv__access){CRV__COPIED_FROM.stages, VK_ACCESS_2_NONE});
    const crv__access ready = crv__access_both(written, CRV__SAMPLED);
    VkImageMemoryBarrier2 barriers[CRV__SCRATCH_IMAGES + 2];
    uint32_t count = 0;
    for (int i = 0; i < CRV__SCRATCH_IMAGES; i++) {
        if (image_of(r, i))
            barriers[count++] =
                crv__image_barrier(image_of(r, i), VK_IMAGE_LAYOUT_UNDEFINED,
                                   VK_IMAGE_LAYOUT_GENERAL, used, ready);
    }
    if (f)
        count += result_barriers(
            r, f->result_layout_before, VK_IMAGE_LAYOUT_GENERAL,
            (crv__access){f->result_stages_before, f->result_access_before}, CRV__WRITTEN,
            &barriers[count]);
    crv__record_image_barriers(r->device, r->commands, barriers, count);
}

/* ---- from and to the host's images ---- */

static void record_converts(recorder *r)
{
    const crv_vulkan_frame *f = r->job->frame;
    r->push.host_x = f->input_x;
    r->push.host_y = f->input_y;
    set_output(r, r->whole, 0, 0);
    for (int32_t layer = 0; layer < r->job->setup->desc.layers; layer++) {
        const VkDescriptorSet set = r->slot->depth_set[layer];
        const crv_vulkan_input *depth = &f->depth[layer];
        crv__slot_bind_image(r->slot, set, CRV__BIND_HOST_DEPTH, depth->view,
                             depth->layout);
        if (layer == 0 && r->job->has_normals)
            crv__slot_bind_image(r->slot, set, CRV__BIND_VECTORS, f->normals.view,
                                 f->normals.layout);
        begin_step(r, layer == 0 ? "depth and normals" : "depth");
        dispatch(r, layer == 0 ? &r->program->convert : &r->program->depth, set);
        end_step(r);
    }
    wait_between(r);
}

/* The last step writes the result. */
static void record_result_layout(const recorder *r)
{
    const crv_vulkan_frame *f = r->job->frame;
    VkImageMemoryBarrier2 barriers[2];
    const uint32_t count =
        result_barriers(r, VK_IMAGE_LAYOUT_GENERAL, f->result_layout, CRV__WRITTEN,
                        (crv__access){f->result_stages, f->result_access}, barriers);
    crv__record_image_barriers(r->device, r->commands, barriers, count);
}

/* ---- from and to a staging buffer ---- */

static VkBufferImageCopy copy_of(size_t offset, crv__rectangle r, int32_t layers)
{
    return (VkBufferImageCopy){
        .bufferOffset = offset,
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, (uint32_t)layers},
        .imageExtent = {(uint32_t)r.width, (uint32_t)r.height, 1}};
}

static void upload(const recorder *r, int image, const VkBufferImageCopy *copy)
{
    r->device->vk.CmdCopyBufferToImage(r->commands, r->job->staging->buffer.buffer,
                                       image_of(r, image), VK_IMAGE_LAYOUT_GENERAL, 1,
                                       copy);
}

static void record_upload(recorder *r)
{
    const crv__staging *staging = r->job->staging;
    const VkBufferImageCopy depth = copy_of(0, r->whole, r->job->setup->desc.layers);
    const VkBufferImageCopy normals = copy_of(staging->normals, r->whole, 1);
    const VkBufferImageCopy estimate = copy_of(staging->accessibility, r->estimate, 1);
    begin_step(r, "upload");
    upload(r, CRV__SCRATCH_DEPTH, &depth);
    upload(r, CRV__SCRATCH_NORMALS, &normals);
    if (r->job->filter_only)
        upload(r, CRV__SCRATCH_ACCESSIBILITY, &estimate);
    crv__record_barrier(r->device, r->commands, CRV__COPIED_TO, CRV__SAMPLED);
    end_step(r);
}

static void download(const recorder *r, int image, size_t offset)
{
    const VkBufferImageCopy copy = copy_of(offset, r->estimate, 1);
    r->device->vk.CmdCopyImageToBuffer(r->commands, image_of(r, image),
                                       VK_IMAGE_LAYOUT_GENERAL,
                                       r->job->staging->buffer.buffer, 1, &copy);
}

static void record_download(recorder *r)
{
    const crv__staging *staging = r->job->staging;
    const bool is_filtered = r->program->passes % 2 != 0;
    begin_step(r, "download");
    crv__record_barrier(r->device, r->commands,
                        crv__access_both(CRV__WRITTEN, CRV__COPIED_TO),
                        crv__access_both(CRV__COPIED_FROM, CRV__COPIED_TO));
    download(r, is_filtered ? CRV__SCRATCH_FILTERED : CRV__SCRATCH_ACCESSIBILITY,
             staging->accessibility);
    if (r->job->with_bent)
        download(r, is_filtered ? CRV__SCRATCH_BENT_FILTERED : CRV__SCRATCH_BENT,
                 staging->bent);
    crv__record_barrier(r->device, r->commands, CRV__COPIED_TO, CRV__HOST_READS);
    end_step(r);
}

/* ---- in between ---- */

static void record_deinterleave(recorder *r)
{
    if (!r->program->deinterleave.pipeline)
        return;
    begin_step(r, "deinterleave");
    set_output(r, r->whole, 0, 0);
    dispatch(r, &r->program->deinterleave, r->slot->deinterleave_set);
    end_step(r);
    wait_between(r);
}

/* No level waits for another. */
static void record_levels(recorder *r)
{
    const crv__image_desc *depth = &r->image[CRV__SCRATCH_DEPTH].desc;
    if (!r->program->prefilter.pipeline)
        return;
    begin_step(r, "levels");
    for (r->push.layer = 0; r->push.layer < depth->layers; r->push.layer++) {
        for (r->push.pass = 1; r->push.pass < depth->levels; r->push.pass++) {
            const crv__rectangle level = {0, 0, r->whole.width >> r->push.pass,
                                          r->whole.height >> r->push.pass};
            set_output(r, level, 0, 0);
            dispatch(r, &r->program->prefilter,
                     r->slot->level_set[r->push.layer][r->push.pass]);
        }
    }
    r->push.layer = r->push.pass = 0;
    end_step(r);
    wait_between(r);
}

/* What the estimate reads beside depth and normals, if these options need it. */
static void record_map(recorder *r)
{
    const crv__map *map = crv__setup_map(r->job->setup);
    if (!map)
        return;
    begin_step(r, map->name);
    set_output(r, r->whole, 0, 0);
    dispatch(r, &r->program->map, r->slot->map_set);
    end_step(r);
    wait_between(r);
}

/* The output of the last step if `is_last`, else of an image of the pass. */
static void set_accessibility_output(recorder *r, bool is_last, VkDescriptorSet set)
{
    const crv_vulkan_frame *f = r->job->frame;
    if (!is_last || !f) {
        set_output(r, r->estimate, 0, 0);
        return;
    }
    crv__slot_bind_image(r->slot, set, CRV__BIND_OUTPUT, f->result_view,
                         VK_IMAGE_LAYOUT_GENERAL);
    if (r->program->desc.bent)
        crv__slot_bind_image(r->slot, set, CRV__BIND_VECTORS_OUTPUT, f->bent_normal_view,
                             VK_IMAGE_LAYOUT_GENERAL);
    set_output(r, r->result, f->result_x, f->result_y);
}

/* Leaves of the output the rows of a band, `from` to before `to`. */
static void set_band(recorder *r, int32_t from, int32_t to)
{
    const int32_t height = r->push.out_height;
    r->push.out_y += from;
    r->push.out_height = (to < height ? to : height) - from;
}

/* A part of a band. Sums begin at the corner of their image, whatever the band. */
static void record_part(recorder *r, int32_t part, int32_t from, int32_t to)
{
    const crv__program *p = r->program;
    const bool is_last = p->passes == 0, ends = part + 1 == p->parts;
    r->push.part_begin = part * p->part_size;
    r->push.part_end = r->push.part_begin + p->part_size;
    r->push.is_last_part = ends;
    set_accessibility_output(r, is_last, r->slot->estimate_set);
    set_band(r, from, to);
    if (!ends) {
        r->push.store_x = -r->push.out_x;
        r->push.store_y = -r->push.out_y;
    }
    dispatch(r, &p->estimate, ends ? r->slot->estimate_set : r->slot->part_set[part % 2]);
}

/* Between two pieces: waits, and submits if the next one would be too much at once. */
static crv_status end_piece(recorder *r, int64_t rounds, int32_t done, int32_t total)
{
    r->rounds += rounds;
    if (r->job->submit && r->rounds + rounds > r->program->submission_rounds) {
        end_label(r); /* a command buffer ends those that it begins */
        end_label(r);
        const crv_status status = r->job->submit(r->job->user, done, total);
        if (status)
            return status;
        r->rounds = 0;
        begin_label(r, "crevice");
        begin_label(r, r->job->setup->method->info.name);
    }
    wait_between(r);
    return CRV_OK;
}

/* Rows that are computed at once: all, unless that is too much for a submission. */
static int32_t band_height(const recorder *r)
{
    const crv__pipeline *estimate = &r->program->estimate;
    const int32_t least = estimate->group * estimate->pixel_stride;
    const int64_t row_rounds = (int64_t)r->estimate.width * r->program->part_rounds;
    const int64_t rows = r->program->submission_rounds / row_rounds / least * least;
    if (!r->job->submit || rows >= r->estimate.height)
        return r->estimate.height;
    return rows > least ? (int32_t)rows : least;
}

/* In as many dispatches as the program says; of a plan, band by band. */
static crv_status record_estimate(recorder *r)
{
    const int32_t height = band_height(r), parts = r->program->parts;
    const int32_t bands = (r->estimate.height + height - 1) / height;
    const int64_t rounds = (int64_t)r->estimate.width * height * r->program->part_rounds;
    crv_status status = CRV_OK;
    begin_step(r, r->job->setup->method->info.name);
    for (int32_t i = 0; status == CRV_OK && i < bands * parts; i++) {
        if (i > 0)
            status = end_piece(r, rounds, i, bands * parts);
        if (status == CRV_OK)
            record_part(r, i % parts, i / parts * height, (i / parts + 1) * height);
    }
    if (status == CRV_OK)
        end_step(r);
    return status;
}

static void record_filter(recorder *r)
{
    const crv__program *p = r->program;
    for (r->push.pass = 0; r->push.pass < p->passes; r->push.pass++) {
        const VkDescriptorSet set = r->slot->filter_set[r->push.pass];
        wait_between(r);
        begin_step(r, r->job->setup->filter->info.name);
        set_accessibility_output(r, r->push.pass + 1 == p->passes, set);
        dispatch(r, &p->filter[r->push.pass], set);
        end_step(r);
    }
}

/* ---- all of it ---- */

static void begin(recorder *r)
{
    crv__slot *s = r->slot;
    s->step_count = 0;
    begin_label(r, "crevice");
    record_images(r);
    if (!s->queries)
        return;
    r->device->vk.CmdResetQueryPool(r->commands, s->queries, 0, CRV__MOST_STEPS + 1);
    r->device->vk.CmdWriteTimestamp2(r->commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                     s->queries, 0);
}

crv_status crv__record(crv__slot *slot, VkCommandBuffer commands, const crv__job *job)
{
    const crv_gbuffer_desc *g = &job->setup->desc;
    recorder r = {.slot = slot,
                  .program = slot->program,
                  .image = slot->scratch->image,
                  .device = slot->program->device,
                  .commands = commands,
                  .job = job,
                  .push = job->push,
                  .whole = {0, 0, g->width, g->height},
                  .estimate = crv__setup_rectangle(job->setup),
                  .result = {g->guard_left, g->guard_top,
                             g->width - g->guard_left - g->guard_right,
                             g->height - g->guard_top - g->guard_bottom}};
    r.push.in_x = r.estimate.x;
    r.push.in_y = r.estimate.y;
    r.push.in_width = r.estimate.width;
    r.push.in_height = r.estimate.height;
    begin(&r);
    if (job->frame)
        record_converts(&r);
    else
        record_upload(&r);
    if (!job->filter_only) {
        record_deinterleave(&r);
        record_levels(&r);
        record_map(&r);
        const crv_status status = record_estimate(&r);
        if (status)
            return status;
    }
    record_filter(&r);
    if (job->frame)
        record_result_layout(&r);
    else
        record_download(&r);
    end_label(&r);
    return CRV_OK;
}
