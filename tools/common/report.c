/* SPDX-License-Identifier: MIT */
#include "report.h"

#include <stdarg.h>
#include <stdio.h>

#include "io.h"
#include "system/clock.h"
#include "system/text.h"

enum { LINE_SIZE = 8192 };

/* One call, one line: neither a line break in a file's name may make two of it, nor any
 * control character or stray byte reach the terminal. */
static void write_line(const char *prefix, const char *line)
{
    char clean[LINE_SIZE];
    snprintf(clean, sizeof clean, "%s", line);
    text_clean(clean);
    fprintf(stderr, "%s%s\n", prefix, clean);
}

static void on_log(void *user, crv_log_level level, const char *line)
{
    report *r = user;
    if (level == CRV_LOG_ERROR) {
        r->errors++;
        write_line("crevice: ", line);
    } else if (level == CRV_LOG_WARNING) {
        write_line("crevice: warning: ", line);
    } else if (!r->quiet && (!r->brief || r->verbose)) {
        write_line("", line);
    }
}

static void on_log_errors_only(void *user, crv_log_level level, const char *line)
{
    if (level == CRV_LOG_ERROR)
        on_log(user, level, line);
}

void report_init(report *r)
{
    *r = (report){0};
    r->logger = (crv_logger){.fn = on_log, .user = r};
}

crv_logger report_errors_only(report *r)
{
    return (crv_logger){.fn = on_log_errors_only, .user = r};
}

static void write_formatted(const char *prefix, const char *format, va_list arguments)
{
    char line[LINE_SIZE];
    vsnprintf(line, sizeof line, format, arguments);
    write_line(prefix, line);
}

/* The body of each of the functions below. */
#define WRITE_FORMATTED(prefix_)                                                         \
    do {                                                                                 \
        va_list arguments;                                                               \
        va_start(arguments, format);                                                     \
        write_formatted(prefix_, format, arguments);                                     \
        va_end(arguments);                                                               \
    } while (0)

void report_error(report *r, const char *format, ...)
{
    r->errors++;
    WRITE_FORMATTED("crevice: ");
}

void report_warning(report *r, const char *format, ...)
{
    (void)r;
    WRITE_FORMATTED("crevice: warning: ");
}

void report_info(report *r, const char *format, ...)
{
    if (!r->quiet)
        WRITE_FORMATTED("");
}

void report_detail(report *r, const char *format, ...)
{
    if (r->verbose)
        WRITE_FORMATTED("");
}

bool report_ok(report *r, crv_status status, const char *doing)
{
    if (status == CRV_OK)
        return true;
    if (status == CRV_ERROR_OUT_OF_MEMORY && r->errors == 0)
        report_no_memory(r);
    else if (r->errors == 0)
        report_error(r, "%s: %s", doing, crv_status_string(status));
    return false;
}

int report_no_memory(report *r)
{
    report_error(r, "out of memory; choose a smaller size or fewer layers");
    return EXIT_FAILED;
}

double report_seconds(void)
{
    return clock_seconds();
}
