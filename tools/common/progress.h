/* SPDX-License-Identifier: MIT */
/* progress.h: how far work that takes long has come, and what is left. */
#ifndef TOOL_PROGRESS_H
#define TOOL_PROGRESS_H

#include "report.h"

/* Work that will take more than ten seconds is told of as soon as that is known, then now
 * and then: on a terminal in a line that is written over. */
typedef struct progress {
    report *r;
    const char *name;   /* "reference" */
    double start, told; /* seconds; told 0: not yet */
    int64_t from, total;
    bool terminal;
    int width;     /* of the line on the terminal */
    int32_t piece; /* of a run, that was told of last */
    double at;     /* when; seconds */
} progress;

/* Whether work of so many seconds is told of. */
bool progress_is_long(double seconds);

/* Tells of work that is about to begin if it will take more than ten seconds:
 * "compare: about 21 s". */
void progress_announce(report *r, const char *name, double seconds);

/* from: what was done before. */
progress progress_begin(report *r, const char *name, int64_t from, int64_t total);
void progress_show(progress *p, int64_t done);
void progress_end(progress *p);
/* progress_show() as scene's loops call it; user: the progress. */
void progress_rows(void *user, int32_t rows);

/* The same for who tells a share from 0 to 1: total is PROGRESS_SHARES. */
enum { PROGRESS_SHARES = 1000000 };
void progress_share(void *user, double share);

/* Runs the library's loops on OpenMP's threads, as the library itself does, and says of
 * those that take more than ten seconds how long they will. threads: 0 for all. Zeroed,
 * so that the library runs them, if the tool is built without OpenMP. */
crv_parallel progress_loops(report *r, int32_t threads);

/* Says the same of what the library does by its own loops, and on a GPU: p is begun, with
 * a total of 0, before the runs. */
crv_progress progress_runs(progress *p);

#endif
