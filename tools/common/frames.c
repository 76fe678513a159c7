/* SPDX-License-Identifier: MIT */
#include "frames.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { LARGEST = 99999999 };

static bool parse_frame(const char **text, int32_t *out)
{
    const char *p = *text;
    const bool negative = *p == '-';
    int32_t value = 0;
    p += negative;
    if (!isdigit((unsigned char)*p))
        return false;
    for (; isdigit((unsigned char)*p); p++) {
        if (value > LARGEST)
            return false;
        value = value * 10 + (*p - '0');
    }
    *out = negative ? -value : value;
    *text = p;
    return true;
}

static bool parse_range(const char **text, frame_range *out)
{
    frame_range range = {.step = 1};
    if (!parse_frame(text, &range.first))
        return false;
    range.last = range.first;
    if (**text == '-') {
        ++*text;
        if (!parse_frame(text, &range.last))
            return false;
        if (**text == 'x') {
            ++*text;
            if (!parse_frame(text, &range.step))
                return false;
        }
    }
    *out = range;
    return range.last >= range.first && range.step >= 1;
}

bool frames_parse(const char *text, frame_list *out)
{
    frame_list list = {0};
    do {
        if (list.ranges == FRAMES_MAX_RANGES
            || !parse_range(&text, &list.range[list.ranges]))
            return false;
        list.ranges++;
    } while (*text == ',' && *++text);
    if (*text != '\0' || text[-1] == ',')
        return false;
    *out = list;
    return true;
}

static int32_t count_of(const frame_range *range)
{
    return (range->last - range->first) / range->step + 1;
}

int32_t frames_count(const frame_list *list)
{
    int32_t count = 0;
    for (int32_t i = 0; i < list->ranges; i++)
        count += count_of(&list->range[i]);
    return count;
}

int32_t frames_at(const frame_list *list, int32_t index)
{
    int32_t i = 0;
    while (i + 1 < list->ranges && index >= count_of(&list->range[i]))
        index -= count_of(&list->range[i++]);
    return list->range[i].first + index * list->range[i].step;
}

/* Up to three digits; *width is 0 if there are none. */
static size_t digits_at(const char *p, int *width)
{
    size_t length = 0;
    *width = 0;
    while (isdigit((unsigned char)p[length]) && length < 3)
        *width = *width * 10 + (p[length++] - '0');
    return length;
}

/* The length of the place that begins here, 0 if none does; *width: its digits. */
static size_t place_at(const char *p, int *width)
{
    static const char word[] = "<frame>";
    if (*p == '#' || *p == '@') {
        const size_t length = strspn(p, *p == '#' ? "#" : "@");
        *width = (int)length;
        return length;
    }
    if (*p == '%') {
        const size_t length = 1 + digits_at(p + 1, width);
        return p[length] == 'd' ? length + 1 : 0;
    }
    if (p[0] == '$' && p[1] == 'F')
        return 2 + digits_at(p + 2, width);
    *width = 0;
    return !strncmp(p, word, sizeof word - 1) ? sizeof word - 1 : 0;
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
