/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_PLAN_H
#define CRV_CORE_PLAN_H

#include "core/backend.h"
#include "crevice/context.h"

struct crv_plan {
    crv_context *context;
    crv__setup setup;
    void *state; /* the backend's */
    crv__params params;
    /* Of crv__setup_rectangle(); the second only with a filter. */
    crv__picture pictures[2];
};

/* Gives the plan other valid options, so that it is as if made with them; false, and the
 * plan stays as it is, if that takes other memory than what the plan has. */
bool crv__plan_update(crv_plan *plan, const crv_options *options);

#endif
