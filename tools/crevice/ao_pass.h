/* SPDX-License-Identifier: MIT */
/* ao_pass.h: ambient occlusion that a picture holds. */
#ifndef TOOL_AO_PASS_H
#define TOOL_AO_PASS_H

#include "common/report.h"
#include "io.h"

/* The channel to take of a probed picture: `wanted`, or NULL for what it has: its only
 * channel, its pass of ambient occlusion, its grey. cure: how to choose another, as
 * "--channel". NULL after an error line. */
const char *ao_pass_choose(const char *path, const io_image *probe, const char *wanted,
                           const char *cure, report *r);

#endif
