/* SPDX-License-Identifier: MIT */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L /* newlocale(), uselocale() */
#endif
#include "base/numbers.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__APPLE__)
#include <xlocale.h>
#endif

/* The C locale for this thread alone, and what it had before. */
#if defined(_WIN32)
typedef struct locale_scope {
    int per_thread;
    char before[128];
} locale_scope;

static void enter(locale_scope *scope)
{
    scope->per_thread = _configthreadlocale(_ENABLE_PER_THREAD_LOCALE);
    const char *before = setlocale(LC_NUMERIC, NULL);
    scope->before[0] = 0;
    if (before && strlen(before) < sizeof scope->before)
        strcpy(scope->before, before);
    setlocale(LC_NUMERIC, "C");
}

static void leave(locale_scope *scope)
{
    if (scope->before[0])
        setlocale(LC_NUMERIC, scope->before);
    _configthreadlocale(scope->per_thread);
}
#else
typedef struct locale_scope {
    locale_t own, before;
} locale_scope;

static void enter(locale_scope *scope)
{
    scope->own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    scope->before = scope->own ? uselocale(scope->own) : (locale_t)0;
}

static void leave(locale_scope *scope)
{
    if (!scope->own)
        return;
    uselocale(scope->before);
    freelocale(scope->own);
}
#endif

double crv__number_parse(const char *text)
{
    locale_scope scope;
    enter(&scope);
    char *end = NULL;
    const double value = strtod(text, &end);
    leave(&scope);
    const char *rest = end + strspn(end, " \t\n\v\f\r");
    return end == text || *rest ? (double)NAN : value;
}

int crv__number_print(char *text, size_t size, const char *format, va_list arguments)
{
    locale_scope scope;
    enter(&scope);
    const int length = vsnprintf(text, size, format, arguments);
    leave(&scope);
    return length;
}
