/* SPDX-License-Identifier: MIT */
/* estimate.h: context, G-buffer and plan, kept for as long as frames fit them. */
#ifndef TOOL_ESTIMATE_H
#define TOOL_ESTIMATE_H

#include "args.h"
#include "io.h"
#include "progress.h"

typedef struct estimator {
    crv_context *context;
    crv_gbuffer *gbuffer; /* NULL until the first upload */
    crv_plan *plan;
    crv_options options;
    crv_gbuffer_desc desc;
    progress run; /* the run of the plan on a GPU, which says how far it is */
} estimator;

/* e must not move afterwards: its context points to it. */
int estimate_open(estimator *e, const common_settings *common, report *r);

/* Makes room for a G-buffer of this description: an equal one keeps plan and G-buffer,
 * another drops both. Then e->gbuffer may be filled. */
void estimate_fit(estimator *e, const crv_gbuffer_desc *desc);

/* Makes the plan, unless there is one with these options already. */
int estimate_plan(estimator *e, const crv_options *options, report *r);

/* Gives *plan other options, or makes one if it cannot take them; NULL: none yet. taken:
 * its options so far. An error leaves both as they were; the context's log says what
 * failed, and also what a plan could not take. */
crv_status estimate_take(crv_context *context, const crv_gbuffer_desc *desc,
                         const crv_options *options, crv_plan **plan, crv_options *taken);

/* Whether they say the same in every option of the table. */
bool estimate_same_options(const crv_options *a, const crv_options *b);

/* Converted planar depth of layer 0 from e->gbuffer, of e->desc's size; background is
 * infinite. The caller frees it. Returns an exit code. */
int estimate_depth(estimator *e, float **out, report *r);

/* EXIT_DONE if the method reads the option of this key, else an error line that begins
 * with the flag and names the methods that do. */
int estimate_check_method(const char *flag, const char *key, const crv_method *method,
                          report *r);

/* Whether the options ask for a height field and nothing else. */
bool estimate_is_of_relief(const crv_options *options);

/* Runs the plan on e->gbuffer. *out gets the channel AO and, if the options want bent
 * normals, bent.X, bent.Y and bent.Z in view space; the caller frees it. */
int estimate_run(estimator *e, io_image *out, report *r);

void estimate_close(estimator *e);

#endif
