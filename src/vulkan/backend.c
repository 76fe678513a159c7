/* SPDX-License-Identifier: MIT */
/* Plans on a device: passes on images of their own. What the CPU has converted is copied
 * there, computed and copied back. */
#include "vulkan/commands.h"
#include "vulkan/pass.h"

#include <string.h>

typedef struct plan_state {
    crv__pass pass;
    crv__staging staging;
    crv__commands commands;
} plan_state;

/* ---- life ---- */

static crv_status create_staging(crv__staging *s, const crv__device *d,
                                 const crv__setup *setup)
{
    enum { TEXEL = 16 }; /* bytes, of vectors, which begin at a multiple of it */
    const crv__rectangle r = crv__setup_rectangle(setup);
    const size_t pixels = (size_t)setup->desc.width * (size_t)setup->desc.height;
    const size_t depth = pixels * (size_t)setup->desc.layers * sizeof(float);
    s->normals = (depth + TEXEL - 1) / TEXEL * TEXEL;
    s->accessibility = s->normals + pixels * TEXEL;
    const size_t estimated = (size_t)r.width * (size_t)r.height;
    const size_t end = s->accessibility + estimated * sizeof(float);
    s->bent = (end + TEXEL - 1) / TEXEL * TEXEL;
    s->size = setup->has_bent ? s->bent + estimated * TEXEL : end;
    return crv__buffer_create(&s->buffer, d, "staging", s->size,
                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT
                                  | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

static void plan_destroy(const crv__setup *setup, void *data)
{
    plan_state *state = data;
    const crv__device *d = crv__device_of(setup->context);
    crv__commands_destroy(&state->commands, d);
    crv__buffer_destroy(&state->staging.buffer, d);
    crv__pass_destroy(&state->pass, &setup->context->allocator);
    crv__release(&setup->context->allocator, state, 1, sizeof *state);
}

static crv_status plan_create(const crv__setup *setup, const crv__plane *rectangle,
                              void **out)
{
    enum { LEVEL_PX = 16 };
    const crv__device *d = crv__device_of(setup->context);
    const crv__pass_desc desc = {.single = true,
                                 .timestamps = true,
                                 .slots = 1,
                                 .depth_layout = d->plan_layout,
                                 .level_px = LEVEL_PX,
                                 .half_filters = d->plan_half,
                                 .bent = setup->has_bent};
    (void)rectangle; /* the setup's own */
    crv_status status = crv__setup_check(d, setup);
    if (status)
        return status;
    plan_state *state = crv__allocate(&setup->context->allocator, 1, sizeof *state);
    if (!state)
        return crv__fail(&d->logger, CRV_ERROR_OUT_OF_MEMORY, "plan: out of memory");
    status = crv__pass_create(&state->pass, d, setup, &desc);
    if (status == CRV_OK)
        status = create_staging(&state->staging, d, setup);
    if (status == CRV_OK)
        status = crv__commands_create(&state->commands, d, "plans");
    if (status)
        plan_destroy(setup, state);
    else
        *out = state;
    return status;
}

static bool plan_update(const crv__setup *setup, void *data)
{
    const plan_state *state = data;
    return !crv__pass_fixes(&state->pass, &setup->options);
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

/* Of vectors of four. */
static void unpack_vectors(const float *in, const crv__plane planes[3])
{
    const crv__plane *p = &planes[0];
    for (int32_t y = p->y0; y < p->y0 + p->height; y++)
        for (int32_t x = p->x0; x < p->x0 + p->width; x++, in += 4)
            for (int i = 0; i < 3; i++)
                *crv__plane_at(&planes[i], x, y) = in[i];
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

static float *staged(const plan_state *state, size_t offset)
{
    return (float *)(void *)((char *)state->staging.buffer.block.mapped + offset);
}

static void pack(const crv__work *work, const plan_state *state,
                 const crv__plane *estimate, bool filter_only)
{
    const crv__frame *f = work->frame;
    const size_t pixels = (size_t)f->params->width * (size_t)f->params->height;
    for (int32_t i = 0; i < f->params->layers; i++)
        pack_plane(&f->depth[i], staged(state, (size_t)i * pixels * sizeof(float)));
    pack_normals(f, staged(state, state->staging.normals));
    if (filter_only)
        pack_plane(estimate, staged(state, state->staging.accessibility));
}

/* crv__job.submit */
static crv_status submit(const void *user, int32_t done, int32_t total)
{
    const crv__work *work = user;
    plan_state *state = work->state;
    const crv__device *d = state->pass.device;
    const crv_progress *progress = &work->setup->context->progress;
    const crv_status status = crv__commands_run(&state->commands, d);
    if (status)
        return status;
    if (progress->fn && progress->fn(progress->user, done, total))
        return CRV_ERROR_STOPPED;
    return crv__commands_begin(&state->commands, d);
}

static crv_status run(const crv__work *work, const crv__picture pictures[2],
                      crv__picture *out)
{
    plan_state *state = work->state;
    const crv__device *d = state->pass.device;
    crv__slot *slot = &state->pass.slots[0];
    const crv__job job = {.setup = work->setup,
                          .staging = &state->staging,
                          .submit = submit,
                          .user = work,
                          .filter_only = work->filter_only,
                          .with_bent = work->with_bent};
    if (work->frame->params->use_field)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: height fields and implicit surfaces are for the CPU "
                         "only; use a CPU context, or characteristic=depth");
    pack(work, state, &pictures[0].accessibility, job.filter_only);
    crv__slot_fill(slot, work->setup, work->frame->params, 0);
    crv_status status = crv__commands_begin(&state->commands, d);
    if (status)
        return status;
    status = crv__record(slot, state->commands.buffer, &job);
    if (status == CRV_OK)
        status = crv__commands_run(&state->commands, d);
    if (status)
        return status;
    *out = pictures[state->pass.program.passes % 2];
    unpack_plane(staged(state, state->staging.accessibility), &out->accessibility);
    if (work->with_bent)
        unpack_vectors(staged(state, state->staging.bent), out->bent);
    return CRV_OK;
}

static crv_status times(const crv__setup *setup, const void *data, crv_device_time *out,
                        int32_t *count)
{
    const plan_state *state = data;
    const crv_status status = crv__slot_times(&state->pass.slots[0], out, count);
    if (status == CRV_ERROR_UNSUPPORTED)
        return crv__fail(&setup->context->logger, status,
                         "plan: the device has no timestamps");
    if (status == CRV_ERROR_NOT_READY)
        return crv__fail(&setup->context->logger, status,
                         "plan: no run has ended well, so that there are no times; call "
                         "crv_plan_run() first");
    return status;
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
                                          .plan_update = plan_update,
                                          .run = run,
                                          .times = times,
                                          .close = close_device};
