/* SPDX-License-Identifier: MIT */
#include "estimation.h"

#include "common/estimate.h"
#include "common/report.h"

void estimation_free(estimation *e)
{
    crv_plan_destroy(e->plan);
    pool_release(e->result);
    *e = (estimation){0};
}

void estimation_stale(estimation *e)
{
    e->fresh = false;
}

static crv_status make_plan(estimation *e, crv_context *context,
                            const crv_gbuffer_desc *desc, const crv_options *options)
{
    if (e->plan && !crv_gbuffer_desc_equal(&e->desc, desc)) {
        crv_plan_destroy(e->plan);
        e->plan = NULL;
    }
    if (!e->plan || !estimate_same_options(&e->options, options))
        e->fresh = false;
    e->desc = *desc;
    return estimate_take(context, desc, options, &e->plan, &e->options);
}

/* Whoever shows the result before keeps it. */
static crv_status make_room(estimation *e, pool *planes)
{
    const crv_gbuffer_desc *d = &e->desc;
    e->width = d->width - d->guard_left - d->guard_right;
    e->height = d->height - d->guard_top - d->guard_bottom;
    pool_release(e->result);
    e->result =
        pool_take(planes, (size_t)e->width * (size_t)e->height * sizeof *e->result);
    return e->result ? CRV_OK : CRV_ERROR_OUT_OF_MEMORY;
}

crv_status estimation_run(estimation *e, pool *planes, crv_context *context,
                          crv_gbuffer *gbuffer, const crv_gbuffer_desc *desc,
                          const crv_options *options)
{
    crv_status status = make_plan(e, context, desc, options);
    if (status != CRV_OK || e->fresh)
        return status;
    status = make_room(e, planes);
    if (status != CRV_OK)
        return status;
    const crv_image result = crv_image_packed(e->result, e->width, e->height, 1);
    const double start = report_seconds();
    status = crv_plan_run(e->plan, gbuffer, &result);
    e->time_ms = 1e3 * (report_seconds() - start);
    e->fresh = status == CRV_OK;
    return status;
}
