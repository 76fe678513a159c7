/* SPDX-License-Identifier: MIT */
/* shot.h: frames one after the other, of one shot. */
#ifndef TOOL_SHOT_H
#define TOOL_SHOT_H

#include "ao_settings.h"
#include "common/frames.h"
#include "passes/passes.h"
#include "views.h"

/*
 * Computes the frames; list NULL: the input is one frame. A frame that fails is told and
 * left out, and the others are computed. What the first frames decide (the radius, the
 * reading of the normals) holds for all. Returns an exit code: EXIT_FAILED if any failed.
 */
int shot_run(const ao_settings *settings, const io_passes_request *request,
             const frame_list *list, const view_list *views, report *r);

#endif
