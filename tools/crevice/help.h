/* SPDX-License-Identifier: MIT */
/* help.h: help, written from the tables that the arguments are parsed with. */
#ifndef TOOL_HELP_H
#define TOOL_HELP_H

#include <stdio.h>

#include "args.h"

/* All about one command. */
void help_command(FILE *out, const command *c);

/* What there is; commands NULL-terminated. */
void help_overview(FILE *out, const command *const *commands);

/* A line of the library's option table: flag, help, unit, range, default. */
void help_library_option(FILE *out, const crv_option *option);

/* "--max-radius-px" for "max_radius_px". */
void help_option_flag(const crv_option *option, char *out, size_t size);

/* The range or choices, and the default, as the user would write them. */
void help_option_values(const crv_option *option, char *out, size_t size);
void help_option_default(const crv_option *option, char *out, size_t size);

#endif
