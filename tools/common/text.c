/* SPDX-License-Identifier: MIT */
#include "text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io.h"

/* Room for so many more bytes and the zero at the end. */
static bool reserve(text *t, size_t more)
{
    size_t wanted = t->length + more + 1, capacity = t->capacity;

    if (t->failed)
        return false;
    if (wanted <= capacity)
        return true;
    capacity = capacity < 256 ? 256 : capacity;
    while (capacity < wanted)
        capacity *= 2;
    char *data = realloc(t->data, capacity);
    if (!data) {
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

    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, arguments);
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
        const size_t length = io_character_length(words);
        const char *instead =
            length == 0 ? "\xef\xbf\xbd" : entity((unsigned char)*words);

        if (instead)
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
