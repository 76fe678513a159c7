/* SPDX-License-Identifier: MIT */
/* masks.h: --receive and --occlude of `crevice ao`. */
#ifndef TOOL_MASKS_H
#define TOOL_MASKS_H

#include "ao_settings.h"
#include "passes/passes.h"

/* Takes what does not occlude out of the frame: it becomes background. Returns an exit
 * code. */
int masks_take_out(const ao_settings *s, const char *input, io_frame *frame, report *r);

/* Opens what does not receive, and turns its bent normals to the normals that the
 * G-buffer holds; partly covered pixels in part. Returns an exit code. */
int masks_open(const ao_settings *s, const char *input, const io_frame *frame,
               crv_gbuffer *gbuffer, io_image *ao, report *r);

#endif
