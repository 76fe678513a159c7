/* SPDX-License-Identifier: MIT */
/* utf8.h: names of files and channels may hold any bytes; terminals and JSON may not. */
#ifndef TOOL_UTF8_H
#define TOOL_UTF8_H

#include <stddef.h>

/* What stands for bytes that are no character: U+FFFD. */
#define UTF8_REPLACEMENT "\xef\xbf\xbd"

/* The bytes of the character at `at`, 1 to 4; 0 if the bytes there are no UTF-8 (RFC
 * 3629: no overlong forms, surrogates, or code points beyond U+10FFFF). */
size_t utf8_length(const char *at);

/* The same, but 0 also for control characters: below U+0020, and U+007F to U+009F. */
size_t utf8_printable(const char *at);

#endif
