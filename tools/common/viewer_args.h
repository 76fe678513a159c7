/* SPDX-License-Identifier: MIT */
/* viewer_args.h: the arguments of `crevice view`, which is a program of its own, and of
 * others that take a mesh or a frame. */
#ifndef TOOL_VIEWER_ARGS_H
#define TOOL_VIEWER_ARGS_H

#include "frame_camera.h"
#include "pass_args.h"
#include "view.h"

typedef struct viewer_settings {
    view_settings view; /* its model may be a frame, too */
    const char *frames, *script;
    bool tune;
    pass_settings passes;       /* of frames */
    frame_camera_settings lens; /* of frames: what `view` has no member for */
} viewer_settings;

/* The tables of settings that begin with these. */
extern const arg_table viewer_passes, viewer_camera;

/* What is wrong with a mesh or a frame, and what to do; NULL: nothing. */
const char *viewer_mistake(const viewer_settings *s);

/* How frames are told their camera; the strings stay those of s. */
frame_camera_settings viewer_frame_camera(const viewer_settings *s);

/* Its `run` is NULL: see command.program. */
extern const command command_view;

#endif
