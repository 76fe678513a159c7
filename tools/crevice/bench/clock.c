/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE

#include "bench/clock.h"

#include <math.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#ifdef __linux__
#include <linux/perf_event.h>
#include <sys/syscall.h>
#endif

#include "common/quantile.h"
#include "common/report.h"

enum { RUNS_FEW = 3 };
#define SHORT_SECONDS 0.1

#ifdef __linux__
static int open_counter(void)
{
    struct perf_event_attr what;
    memset(&what, 0, sizeof what);
    what.size = sizeof what;
    what.type = PERF_TYPE_HARDWARE;
    what.config = PERF_COUNT_HW_CPU_CYCLES;
    what.exclude_kernel = 1;
    what.exclude_hv = 1;
    what.inherit = 1;
    return (int)syscall(SYS_perf_event_open, &what, 0, -1, -1, 0UL);
}
#else
static int open_counter(void)
{
    return -1;
}
#endif

static double read_counter(const bench_clock *c)
{
    uint64_t value = 0;
    if (c->counter < 0 || read(c->counter, &value, sizeof value) != sizeof value)
        return NAN;
    return (double)value;
}

static double cpu_seconds(void)
{
    struct timespec now = {0};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void bench_clock_open(bench_clock *c, int32_t repeats, double seconds)
{
    *c = (bench_clock){.counter = open_counter(),
                       .repeats = repeats < BENCH_RUNS_MAX ? repeats : BENCH_RUNS_MAX,
                       .seconds = seconds};
    if (isnan(read_counter(c)))
        bench_clock_close(c);
}

void bench_clock_close(bench_clock *c)
{
    if (c->counter >= 0)
        close(c->counter);
    c->counter = -1;
}

double bench_median(double *values, int32_t count)
{
    quantile_sort(values, (size_t)count);
    return quantile(values, (size_t)count, 0.5);
}

typedef struct sample {
    double seconds, cpu, cycles;
} sample;

static bool take(const bench_clock *c, bool (*run)(void *data), void *data, sample *out)
{
    const double cycles = read_counter(c), cpu = cpu_seconds(), start = report_seconds();
    const bool good = run(data);
    out->seconds = report_seconds() - start;
    out->cpu = cpu_seconds() - cpu;
    out->cycles = read_counter(c) - cycles;
    return good;
}

static void summarise(const bench_clock *c, const sample *samples, int32_t count,
                      bench_time *out)
{
    double values[BENCH_RUNS_MAX];
    for (int32_t i = 0; i < count; i++)
        values[i] = 1e3 * samples[i].cpu;
    out->cpu_ms = bench_median(values, count);
    for (int32_t i = 0; i < count; i++)
        values[i] = samples[i].cycles;
    out->cycles = c->counter >= 0 ? bench_median(values, count) : NAN;
    for (int32_t i = 0; i < count; i++)
        values[i] = 1e3 * samples[i].seconds;
    out->ms = bench_median(values, count);
    out->runs = count;
    out->ms_min = values[0];
    out->ms_q1 = quantile(values, (size_t)count, 0.25);
    out->ms_q3 = quantile(values, (size_t)count, 0.75);
    out->ms_max = values[count - 1];
}

static bool is_enough(const bench_clock *c, int32_t count, double total)
{
    return count == BENCH_RUNS_MAX || (count >= c->repeats && total >= SHORT_SECONDS)
           || (count >= RUNS_FEW && total >= c->seconds);
}

bool bench_time_runs(const bench_clock *c, bool (*run)(void *data), void *data,
                     bench_time *out)
{
    sample samples[BENCH_RUNS_MAX];
    int32_t count = 0;
    if (!take(c, run, data, &samples[0]))
        return false;
    if (samples[0].seconds >= 0.5 * c->seconds) {
        summarise(c, samples, 1, out);
        return true;
    }
    for (double total = 0.0; !is_enough(c, count, total); count++) {
        if (!take(c, run, data, &samples[count]))
            return false;
        total += samples[count].seconds;
    }
    summarise(c, samples, count, out);
    return true;
}
