/* SPDX-License-Identifier: MIT */
/* Runs of a plan: what goes in and comes out, and the device's times. */
#include "base/structs.h"
#include "core/gbuffer.h"
#include "core/plan.h"

#include <math.h>
#include <string.h>

/* Which characteristic functions this frame has and the options ask for. A field alone
 * that is not there leaves everything outside. */
static void select_characteristic(crv_plan *plan, int32_t has_field)
{
    const crv_characteristic wanted = plan->setup.options.characteristic;
    plan->params.use_depth = wanted != CRV_CHARACTERISTIC_FIELD;
    plan->params.use_field = wanted != CRV_CHARACTERISTIC_DEPTH && has_field;
}

static const crv__struct RESULT = {.name = "result",
                                   .init = "crv_result_init()",
                                   .first = CRV__SIZE_TO(crv_result, accessibility),
                                   .size = sizeof(crv_result)};

crv_status crv_result_init(crv_result *result, size_t struct_size)
{
    const crv_result nothing = {.struct_size = 0};
    return crv__struct_init(&RESULT, result, struct_size, &nothing);
}

/* Checks the images that are wanted. */
static crv_status check_result(const crv_plan *plan, const crv_result *result)
{
    const crv_logger *logger = &plan->context->logger;
    const crv__setup *s = &plan->setup;
    const crv_gbuffer_desc *d = &s->desc;
    const int32_t width = d->width - d->guard_left - d->guard_right,
                  height = d->height - d->guard_top - d->guard_bottom;
    const bool with_bent = result->bent_normal.data;
    if (with_bent && !s->options.method->bent_normal)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "result: %s gives no bent normals; leave bent_normal.data NULL, "
                         "or choose a method whose crv_method.bent_normal is 1",
                         s->options.method->name);
    if (with_bent && !crv__setup_bent(s))
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "result: the plan has no bent normals; set the option "
                         "bent_normal to 1");
    crv_status status = CRV_OK;
    if (result->accessibility.data || !with_bent)
        status =
            crv__output_check(logger, "result", &result->accessibility, width, height, 1);
    if (status == CRV_OK && with_bent)
        status = crv__output_check(logger, "result: bent_normal", &result->bent_normal,
                                   width, height, 3);
    return status;
}

/* Checks the arguments of a run and makes the frame. */
static crv_status begin(crv_plan *plan, crv_gbuffer *g, const crv_result *result,
                        crv__frame *frame)
{
    if (g->context != plan->context
        || !crv_gbuffer_desc_equal(&g->desc, &plan->setup.desc))
        return crv__fail(&plan->context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "plan: the G-buffer was made with another desc or context");
    crv_status status = check_result(plan, result);
    if (status == CRV_OK)
        status = crv__gbuffer_prepare(g);
    if (status)
        return status;
    crv__gbuffer_params(g, &plan->params);
    *frame = (crv__frame){.params = &plan->params,
                          .depth = g->depth,
                          .normal = g->normal,
                          .noise = plan->setup.noise,
                          .directions = plan->setup.directions,
                          .pattern = plan->setup.pattern,
                          .field = g->has_field ? &g->field : NULL};
    select_characteristic(plan, g->has_field);
    return CRV_OK;
}

typedef struct copy_job {
    const crv_plan *plan;
    const crv__frame *frame;
    crv__picture from;
    const crv_result *to;
} copy_job;

static void copy_row(void *data, uint32_t index)
{
    const copy_job *job = data;
    const crv_gbuffer_desc *d = &job->plan->setup.desc;
    const crv_image *to = &job->to->accessibility;
    const int32_t y = (int32_t)index;
    const float *row =
        crv__plane_at(&job->from.accessibility, d->guard_left, d->guard_top + y);
    if (to->pixel_stride == sizeof(float)) {
        memcpy(crv_image_at(to, 0, y, 0), row, (size_t)to->width * sizeof(float));
        return;
    }
    for (int32_t x = 0; x < to->width; x++)
        *crv_image_at(to, x, y, 0) = row[x];
}

/* The bent normal of a pixel of the buffers, with unit length. The mean of opposite
 * directions has none: the surface's own. Of a surface without a normal, as nonsense in
 * the depth makes it, there is no hemisphere either: 0. */
static crv__vec3 bent_at(const copy_job *job, int32_t x, int32_t y)
{
    const crv__vec3 n = crv__normal_at(job->frame, x, y);
    if (!(*crv__plane_at(&job->frame->depth[0], x, y) < INFINITY)
        || !(crv__dot(n, n) > 0))
        return (crv__vec3){0, 0, 0};
    const crv__vec3 b = crv__vec3_at(job->from.bent, x, y);
    const float squared = crv__dot(b, b);
    if (!(squared > 1e-12f && squared < INFINITY))
        return n;
    const float scale = 1 / sqrtf(squared);
    return (crv__vec3){b.x * scale, b.y * scale, b.z * scale};
}

