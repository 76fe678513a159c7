/* SPDX-License-Identifier: MIT */
#ifndef CRV_BASE_LOG_H
#define CRV_BASE_LOG_H

#include "crevice/base.h"

#if defined(__MINGW32__)                                                                 \
    && !defined(__clang__) /* its own printf, which knows %zu, %td  \
                                                 */
#define CRV__PRINTF(f, a) __attribute__((format(gnu_printf, f, a)))
#elif defined(__GNUC__)
#define CRV__PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define CRV__PRINTF(f, a)
#endif

/* Formats one line and hands it to the logger; nothing where there is none. */
void crv__log(const crv_logger *logger, crv_log_level level, const char *format, ...)
    CRV__PRINTF(3, 4);

/* Logs the line as an error and returns the status: `return crv__fail(log, CRV_...,
 * "...")`. */
crv_status crv__fail(const crv_logger *logger, crv_status status, const char *format, ...)
    CRV__PRINTF(3, 4);

#endif
