/* SPDX-License-Identifier: MIT */
/* text.h: text that grows. Out of memory is remembered in `failed`, and all that follows
 * does nothing. */
#ifndef TOOL_STUDY_TEXT_H
#define TOOL_STUDY_TEXT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#if defined(__GNUC__)
#define TEXT_PRINTF(format_, rest) __attribute__((format(printf, format_, rest)))
#else
#define TEXT_PRINTF(format_, rest)
#endif

typedef struct text {
    char *data; /* NULL as long as it is empty */
    size_t length, capacity;
    bool failed;
} text;

void text_add(text *t, const char *words);
void text_addf(text *t, const char *format, ...) TEXT_PRINTF(2, 3);
void text_vaddf(text *t, const char *format, va_list arguments);

/* For HTML, attributes included: < > & " ' become entities; bytes that are not UTF-8 and
 * control characters that HTML does not allow become U+FFFD. */
void text_add_escaped(text *t, const char *words);

/* Frees and zeroes. */
void text_free(text *t);

#endif
