/* SPDX-License-Identifier: MIT */
/* radius.h: a radius of influence for frames that come without one. */
#ifndef TOOL_RADIUS_H
#define TOOL_RADIUS_H

#include "estimate.h"
#include "passes/passes.h"

/* A twentieth of the height that the picture shows at the median depth, rounded to two
 * digits: the same share of the picture whatever the scene's units are. 0 if the frame
 * is empty. e->gbuffer must hold the frame. Returns an exit code. */
int radius_suggest(estimator *e, const io_frame *frame, float *out, report *r);

/* Warns of a given radius with which next to nothing can be darkened, or that is many
 * times as large as the view, as in scenes of another unit. Same needs. Returns an exit
 * code. */
int radius_check(estimator *e, const io_frame *frame, float radius, const char *input,
                 report *r);

#endif
