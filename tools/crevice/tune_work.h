/* SPDX-License-Identifier: MIT */
/* tune_work.h: what `crevice tune` was told, and the views that it makes of it. */
#ifndef TOOL_TUNE_WORK_H
#define TOOL_TUNE_WORK_H

#include "common/estimate.h"
#include "common/tune.h"
#include "common/viewer_args.h"

typedef struct tune_settings {
    viewer_settings in; /* without frames and script */
    const char *fit;
    arg_number time_s;
    arg_int evaluations, rays;
    const char *truth; /* FILE[:CHANNEL] of a frame */
    arg_number truth_radius;
    arg_int truth_weighting, truth_falloff;
    const char *check, *check_truth; /* another frame */
    arg_number check_orbit_deg;
    arg_vector check_eye;
} tune_settings;

enum { TUNE_FITTED, TUNE_OTHER, TUNE_VIEWS };

typedef struct tune_work {
    const tune_settings *s;
    report *r;
    estimator e;  /* its context */
    progress run; /* of a run of it */
    crv_options start;
    scene *model; /* of meshes */
    scene_gbuffer cast[TUNE_VIEWS];
    crv_gbuffer *gbuffer[TUNE_VIEWS];
    tune_view view[TUNE_VIEWS];
    double truth_share; /* of the time, that each truth gets at most */
    double truth_s;     /* what the fitted view's took, seconds */
} tune_work;

/* Whether an interrupt waits, for tune_trace.stop and tune_request.stop. */
bool tune_work_stop(void *user);

/* tune_mesh.c: the view and another, with their truths. The first chooses the radius, if
 * none was given. Returns an exit code; *shows: whether there is anything to compare. */
int tune_mesh_load(tune_work *w);
int tune_mesh_other(tune_work *w, bool *shows);

/* tune_frame.c: the same of frames. */
int tune_frame_load(tune_work *w);
int tune_frame_other(tune_work *w, bool *shows);

/* tune_print.c: rows of a view's errors, and the file of options if one was asked for. */
void tune_print_pair(const tune_work *w, int index, const tune_error *before,
                     const tune_error *after);
int tune_write_options(const tune_work *w, const tune_result *found);

#endif
