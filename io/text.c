/* SPDX-License-Identifier: MIT */
/* text.c: names and metadata from outside, made fit to be shown. */
#include <string.h>

#include "internal.h"

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

size_t io_character_length(const char *at)
{
    uint32_t point;
    return decode((const unsigned char *)at, &point);
}

void io_clean_text(char *text)
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
