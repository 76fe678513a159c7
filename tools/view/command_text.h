/* SPDX-License-Identifier: MIT */
/* command_text.h: the command of the tool that writes what a half shows. */
#ifndef VIEW_COMMAND_TEXT_H
#define VIEW_COMMAND_TEXT_H

#include "source.h"
#include "wish.h"

enum { COMMAND_SIZE = 4 * 4096 };

/* A line for a shell, several commands joined by &&: "crevice render ... -o ao.png". A
 * line that begins with # says why there is none. Returns out. */
const char *command_text(const source *s, const wish *w, int half,
                         char out[COMMAND_SIZE]);

#endif
