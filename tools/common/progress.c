/* SPDX-License-Identifier: MIT */
#include "progress.h"

#include <stdio.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "system/file.h"

#define LINE_SECONDS  10.0 /* between lines if there is no terminal */
#define SOON_SECONDS  0.2  /* after this time the rest can be estimated */
#define LONG_SECONDS  10.0 /* what takes longer is told of */
#define FRESH_SECONDS 0.25 /* between changes on a terminal */

/* "1 h 04 min", "3 min 20 s", "12 s" */
static void describe_time(double seconds, char *out, size_t size)
{
    const long whole = seconds < 1e8 ? (long)(seconds + 0.5) : 100000000;
    if (whole >= 3600)
        snprintf(out, size, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
    else if (whole >= 60)
        snprintf(out, size, "%ld min %02ld s", whole / 60, whole % 60);
    else
        snprintf(out, size, "%ld s", whole);
}

bool progress_is_long(double seconds)
{
    return seconds > LONG_SECONDS;
}

void progress_announce(report *r, const char *name, double seconds)
{
    char time[64];
    if (!progress_is_long(seconds))
        return;
    describe_time(seconds, time, sizeof time);
    report_info(r, "%s: about %s", name, time);
}

progress progress_begin(report *r, const char *name, int64_t from, int64_t total)
{
    return (progress){.r = r,
                      .name = name,
                      .start = report_seconds(),
                      .from = from,
                      .total = total,
                      .terminal = file_is_terminal(stderr)};
}

static void show(progress *p, int64_t done, double now)
{
    char time[64], line[128];
    p->told = now;
    describe_time((now - p->start) * (double)(p->total - done) / (double)(done - p->from),
                  time, sizeof time);
    const int width = snprintf(line, sizeof line, "%s: %5.1f %%, %s left", p->name,
                               100.0 * (double)done / (double)p->total, time);
    if (p->terminal)
        fprintf(stderr, "\r%s%*s", line, p->width > width ? p->width - width : 0, "");
    else
        report_info(p->r, "%s", line);
    p->width = width;
    fflush(stderr);
}

void progress_show(progress *p, int64_t done)
{
    const double now = report_seconds(), spent = now - p->start;
    const double whole = spent / (double)(done - p->from) * (double)(p->total - p->from);
    const double wait = p->terminal ? FRESH_SECONDS : LINE_SECONDS;
    if (p->r->quiet || done == p->from || done == p->total)
        return;
    if (p->told > 0.0 ? now - p->told >= wait
                      : spent > SOON_SECONDS && whole > LONG_SECONDS)
        show(p, done, now);
}

void progress_rows(void *user, int32_t rows)
{
    progress_show(user, rows);
}

void progress_share(void *user, double share)
{
    progress_show(user, (int64_t)(share * PROGRESS_SHARES));
}

void progress_end(progress *p)
{
    if (p->width > 0 && p->terminal)
        fprintf(stderr, "\r%*s\r", p->width, "");
    p->width = 0;
}

#ifdef _OPENMP
/* Only the calling thread writes, between its own tasks. */
static void run_loop(void *user, uint32_t count, void (*task)(void *data, uint32_t index),
                     void *data)
{
    report *r = user;
    const int threads = r->threads > 0 ? r->threads : omp_get_max_threads();
    progress p = progress_begin(r, "estimation", 0, (int64_t)count);
    uint32_t done = 0;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (uint32_t i = 0; i < count; i++) {
        uint32_t now_done;
        task(data, i);
#pragma omp atomic capture
        now_done = ++done;
        if (omp_get_thread_num() == 0)
            progress_show(&p, now_done);
    }
    progress_end(&p);
}
#endif

crv_parallel progress_loops(report *r, int32_t threads)
{
    r->threads = threads;
#ifdef _OPENMP
    return (crv_parallel){.run = run_loop, .user = r};
#else
    return (crv_parallel){0};
#endif
}

/* A run has several steps, and another may follow. */
static int32_t show_run(void *user, int32_t done, int32_t total)
{
    progress *p = user;
    if (p->total > 0 && (total != p->total || done <= p->piece)) {
        p->start = p->at;
        p->told = 0.0;
    }
    p->total = total;
    p->piece = done;
    p->at = report_seconds();
    progress_show(p, done);
    return 0;
}

crv_progress progress_runs(progress *p)
{
    return (crv_progress){.fn = show_run, .user = p};
}