static void copy_bent_row(void *data, uint32_t index)
{
    const copy_job *job = data;
    const crv_gbuffer_desc *d = &job->plan->setup.desc;
    const crv_image *to = &job->to->bent_normal;
    const int32_t y = (int32_t)index;
    for (int32_t x = 0; x < to->width; x++) {
        const crv__vec3 bent = bent_at(job, d->guard_left + x, d->guard_top + y);
        *crv_image_at(to, x, y, 0) = bent.x;
        *crv_image_at(to, x, y, 1) = bent.y;
        *crv_image_at(to, x, y, 2) = bent.z;
    }
}

/* Runs the plan and copies the rectangle inside the guard band to the result. */
static crv_status finish(crv_plan *plan, const crv__frame *frame, bool filter_only,
                         const crv_result *result)
{
    const crv__work work = {.setup = &plan->setup,
                            .state = plan->state,
                            .frame = frame,
                            .filter_only = filter_only,
                            .with_bent = result->bent_normal.data,
                            .target =
                                result->accessibility.data && !plan->context->progress.fn
                                    ? &result->accessibility
                                    : NULL};
    copy_job job = {.plan = plan, .frame = frame, .to = result};
    crv_status status = plan->context->backend->run(&work, plan->pictures, &job.from);
    if (status)
        return status;
    if (result->accessibility.data
        && result->accessibility.data != job.from.accessibility.data)
        crv__run_rows(plan->context, result->accessibility.height, copy_row, &job);
    if (result->bent_normal.data)
        crv__run_rows(plan->context, result->bent_normal.height, copy_bent_row, &job);
    return CRV_OK;
}

crv_status crv_plan_run_result(crv_plan *plan, crv_gbuffer *gbuffer,
                               const crv_result *result)
{
    if (!plan || !gbuffer)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_result full = {.struct_size = 0};
    crv__frame frame;
    crv_status status = crv__struct_take(&RESULT, &plan->context->logger, result, &full);
    if (status == CRV_OK)
        status = begin(plan, gbuffer, &full, &frame);
    return status ? status : finish(plan, &frame, false, &full);
}

/* A result of accessibility alone; NULL is refused by the check. */
static crv_result only(const crv_image *accessibility)
{
    crv_result result = {.struct_size = sizeof result};
    if (accessibility)
        result.accessibility = *accessibility;
    return result;
}

crv_status crv_plan_run(crv_plan *plan, crv_gbuffer *gbuffer, const crv_image *result)
{
    const crv_result wanted = only(result);
    return crv_plan_run_result(plan, gbuffer, &wanted);
}

typedef struct take_job {
    const crv_plan *plan;
    const crv_const_image *from;
    const crv__plane *to;
} take_job;

/* A row of the estimate's plane. Outside the given image its margin holds nothing: NaN,
 * which filters leave out. */
static void take_row(void *data, uint32_t index)
{
    const take_job *job = data;
    const crv_gbuffer_desc *d = &job->plan->setup.desc;
    const int32_t y = job->to->y0 + (int32_t)index;
    float *row = crv__plane_at(job->to, job->to->x0, y);
    const int holds = y >= d->guard_top && y < d->guard_top + job->from->height;
    const int32_t left = holds ? d->guard_left - job->to->x0 : job->to->width;
    const int32_t count = holds ? job->from->width : 0;
    for (int32_t x = 0; x < left; x++)
        row[x] = NAN;
    const ptrdiff_t stride = job->from->pixel_stride / (ptrdiff_t)sizeof(float);
    const float *from =
        holds ? crv_const_image_at(job->from, 0, y - d->guard_top, 0) : NULL;
    for (int32_t x = 0; x < count; x++)
        row[left + x] = fabsf(from[x * stride]) < INFINITY ? from[x * stride] : 1;
    for (int32_t x = left + count; x < job->to->width; x++)
        row[x] = NAN;
}

crv_status crv_plan_filter(crv_plan *plan, crv_gbuffer *gbuffer,
                           const crv_const_image *input, const crv_image *result)
{
    if (!plan || !gbuffer)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_result wanted = only(result);
    crv__frame frame;
    crv_status status = begin(plan, gbuffer, &wanted, &frame);
    if (status == CRV_OK)
        status = crv__input_check(&plan->context->logger, "input", input, result->width,
                                  result->height, 1);
    if (status)
        return status;
    take_job job = {plan, input, &plan->pictures[0].accessibility};
    crv__run_rows(plan->context, job.to->height, take_row, &job);
    return finish(plan, &frame, true, &wanted);
}

crv_status crv_plan_device_times(const crv_plan *plan, crv_device_time *times,
                                 int32_t *count)
{
    if (!plan)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv__backend *backend = plan->context->backend;
    if (!times || !count)
        return crv__fail(&plan->context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "plan: times or count is NULL");
    if (!backend->times)
        return crv__fail(&plan->context->logger, CRV_ERROR_UNSUPPORTED,
                         "plan: %s has no clock of its own; time crv_plan_run()",
                         backend->name);
    return backend->times(&plan->setup, plan->state, times, count);
}
