/* SPDX-License-Identifier: MIT */
/* Numbers as text, whatever locale the host has set: the decimal point is a point. */
#ifndef CRV_BASE_NUMBERS_H
#define CRV_BASE_NUMBERS_H

#include <stdarg.h>
#include <stddef.h>

/* The number that the whole text is, spaces around it aside, or NaN. Decimal or
 * hexadecimal; "inf" and "infinity". */
double crv__number_parse(const char *text);

/* vsnprintf() of the C locale. */
int crv__number_print(char *text, size_t size, const char *format, va_list arguments);

#endif
