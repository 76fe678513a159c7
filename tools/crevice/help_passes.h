/* SPDX-License-Identifier: MIT */
#ifndef TOOL_HELP_PASSES_H
#define TOOL_HELP_PASSES_H

#include <stdio.h>

/* Writes the table of renderers' passes. */
void help_passes(FILE *out);

#endif
