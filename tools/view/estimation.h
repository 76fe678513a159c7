/* SPDX-License-Identifier: MIT */
/* estimation.h: a plan, kept from one set of options to the next, and its result. */
#ifndef VIEW_ESTIMATION_H
#define VIEW_ESTIMATION_H

#include "crevice/crevice.h"

#include <stdbool.h>

#include "pool.h"

typedef struct estimation {
    crv_plan *plan;
    crv_options options;
    crv_gbuffer_desc desc;
    bool fresh;    /* the result is that of the options and the G-buffer as it is */
    float *result; /* held */
    int32_t width, height; /* of the result */
    double time_ms;        /* of the last run */
} estimation;

void estimation_free(estimation *e);

/* The G-buffer has changed. */
void estimation_stale(estimation *e);

/* Runs the options unless the result is fresh. New options cost no more than the run as
 * long as they fit into the memory that the plan has. The context's log says what failed.
 */
crv_status estimation_run(estimation *e, pool *planes, crv_context *context,
                          crv_gbuffer *gbuffer, const crv_gbuffer_desc *desc,
                          const crv_options *options);

#endif
