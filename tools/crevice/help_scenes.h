/* SPDX-License-Identifier: MIT */
#ifndef TOOL_HELP_SCENES_H
#define TOOL_HELP_SCENES_H

#include <stdio.h>

/* Writes the list of built-in scenes and their parameters. */
void help_scenes(FILE *out);

#endif
