/* SPDX-License-Identifier: MIT */
/* frame_copy.h: results of `crevice ao` beside the channels of their frame. */
#ifndef TOOL_FRAME_COPY_H
#define TOOL_FRAME_COPY_H

#include "ao_settings.h"
#include "passes/passes.h"

/* Whether the output is a copy of the input: with --append or --apply. */
bool append_is_wanted(const ao_settings *s);

/* What is wrong with the settings, or NULL. */
const char *append_mistake(const ao_settings *s);

/* The name of the channel, and of the attribute with what made it. */
const char *append_channel(const ao_settings *s);

/* Whether the frame can take the channel, and has those to multiply; before the work.
 * Returns an exit code. */
int append_check(const ao_settings *s, const char *input, const io_frame *frame,
                 report *r);

/* Writes the copy with the result `ao`, whose `made` says how it was made. Returns an
 * exit code. */
int append_write(const ao_settings *s, const char *input, const char *output,
                 const io_frame *frame, const io_image *ao, report *r);

#endif
