/* SPDX-License-Identifier: MIT */
/* launch.h: commands that are programs of their own. */
#ifndef TOOL_LAUNCH_H
#define TOOL_LAUNCH_H

#include "common/args.h"

/* Becomes c->program, which lies beside this program, in the build's folder of it, or on
 * the PATH. argv: what follows the command's name. Returns only if there is none: an exit
 * code, after a line that says how to get it. */
int launch(const command *c, int argc, char **argv, report *r);

#endif
