/* SPDX-License-Identifier: MIT */
/* ao_settings.h: what `crevice ao` was told. */
#ifndef TOOL_AO_SETTINGS_H
#define TOOL_AO_SETTINGS_H

#include "bent.h"
#include "common/frame_camera.h"
#include "common/pass_args.h"

typedef struct ao_settings {
    common_settings common;
    const char *input, *output, *frames;
    pass_settings passes;
    frame_camera_settings camera;
    arg_int layer_kind;
    arg_int radius_frame, jobs, aa;
    arg_int bits;
    bool half, skip_existing, crop;
    bool append, replace;
    const char *channel, *apply, *albedo, *views;
    const char *receive, *occlude; /* mattes, as io_matte_read() takes them */
    arg_vector tint;
    bent_settings bent;
    const char *bent_channel;
} ao_settings;

#endif
