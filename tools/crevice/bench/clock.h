/* SPDX-License-Identifier: MIT */
/* clock.h: repeated, timed runs and what is known of the processor's clock. */
#ifndef TOOL_BENCH_CLOCK_H
#define TOOL_BENCH_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

typedef struct bench_clock {
    int counter; /* file descriptor of the cycle counter, -1 where there is none */
    double ghz;  /* of a chain of dependent additions; 0 where it cannot be told */
    int32_t repeats;
    double seconds; /* no further run is begun after so much */
} bench_clock;

/* Of one run, over the runs that were timed. cycles: of all threads, user code, median;
 * NAN where the counter cannot be read. */
typedef struct bench_time {
    int32_t runs;
    double ms, ms_min, ms_q1, ms_q3, ms_max;
    double cpu_ms; /* of all threads of the process, median */
    double cycles;
} bench_time;

/* Opens the counter, which counts threads that are started later: call it before any is.
 */
void bench_clock_open(bench_clock *c, int32_t repeats, double seconds);
void bench_clock_close(bench_clock *c);

/* What cycles come from: "counter", "clock" (processor time times ghz) or "none". */
const char *bench_clock_source(const bench_clock *c);

/*
 * Calls run(data), which returns false after an error, once to warm up and then
 * c->repeats times and for a tenth of a second at least; stops early, with three runs or
 * more, after c->seconds. A first run that takes half of them is the measurement. False
 * after an error.
 */
bool bench_time_runs(const bench_clock *c, bool (*run)(void *data), void *data,
                     bench_time *out);

/* What run(more) takes longer than run(less), the two in turn. */
bool bench_time_difference(const bench_clock *c, bool (*run)(void *data), void *more,
                           void *less, bench_time *out);

/* The median; sorts the values. */
double bench_median(double *values, int32_t count);

#endif
