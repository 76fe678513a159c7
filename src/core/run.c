/* SPDX-License-Identifier: MIT */
/* Runs of a plan: what goes in and comes out, and the device's times. */
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

/* Checks the arguments of a run and makes the frame. */
static crv_status begin(crv_plan *plan, crv_gbuffer *g, const crv_image *result,
                        crv__frame *frame)
{
    if (!plan || !g)
        return CRV_ERROR_INVALID_ARGUMENT;
    if (g->context != plan->context
        || !crv_gbuffer_desc_equal(&g->desc, &plan->setup.desc))
        return crv__fail(&plan->context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "plan: the G-buffer was made with another desc or context");
    const crv_gbuffer_desc *d = &plan->setup.desc;
    crv_status status = crv__output_check(&plan->context->logger, "result", result,
                                          d->width - d->guard_left - d->guard_right,
                                          d->height - d->guard_top - d->guard_bottom, 1);
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
    const crv__plane *from;
    const crv_image *to;
} copy_job;

static void copy_row(void *data, uint32_t index)
{
    const copy_job *job = data;
    const crv_gbuffer_desc *d = &job->plan->setup.desc;
    const int32_t y = (int32_t)index;
    const float *row = crv__plane_at(job->from, d->guard_left, d->guard_top + y);
    if (job->to->pixel_stride == sizeof(float)) {
        memcpy(crv_image_at(job->to, 0, y, 0), row,
               (size_t)job->to->width * sizeof(float));
        return;
    }
    for (int32_t x = 0; x < job->to->width; x++)
        *crv_image_at(job->to, x, y, 0) = row[x];
}

/* Runs the plan and copies the rectangle inside the guard band to the result. */
static crv_status finish(crv_plan *plan, const crv__frame *frame, int filter_only,
                         const crv_image *result)
{
    const crv__work work = {&plan->setup, plan->state, frame};
    copy_job job = {.plan = plan, .to = result};
    crv_status status =
        plan->context->backend->run(&work, filter_only, plan->planes, &job.from);
    if (status == CRV_OK)
        crv__run_rows(plan->context, result->height, copy_row, &job);
    return status;
}

crv_status crv_plan_run(crv_plan *plan, crv_gbuffer *gbuffer, const crv_image *result)
{
    crv__frame frame;
    crv_status status = begin(plan, gbuffer, result, &frame);
    return status ? status : finish(plan, &frame, 0, result);
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
    crv__frame frame;
    crv_status status = begin(plan, gbuffer, result, &frame);
    if (status == CRV_OK)
        status = crv__input_check(&plan->context->logger, "input", input, result->width,
                                  result->height, 1);
    if (status)
        return status;
    take_job job = {plan, input, &plan->planes[0]};
    crv__run_rows(plan->context, job.to->height, take_row, &job);
    return finish(plan, &frame, 1, result);
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
