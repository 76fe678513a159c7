/* SPDX-License-Identifier: MIT */
#include "frames.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static bool parse_frame(const char **text, int32_t *out)
{
    const char *p = *text;
    int32_t value = 0;
    if (!isdigit((unsigned char)*p))
        return false;
    for (; isdigit((unsigned char)*p); p++) {
        if (value > 99999999)
            return false;
        value = value * 10 + (*p - '0');
    }
    *out = value;
    *text = p;
    return true;
}

bool frames_parse(const char *text, frame_range *out)
{
    frame_range range = {.step = 1};
    if (!parse_frame(&text, &range.first))
        return false;
    range.last = range.first;
    if (*text == '-') {
        text++;
        if (!parse_frame(&text, &range.last))
            return false;
        if (*text == 'x') {
            text++;
            if (!parse_frame(&text, &range.step))
                return false;
        }
    }
    if (*text != '\0' || range.last < range.first || range.step < 1)
        return false;
    *out = range;
    return true;
}

/* The length of the place that begins here, 0 if none does; *width: its digits. */
static size_t place_at(const char *p, int *width)
{
    size_t length = strspn(p, "#");
    *width = (int)length;
    if (length > 0 || *p != '%')
        return length;
    length = 1;
    *width = 0;
    while (isdigit((unsigned char)p[length]) && length < 4) {
        *width = *width * 10 + (p[length] - '0');
        length++;
    }
    return p[length] == 'd' ? length + 1 : 0;
}

int32_t frames_places(const char *pattern)
{
    int32_t count = 0;
    int width;
    while (*pattern != '\0') {
        const size_t length = place_at(pattern, &width);
        count += length > 0;
        pattern += length > 0 ? length : 1;
    }
    return count;
}

bool frames_name(const char *pattern, int32_t frame, char *out, size_t size)
{
    size_t used = 0;
    while (*pattern != '\0') {
        int width;
        const size_t length = place_at(pattern, &width);
        const int written = length > 0
                                ? snprintf(out + used, size - used, "%0*d", width, frame)
                                : snprintf(out + used, size - used, "%c", *pattern);
        if (written < 0 || (size_t)written >= size - used)
            return false;
        used += (size_t)written;
        pattern += length > 0 ? length : 1;
    }
    return used < size;
}
