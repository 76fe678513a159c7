/* SPDX-License-Identifier: MIT */
#include "text.h"

#include <fnmatch.h>
#include <stdint.h>
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

/* The length of the UTF-8 character that begins here and its code point; 0 if there is
 * none: overlong forms, surrogates, beyond U+10FFFF, cut off. (Unicode 15, table 3-7.) */
static size_t decode(const unsigned char *p, uint32_t *point)
{
    static const uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t length = p[0] < 0x80   ? 1
                          : p[0] < 0xc2 ? 0
                          : p[0] < 0xe0 ? 2
                          : p[0] < 0xf0 ? 3
                          : p[0] < 0xf5 ? 4
                                        : 0;
    if (length < 2) {
        *point = p[0];
        return length;
    }
    uint32_t value = p[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((p[i] & 0xc0u) != 0x80u)
            return 0;
        value = value << 6 | (p[i] & 0x3fu);
    }
    *point = value;
    const bool surrogate = value >= 0xd800 && value <= 0xdfff;
    return value < smallest[length] || surrogate || value > 0x10ffff ? 0 : length;
}

/* C0, DEL and C1; ends of lines and paragraphs; marks that turn the direction of text. */
static bool is_control(uint32_t point)
{
    return point < 0x20 || (point >= 0x7f && point <= 0x9f)
           || (point >= 0x200e && point <= 0x200f) || (point >= 0x2028 && point <= 0x202e)
           || (point >= 0x2066 && point <= 0x2069);
}

size_t text_character_length(const char *at)
{
    uint32_t point;
    return decode((const unsigned char *)at, &point);
}

void text_clean(char *text)
{
    char *to = text;
    for (const char *from = text; *from;) {
        uint32_t point = 0;
        const size_t length = decode((const unsigned char *)from, &point);
        const bool shown = length && !is_control(point);
        if (shown)
            memmove(to, from, length);
        else
            *to = '?';
        to += shown ? length : 1;
        from += length ? length : 1;
    }
    *to = '\0';
}
