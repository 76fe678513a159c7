/* SPDX-License-Identifier: MIT */
/* text.h: names compared without regard to the case of ASCII letters, in every locale;
 * texts from outside, made fit to be shown. */
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

/* Replaces what must not reach a terminal or a log in a text from outside by '?': control
 * characters, those of UTF-8 and those that turn the direction of text included, and
 * bytes that are no UTF-8. */
void text_clean(char *text);

/* The bytes of the UTF-8 character at `at`; 0 if there is none. */
size_t text_character_length(const char *at);

/* A copy that the caller frees; NULL: no memory. */
char *text_copy(const char *text);

#endif
