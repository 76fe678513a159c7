/* SPDX-License-Identifier: MIT */
#include "estimation.h"

#include <stdlib.h>

#include "common/estimate.h"
#include "common/report.h"

void estimation_free(estimation *e)
{
    crv_plan_destroy(e->plan);
    free(e->result);
    *e = (estimation){0};
}

void estimation_stale(estimation *e)
{
    e->fresh = false;
}

static crv_status make_plan(estimation *e, crv_context *context,
                            const crv_gbuffer_desc *desc, const crv_options *options)
{
    const bool fits = e->plan && crv_gbuffer_desc_equal(&e->desc, desc);
    if (fits && estimate_same_options(&e->options, options))
        return CRV_OK;
    e->fresh = false;
    if (fits && crv_plan_set_options(e->plan, options) == CRV_OK) {
        e->options = *options;
        return CRV_OK;
    }
    crv_plan *plan = NULL;
    const crv_status status = crv_plan_create(context, options, desc, &plan);
    if (status != CRV_OK)
        return status;
    crv_plan_destroy(e->plan);
    e->plan = plan;
    e->options = *options;
    e->desc = *desc;
    return CRV_OK;
}

static crv_status make_room(estimation *e)
{
    const crv_gbuffer_desc *d = &e->desc;
    const int32_t width = d->width - d->guard_left - d->guard_right;
    const int32_t height = d->height - d->guard_top - d->guard_bottom;
    if (e->result && e->width == width && e->height == height)
        return CRV_OK;
    free(e->result);
    e->fresh = false;
    e->result = malloc((size_t)width * (size_t)height * sizeof *e->result);
    e->width = width;
    e->height = height;
    return e->result ? CRV_OK : CRV_ERROR_OUT_OF_MEMORY;
}

crv_status estimation_run(estimation *e, crv_context *context, crv_gbuffer *gbuffer,
                          const crv_gbuffer_desc *desc, const crv_options *options)
{
    crv_status status = make_plan(e, context, desc, options);
    if (status == CRV_OK)
        status = make_room(e);
    if (status != CRV_OK || e->fresh)
        return status;
    const crv_image result = crv_image_packed(e->result, e->width, e->height, 1);
    const double start = report_seconds();
    status = crv_plan_run(e->plan, gbuffer, &result);
    e->time_ms = 1e3 * (report_seconds() - start);
    e->fresh = status == CRV_OK;
    return status;
}
