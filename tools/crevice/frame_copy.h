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

/* The result of one view of a frame. */
typedef struct ao_result {
    const char *view;              /* "" without --views */
    char channel[IO_NAME_SIZE];    /* the name of its channel in the copy */
    char bent_layer[IO_NAME_SIZE]; /* that of its bent normals */
    bent_space bent_space;
    const char *bent_output; /* their own picture, or "" */
    io_frame frame;
    io_image ao; /* its `made` says how it was made */
} ao_result;

/* Whether the frame can take the channels, and has those to multiply; before the work is
 * done. Returns an exit code. */
int append_check(const ao_settings *s, const char *input, const ao_result *results,
                 int32_t count, report *r);

/* Writes the copy with the results. Returns an exit code. */
int append_write(const ao_settings *s, const char *input, const char *output,
                 const ao_result *results, int32_t count, report *r);

#endif
