/* SPDX-License-Identifier: MIT */
#include "text.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Room for so many more bytes and the zero at the end. */
static bool reserve(text *t, size_t more)
{
    size_t wanted = t->length + more + 1, capacity = t->capacity;
    char *data;

    if (t->failed)
        return false;
    if (wanted <= capacity)
        return true;
    capacity = capacity < 256 ? 256 : capacity;
    while (capacity < wanted)
        capacity *= 2;
    data = realloc(t->data, capacity);
    if (data == NULL) {
        t->failed = true;
        return false;
    }
    t->data = data;
    t->capacity = capacity;
    return true;
}

static void add_bytes(text *t, const char *bytes, size_t count)
{
    if (!reserve(t, count))
        return;
    memcpy(t->data + t->length, bytes, count);
    t->length += count;
    t->data[t->length] = '\0';
}

void text_add(text *t, const char *words)
{
    add_bytes(t, words, strlen(words));
}

void text_vaddf(text *t, const char *format, va_list arguments)
{
    va_list again;
    int length;

    va_copy(again, arguments);
    length = vsnprintf(NULL, 0, format, arguments);
    if (length < 0)
        t->failed = true;
    else if (reserve(t, (size_t)length)) {
        vsnprintf(t->data + t->length, (size_t)length + 1, format, again);
        t->length += (size_t)length;
    }
    va_end(again);
}

void text_addf(text *t, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    text_vaddf(t, format, arguments);
    va_end(arguments);
}

/* The bytes of the UTF-8 character at `at`; 0 where there is none (RFC 3629: neither
 * overlong forms nor surrogates nor beyond U+10FFFF). */
static size_t character_length(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;
    size_t length = b[0] < 0x80 ? 1 : b[0] < 0xe0 ? 2 : b[0] < 0xf0 ? 3 : 4;
    unsigned char low = 0x80, high = 0xbf;

    if (length == 1)
        return 1;
    if (b[0] < 0xc2 || b[0] > 0xf4)
        return 0;
    low = b[0] == 0xe0 ? 0xa0 : b[0] == 0xf0 ? 0x90 : low;
    high = b[0] == 0xed ? 0x9f : b[0] == 0xf4 ? 0x8f : high;
    if (b[1] < low || b[1] > high)
        return 0;
    for (size_t i = 2; i < length; i++)
        if (b[i] < 0x80 || b[i] > 0xbf)
            return 0;
    return length;
}

static const char *entity(unsigned char c)
{
    switch (c) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return (c < 0x20 && c != '\t' && c != '\n') || c == 0x7f ? "\xef\xbf\xbd" : NULL;
    }
}

void text_add_escaped(text *t, const char *words)
{
    while (*words != '\0') {
        size_t length = character_length(words);
        const char *instead =
            length == 0 ? "\xef\xbf\xbd" : entity((unsigned char)*words);

        if (instead != NULL)
            text_add(t, instead);
        else
            add_bytes(t, words, length);
        words += length > 0 ? length : 1;
    }
}

void text_free(text *t)
{
    free(t->data);
    *t = (text){0};
}
