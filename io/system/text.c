/* SPDX-License-Identifier: MIT */
#include "text.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 255 };

static char folded(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

bool text_is_same_start(const char *a, const char *b, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if (folded(a[i]) != folded(b[i]))
            return false;
        if (!a[i])
            return true;
    }
    return true;
}

bool text_is_same(const char *a, const char *b)
{
    return text_is_same_start(a, b, strlen(a) + 1);
}

bool text_ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), size = strlen(end);
    return length >= size && text_is_same(text + length - size, end);
}

bool text_fits(const char *text, const char *pattern)
{
    return fnmatch(pattern, text, FNM_NOESCAPE) == 0;
}

static size_t clipped_length(const char *text)
{
    const size_t length = strlen(text);
    return length < LONGEST ? length : LONGEST;
}

size_t text_distance(const char *a, const char *b)
{
    size_t row[LONGEST + 1];
    const size_t length_a = clipped_length(a), length_b = clipped_length(b);
    for (size_t j = 0; j <= length_b; j++)
        row[j] = j;
    for (size_t i = 1; i <= length_a; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= length_b; j++) {
            size_t best = diagonal + (folded(a[i - 1]) != folded(b[j - 1]));
            if (row[j] + 1 < best)
                best = row[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            diagonal = row[j];
            row[j] = best;
        }
    }
    return row[length_b];
}

char *text_copy(const char *text)
{
    const size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}
