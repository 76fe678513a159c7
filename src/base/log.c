/* SPDX-License-Identifier: MIT */
#include "base/log.h"

#include "base/numbers.h"

#include <stdarg.h>

static void log_line(const crv_logger *logger, crv_log_level level, const char *format,
                     va_list arguments)
{
    if (!logger || !logger->fn)
        return;
    char line[512];
    crv__number_print(line, sizeof line, format, arguments);
    /* Words from outside: what they hold beyond ASCII may steer a terminal. */
    for (char *c = line; *c; c++)
        if (*c < 0x20 || *c > 0x7e)
            *c = '?';
    logger->fn(logger->user, level, line);
}

void crv__log(const crv_logger *logger, crv_log_level level, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_line(logger, level, format, arguments);
    va_end(arguments);
}

crv_status crv__fail(const crv_logger *logger, crv_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_line(logger, CRV_LOG_ERROR, format, arguments);
    va_end(arguments);
    return status;
}
