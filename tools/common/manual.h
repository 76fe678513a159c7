/* SPDX-License-Identifier: MIT */
/* manual.h: manual pages and shell completions, made from the tables of the arguments. */
#ifndef TOOL_MANUAL_H
#define TOOL_MANUAL_H

#include <stdio.h>

#include "args.h"

/* A manual page in roff's man macros: of a command, and of the tool. */
void manual_command(FILE *out, const command *c);
void manual_overview(FILE *out, const command *const *commands);

/* Completions for "bash", "zsh" or "fish"; false for another shell. commands
 * NULL-terminated. */
bool completion_write(FILE *out, const char *shell, const command *const *commands);

/* Writes crevice.1, crevice-COMMAND.1, crevice.bash, _crevice and crevice.fish into a
 * folder that is there. Returns an exit code. */
int manual_write_all(const char *folder, const command *const *commands, report *r);

#endif
