/* SPDX-License-Identifier: MIT */
/* text.h: text that grows in a buffer. */
#ifndef TOOL_TEXT_H
#define TOOL_TEXT_H

#include <stddef.h>

#ifdef __GNUC__
#define TEXT_PRINTF __attribute__((format(printf, 3, 4)))
#else
#define TEXT_PRINTF
#endif

/* printf to the end of the text in out, whose buffer has `size` bytes; what does not fit
 * is cut off. */
void append_to(char *out, size_t size, const char *format, ...) TEXT_PRINTF;

#endif
