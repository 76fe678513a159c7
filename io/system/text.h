/* SPDX-License-Identifier: MIT */
/* text.h: names compared without regard to the case of ASCII letters, in every locale. */
#ifndef CREVICE_SYSTEM_TEXT_H
#define CREVICE_SYSTEM_TEXT_H

#include <stdbool.h>
#include <stddef.h>

bool text_is_same(const char *a, const char *b);
/* Of the first `length` characters, or up to the end of both. */
bool text_is_same_start(const char *a, const char *b, size_t length);
/* Whether `text` ends with `end`, as a path does with ".exr". */
bool text_ends_with(const char *text, const char *end);

/* Whether a pattern with the wildcards *, ? and [...] fits; case counts. */
bool text_fits(const char *text, const char *pattern);

/* How many letters to put in, leave out or exchange make one text of the other, up to 255
 * bytes of each (Levenshtein 1966). */
size_t text_distance(const char *a, const char *b);

/* A copy that the caller frees; NULL: no memory. */
char *text_copy(const char *text);

#endif
