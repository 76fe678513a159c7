/* SPDX-License-Identifier: MIT */
/* tune_view.h: what a method is given, and what it should make of it. */
#ifndef TOOL_TUNE_VIEW_H
#define TOOL_TUNE_VIEW_H

#include "crevice/crevice.h"
#include "reference.h"

/* Pixels that a traced truth has at most: they tell the error of the whole picture. */
enum { TUNE_PIXELS = 32768 };

typedef struct tune_view {
    crv_context *context; /* not owned, as the G-buffer, which is filled */
    crv_gbuffer *gbuffer;
    crv_gbuffer_desc desc;
    int32_t width, height; /* of the result */
    int32_t count;         /* pixels that are compared: surfaces */
    int32_t *pixel;        /* their places in the result, row by row; owned */
    float *truth;          /* of each; owned */
    int32_t rays;          /* of each, if they were traced */
    double noise;          /* mean square of what the truth is off; 0: not known */
    crv_plan *plan;        /* of the last options; owned, as the result */
    crv_options options;
    float *result;
} tune_view;

/* Lists the surfaces, if they are more than `most` (0: no limit) those on a grid. depth:
 * a plane of the description's size, background infinite. Free it in any case. False: no
 * memory. */
bool tune_view_open(tune_view *v, crv_context *context, crv_gbuffer *gbuffer,
                    const crv_gbuffer_desc *desc, const float *depth, int32_t most);
void tune_view_free(tune_view *v);

/* The truth from a plane of the result's size. */
void tune_view_take(tune_view *v, const float *truth);

/* How a truth is traced. */
typedef struct tune_trace {
    const scene *model;       /* NULL: what the buffers hold is traced */
    const scene_gbuffer *g;   /* those of the view */
    reference_options target; /* rays and seed are of no account */
    int32_t threads;          /* 0: all */
    int32_t rays;             /* for each pixel; 0: as many as the time allows */
    double seconds;
    bool (*stop)(void *user); /* asked now and then: true gives it up. NULL: never */
    void (*watch)(void *user, double share); /* told of the work done. NULL: nobody */
    void *user;
} tune_trace;

/* Traces the truth in passes of a few rays, two at least, whose spread tells the noise.
 * Returns 0, or -1 after an error line or because it was given up. */
int tune_view_trace(tune_view *v, const tune_trace *t, const crv_logger *log);

/* Whether no surface is as dark as one step of an 8-bit picture: a truth that tells
 * nothing. */
bool tune_view_is_open(const tune_view *v);

/* How far the result of some options is from the truth, over the listed pixels. */
typedef struct tune_error {
    double rmse;        /* without what the truth's noise adds */
    double bias;        /* mean of result minus truth */
    double mean_square; /* as it is measured, with the noise */
    double correlation; /* of both; NAN if one of them is constant */
} tune_error;

/* Runs the method into v->result. */
crv_status tune_view_run(tune_view *v, const crv_options *options);

/* The same, and how far that is from the truth. */
crv_status tune_view_measure(tune_view *v, const crv_options *options, tune_error *out);

#endif
