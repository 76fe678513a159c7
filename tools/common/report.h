/* SPDX-License-Identifier: MIT */
/* report.h: every line that the tool writes to stderr goes through here. */
#ifndef TOOL_REPORT_H
#define TOOL_REPORT_H

#include <stdbool.h>

#include "crevice/crevice.h"

/* The exit codes of the tool. */
enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

typedef struct report {
    bool quiet;   /* no information; errors and warnings stay */
    bool verbose; /* details too */
    bool brief;   /* hold back what rooms log as information: the later frames of a range,
                     which would repeat what was said of the first */
    int32_t threads;   /* of progress_loops(); 0: all */
    int32_t errors;    /* lines so far, so that no failure goes without one */
    crv_logger logger; /* hand this to the library, io and scene */
} report;

#if defined(__GNUC__)
#define REPORT_PRINTF __attribute__((format(printf, 2, 3)))
#else
#define REPORT_PRINTF
#endif

/* r must not move afterwards: its logger points to it. */
void report_init(report *r);

/* "crevice: LINE". Lines read "FILE or --option: what is wrong; what to do". */
void report_error(report *r, const char *format, ...) REPORT_PRINTF;
void report_warning(report *r, const char *format, ...) REPORT_PRINTF;
void report_info(report *r, const char *format, ...) REPORT_PRINTF;
void report_detail(report *r, const char *format, ...) REPORT_PRINTF;

/* True if status is CRV_OK; otherwise sees to it that an error line has been written,
 * `doing` being what failed. */
bool report_ok(report *r, crv_status status, const char *doing);

/* A failed allocation: writes the line and returns EXIT_FAILED. */
int report_no_memory(report *r);

/* A logger that passes errors on and drops the rest. */
crv_logger report_errors_only(report *r);

/* Seconds on a clock that only goes forward. */
double report_seconds(void);

#endif
