/* SPDX-License-Identifier: MIT */
/* made.h: how a result was made, as its metadata say, and what a shot takes up from
 * there. */
#ifndef TOOL_MADE_H
#define TOOL_MADE_H

#include "ao_settings.h"
#include "passes/passes.h"

/* What frames of a shot leave to those after them. A shot that goes on with results in
 * place of frames must know it. */
typedef struct made_state {
    bool has_radius; /* false: no frame has shown anything yet */
    float radius;    /* scene units */
    int reading;     /* io_passes_request.usual_reading */
    crv_depth_encoding encoding;
    const char *bent_space; /* of the bent normals, or NULL; not read back */
} made_state;

/* Whatever of the settings changes the result, so that two results can be told apart.
 * vfov_rad: the field of view of --vfov fit. cameras: the checksum of --camera's file. */
void made_describe(const ao_settings *s, const crv_options *options, float vfov_rad,
                   uint64_t cameras, char made[IO_MADE_SIZE]);

/* Adds the state after a frame. */
void made_add_state(char made[IO_MADE_SIZE], const made_state *state);

/* Whether a result was made with these settings; then *state is that after its frame. */
bool made_matches(const char *settings, const char *made, made_state *state);

/* What made a result; false if it is not whole. channel: its name in a copy of the frame,
 * NULL if it is a file of its own. */
bool made_read(const char *output, const char *channel, char made[IO_MADE_SIZE]);

/* The same without looking at the pixels; "" if it does not say. */
void made_glance(const char *output, const char *channel, char made[IO_MADE_SIZE]);

#endif
