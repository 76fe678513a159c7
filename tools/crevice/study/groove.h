/* SPDX-License-Identifier: MIT */
/*
 * groove.h: estimates in the groove of closed_forms.h: a strip of its floor from 0.1 to 1
 * radius off the wall, the radius being 1, in buffers that reach a radius farther on
 * every side.
 */
#ifndef TOOL_STUDY_GROOVE_H
#define TOOL_STUDY_GROOVE_H

#include "study.h"

/* Depth of the edge. */
#define GROOVE_DEPTH 10.0

#define GROOVE_ROWS 4

typedef struct groove {
    int32_t columns;      /* of the strip, GROOVE_ROWS high */
    double *c;            /* distance of each column from the wall, radii; owned */
    double *x;            /* and from the edge, along the picture */
    float *accessibility; /* columns * GROOVE_ROWS: the last estimate; owned */
    crv_gbuffer_desc desc;
    crv_context *context;
    crv_gbuffer *gbuffer;
} groove;

/* px_per_radius: 16 or more. Close it, also after a failure. Returns an exit code. */
int groove_open(study *s, int32_t px_per_radius, groove *out);
void groove_close(groove *g);

/* Estimates the strip; the options' radius is taken as 1. Returns an exit code. */
int groove_run(study *s, groove *g, const crv_options *options);

#endif
