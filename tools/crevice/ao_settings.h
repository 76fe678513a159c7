/* SPDX-License-Identifier: MIT */
/* ao_settings.h: what `crevice ao` was told. */
#ifndef TOOL_AO_SETTINGS_H
#define TOOL_AO_SETTINGS_H

#include "common/pass_args.h"

typedef struct ao_settings {
    common_settings common;
    const char *input, *output, *frames;
    pass_settings passes;
    const char *camera; /* file of cameras */
    arg_int camera_order;
    arg_int layer_kind;
    arg_number vfov_deg, hfov_deg, lens_mm, sensor_mm, ortho;
    arg_int radius_frame, jobs, aa;
    arg_int bits;
    bool half, skip_existing, crop;
    bool append, replace;
    const char *channel, *apply, *albedo, *views;
    const char *receive, *occlude; /* mattes, as io_matte_read() takes them */
    arg_vector tint;
} ao_settings;

#endif
