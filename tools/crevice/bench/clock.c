/* SPDX-License-Identifier: MIT */
#include "bench/clock.h"

#include <math.h>

#include "common/quantile.h"
#include "common/report.h"
#include "system/clock.h"

enum { RUNS_FEW = 3 };
#define SHORT_SECONDS 0.1

void bench_clock_open(bench_clock *c, int32_t repeats, double seconds)
{
    *c = (bench_clock){.counter = clock_cycles_open(),
                       .repeats = repeats < BENCH_RUNS_MAX ? repeats : BENCH_RUNS_MAX,
                       .seconds = seconds};
}

void bench_clock_close(bench_clock *c)
{
    clock_cycles_close(c->counter);
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
    const double cycles = clock_cycles_read(c->counter), cpu = clock_cpu_seconds(),
                 start = report_seconds();
    const bool good = run(data);
    out->seconds = report_seconds() - start;
    out->cpu = clock_cpu_seconds() - cpu;
    out->cycles = clock_cycles_read(c->counter) - cycles;
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
