/* SPDX-License-Identifier: MIT */
/* claims_horizon.h: what the sections on the two horizon papers share. Functions return
 * an exit code unless they say otherwise. */
#ifndef TOOL_STUDY_CLAIMS_HORIZON_H
#define TOOL_STUDY_CLAIMS_HORIZON_H

#include "claims_measure.h"

/* What a section measures on, and the part of the picture that it shows. */
typedef struct horizon_study {
    study *s;
    study_view *v;
    crv_options paper;  /* of the method, unfiltered */
    const float *truth; /* ray traced, of the method's own target; the view's */
    cJSON *json;
    int32_t x, y, width, height; /* shown: where the ray-traced picture varies most */
} horizon_study;

/* The main view with the method's preset `paper`; the results' member `section`. */
int horizon_open(study *s, const char *method, const char *section, horizon_study *out);

/* Runs unfiltered or as the options say. picture: NULL, or who frees it. out: against the
 * ray-traced picture; may be NULL. */
int horizon_run(const horizon_study *h, const crv_options *options, study_buffers buffers,
                metrics *out, float **picture);

/* The mean of so many pictures, each with another draw of the noise: without noise, but
 * with all else that these options miss. */
int horizon_mean(const horizon_study *h, const crv_options *options, int32_t draws,
                 float *mean);

/* Shows the part of a picture, or of its error map. */
int horizon_show(const horizon_study *h, const char *name, const float *picture,
                 const char *caption);
int horizon_show_error(const horizon_study *h, const char *name, const float *picture,
                       const float *truth, const char *caption);

/* The means over the surface of what a picture is too dark and too bright by. */
void horizon_sides(const study_view *v, const float *picture, const float *truth,
                   double *too_dark, double *too_bright);

/* Adds a number; false after an error line. */
bool horizon_number(const horizon_study *h, cJSON *to, const char *name, double value);

/* The parts of the section on the paper of 2008a. */
int hsao_convergence(const horizon_study *h);
int hsao_cost(const horizon_study *h);
int hsao_radius(const horizon_study *h);
int hsao_numbers(const horizon_study *h);
int hsao_sets(const horizon_study *h);
int hsao_limits(const horizon_study *h);

/* Further depth layers and the growing sphere: a table, and what the growing sphere
 * (methods that have it) and a second layer change. paper: of the claim. */
int horizon_layers(const horizon_study *h, const crv_options *options, const char *paper,
                   const char *statement);

#endif
