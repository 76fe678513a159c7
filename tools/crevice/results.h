/* SPDX-License-Identifier: MIT */
/* results.h: what `crevice ao` writes for a frame. */
#ifndef TOOL_RESULTS_H
#define TOOL_RESULTS_H

#include "frame_copy.h"
#include "made.h"

/* Writes the results of a frame's views into one file. made: the settings, as
 * made_describe() says them; state: that after the frame. Returns an exit code. */
int results_write(const ao_settings *s, const char *input, const char *output,
                  ao_result *results, int32_t count, const char *made,
                  const made_state *state, report *r);

void results_free(ao_result *results, int32_t count);

#endif
