/* SPDX-License-Identifier: MIT */
/* The short way: a context, a G-buffer and a plan for one picture. */
#include "crevice/ao.h"

#include "base/log.h"
#include "core/camera.h"
#include "core/options.h"
#include "core/registry.h"
#include "crevice/context.h"

#include <math.h>

crv_status crv_ao(const crv_const_image *depth, const crv_const_image *normals,
                  const crv_camera *camera, const crv_options *options,
                  const crv_image *result, const crv_logger *logger)
{
    if (!depth || !camera || !result)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "ao: depth, camera or result is NULL; give all three");
    crv_context_desc context_desc;
    crv_gbuffer_desc desc;
    crv_options defaults;
    crv_context_desc_init(&context_desc, sizeof context_desc);
    crv_gbuffer_desc_init(&desc, sizeof desc, depth->width, depth->height);
    crv_options_init(&defaults, sizeof defaults, NULL);
    if (logger)
        context_desc.logger = *logger;

    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    crv_status status = crv_context_create(&context_desc, &context);
    if (status == CRV_OK)
        status = crv_gbuffer_create(context, &desc, &gbuffer);
    if (status == CRV_OK)
        status = crv_plan_create(context, options ? options : &defaults, &desc, &plan);
    if (status == CRV_OK)
        status = crv_gbuffer_set_camera(gbuffer, camera);
    if (status == CRV_OK)
        status = crv_gbuffer_set_depth(gbuffer, 0, depth, NULL);
    if (status == CRV_OK)
        status = crv_gbuffer_set_normals(gbuffer, normals, CRV_NORMAL_VIEW);
    if (status == CRV_OK)
        status = crv_plan_run(plan, gbuffer, result);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
    return status;
}

int32_t crv_guard_px(const crv_options *options, const crv_camera *camera,
                     float nearest_depth)
{
    crv_options o;
    const bool perspective = camera && camera->projection == CRV_PERSPECTIVE;
    if (crv__options_take(NULL, options, &o) || crv__camera_check(NULL, camera)
        || (perspective && !(nearest_depth > 0)))
        return 0;
    const double focal_px = fmax((double)camera->fx_px, (double)camera->fy_px);
    double px = (double)o.radius * focal_px / (perspective ? (double)nearest_depth : 1.0);
    if (o.max_radius_px > 0
        && crv_option_applies(crv_option_find("max_radius_px"), o.method, NULL))
        px = fmin(px, (double)o.max_radius_px);
    if (o.filter)
        px += crv__filter_of(o.filter)->radius_px;
    return (int32_t)ceil(fmin(px, CRV_MAX_SIZE));
}
