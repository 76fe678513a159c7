/* SPDX-License-Identifier: MIT */
/* clock.h: repeated, timed runs, and what is known of the processor's clock. */
#ifndef TOOL_BENCH_CLOCK_H
#define TOOL_BENCH_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

enum { BENCH_RUNS_MAX = 512 };

typedef struct bench_clock {
    int counter; /* of cycles, -1 if there is none */
    int32_t repeats;
    double seconds; /* after this time no further run begins */
} bench_clock;

/* Of one run, over the runs that were timed. */
typedef struct bench_time {
    int32_t runs;
    double ms, ms_min, ms_q1, ms_q3, ms_max; /* ms: the median */
    double cpu_ms;                           /* of all threads of the process, median */
    double cycles; /* likewise, user code; NAN if there is no counter */
} bench_time;

/* Opens the counter, which counts threads that start later: call it before any does. */
void bench_clock_open(bench_clock *c, int32_t repeats, double seconds);
void bench_clock_close(bench_clock *c);

/*
 * Calls run(data), which returns false after an error, once to warm up and then
 * c->repeats times and for a tenth of a second at least; stops early, with three runs or
 * more, after c->seconds. A first run that takes half of them is the measurement. False
 * after an error.
 */
bool bench_time_runs(const bench_clock *c, bool (*run)(void *data), void *data,
                     bench_time *out);

/* Sorts the values. */
double bench_median(double *values, int32_t count);

#endif
