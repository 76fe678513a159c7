/* SPDX-License-Identifier: MIT */
/* A plan's life: one method, one filter, one size; all memory taken ahead. */
#include "core/plan.h"

#include "core/gbuffer.h"
#include "core/options.h"

static bool create_pictures(crv_plan *plan)
{
    const crv_allocator *allocator = &plan->context->allocator;
    const crv__rectangle r = crv__setup_rectangle(&plan->setup);
    for (int i = 0; i < (plan->setup.filter ? 2 : 1); i++) {
        crv__picture *picture = &plan->pictures[i];
        if (crv__plane_create(&picture->accessibility, allocator, r.x, r.y, r.width,
                              r.height))
            return false;
        for (int k = 0; k < (plan->setup.has_bent ? 3 : 0); k++) {
            if (crv__plane_create(&picture->bent[k], allocator, r.x, r.y, r.width,
                                  r.height))
                return false;
        }
    }
    return true;
}

static void destroy_pictures(crv_plan *plan)
{
    const crv_allocator *allocator = &plan->context->allocator;
    for (int i = 0; i < 2; i++) {
        crv__plane_destroy(&plan->pictures[i].accessibility, allocator);
        for (int k = 0; k < 3; k++)
            crv__plane_destroy(&plan->pictures[i].bent[k], allocator);
    }
}

/* Methods that ask what is inside see nothing of a further surface unless they know or
 * assume where the one before it ends. */
static void warn_of_layers(const crv_logger *logger, const crv_options *options,
                           const crv_gbuffer_desc *desc)
{
    const bool bounded =
        options->thickness > 0
        && crv_option_applies(crv_option_find("thickness"), options->method, NULL);
    if (crv__method_of(options->method)->volumetric && !bounded && desc->layers > 1
        && desc->layer_kind == CRV_LAYERS_SURFACES)
        crv__log(logger, CRV_LOG_WARNING,
                 "layers: %s uses further layers only as pairs of front and back "
                 "(CRV_LAYERS_SOLID); it sees the first",
                 options->method->name);
}

crv_status crv_plan_create(crv_context *context, const crv_options *options,
                           const crv_gbuffer_desc *desc, crv_plan **out)
{
    if (!context)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_logger *logger = &context->logger;
    if (!out)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT, "plan: out is NULL");
    crv__setup setup;
    crv_status status = crv__setup_take(context, options, desc, &setup);
    if (status)
        return status;
    warn_of_layers(logger, &setup.options, &setup.desc);
    crv_plan *plan = crv__allocate(&context->allocator, 1, sizeof *plan);
    if (plan) {
        plan->context = context;
        context->children++;
        plan->setup = setup;
        crv__setup_params(&plan->setup, &plan->params);
        if (crv__setup_patterns(&plan->setup) == CRV_OK && create_pictures(plan)) {
            status = context->backend->plan_create(
                &plan->setup, &plan->pictures[0].accessibility, &plan->state);
            if (status == CRV_OK)
                *out = plan;
            else
                crv_plan_destroy(plan);
            return status;
        }
        crv_plan_destroy(plan);
    }
    return crv__fail(logger, CRV_ERROR_OUT_OF_MEMORY, "plan: no memory for %d x %d",
                     setup.desc.width, setup.desc.height);
}

void crv_plan_destroy(crv_plan *plan)
{
    if (!plan)
        return;
    const crv_allocator *allocator = &plan->context->allocator;
    crv__setup *s = &plan->setup;
    if (plan->state)
        plan->context->backend->plan_destroy(s, plan->state);
    destroy_pictures(plan);
    crv__setup_release(s);
    plan->context->children--;
    crv__release(allocator, plan, 1, sizeof *plan);
}

bool crv__plan_update(crv_plan *plan, const crv_options *options)
{
    const crv__backend *backend = plan->context->backend;
    crv__setup next = plan->setup;
    if (!crv__setup_revise(&next, options) || !backend->plan_update
        || !backend->plan_update(&next, plan->state))
        return false;
    plan->setup = next;
    crv__setup_fill(&plan->setup);
    crv__setup_params(&plan->setup, &plan->params);
    return true;
}

crv_status crv_plan_set_options(crv_plan *plan, const crv_options *options)
{
    if (!plan)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_logger *logger = &plan->context->logger;
    crv_options full;
    const crv_status status = crv__options_take(logger, options, &full);
    if (status)
        return status;
    const char *obstacle = crv__setup_obstacle(&plan->setup, &full);
    if (obstacle)
        return crv__fail(logger, CRV_ERROR_UNSUPPORTED,
                         "plan: %s needs memory that this plan does not have; make a new "
                         "plan with these options",
                         obstacle);
    if (!crv__plan_update(plan, &full))
        return crv__fail(logger, CRV_ERROR_UNSUPPORTED,
                         "plan: directions, steps, samples or another option that is "
                         "fixed on %s cannot change; make a new plan with these options",
                         plan->context->backend->name);
    return CRV_OK;
}
