/* SPDX-License-Identifier: MIT */
/* jobs.h: frames of a shot by several processes at a time. */
#ifndef TOOL_JOBS_H
#define TOOL_JOBS_H

#include "common/report.h"

/* The frames that a process computes: those whose places in the list are slice, slice +
 * count and so on. */
typedef struct job {
    int32_t slice, count; /* count 1: all, in this process */
    int told;             /* where jobs_tell() writes */
} job;

/* Numbers of frames. */
typedef struct job_failures {
    int32_t count, capacity;
    int32_t *frames; /* owned by the caller */
} job_failures;

/*
 * Runs work(user, part) in `count` processes of their own and waits for them. Must be
 * called before any other thread has been started. What they tell of goes to *failures,
 * sorted. Returns an exit code, the worst of theirs.
 */
int jobs_run(int32_t count, int (*work)(void *user, const job *part), void *user,
             job_failures *failures, report *r);

/* The threads of each process; given 0: as many as there are are shared. */
int32_t jobs_threads(int32_t given, int32_t jobs);

/* Tells the waiting process of a frame that failed. */
void jobs_tell(const job *part, int32_t frame);

#endif
