/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L

#include "reference_run.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io.h"

#define BATCH_SECONDS      0.25
#define CHECKPOINT_SECONDS 10.0
#define LINE_SECONDS       10.0 /* between lines of progress where there is no terminal */
enum { FIRST_BATCH = 64 };

static const int stop_signals[] = {SIGINT, SIGTERM, SIGHUP};
enum { STOP_COUNT = sizeof stop_signals / sizeof stop_signals[0] };

static volatile sig_atomic_t stop_signal;

static void on_stop(int number)
{
    stop_signal = number;
}

static void hold_signals(struct sigaction former[STOP_COUNT])
{
    struct sigaction hold = {.sa_handler = on_stop, .sa_flags = SA_RESTART};

    stop_signal = 0;
    sigemptyset(&hold.sa_mask);
    for (int i = 0; i < STOP_COUNT; i++) {
        sigaction(stop_signals[i], NULL, &former[i]);
        /* What the caller ignores, as nohup does, stays ignored. */
        if (former[i].sa_handler != SIG_IGN)
            sigaction(stop_signals[i], &hold, NULL);
    }
}

static void release_signals(const struct sigaction former[STOP_COUNT])
{
    for (int i = 0; i < STOP_COUNT; i++)
        sigaction(stop_signals[i], &former[i], NULL);
}

int reference_run_check(reference_run *run, const char *output, bool resume, report *r)
{
    static const char extension[] = ".checkpoint";
    size_t length = strlen(output);

    run->checkpoint = malloc(length + sizeof extension);
    if (!run->checkpoint)
        return report_no_memory(r);
    memcpy(run->checkpoint, output, length);
    memcpy(run->checkpoint + length, extension, sizeof extension);
    if (resume || access(run->checkpoint, F_OK) != 0)
        return EXIT_DONE;
    report_error(r, "%s: holds unfinished work; go on with --resume, or delete it",
                 run->checkpoint);
    return EXIT_USAGE;
}

/* Before the work a full disk is told of: while a checkpoint takes the place of another
 * both are there, and so are the last one and the picture, whose channels take six floats
 * a pixel where they cannot be compressed. */
static int try_room(reference_run *run, const char *output, report *r)
{
    size_t picture = (size_t)reference_total(run->work) * 6 * sizeof(float) + 65536;

    return reference_save(run->work, run->checkpoint, &r->logger) == 0
                   && io_check_room(output, picture, &r->logger) == 0
               ? EXIT_DONE
               : EXIT_FAILED;
}

static int begin(reference_run *run, const char *output, bool resume, report *r)
{
    if (resume && access(run->checkpoint, F_OK) == 0) {
        if (reference_load(run->work, run->checkpoint, &r->logger) != 0)
            return EXIT_FAILED;
        report_info(r, "%s: resumed at %.1f %%", run->checkpoint,
                    100.0 * (double)reference_done(run->work)
                        / (double)reference_total(run->work));
        return try_room(run, output, r);
    }
    if (resume)
        report_info(r, "%s: is not there; begins anew", run->checkpoint);
    if (reference_save(run->work, run->checkpoint, &r->logger) != 0)
        return EXIT_FAILED;
    if (try_room(run, output, r) == EXIT_DONE)
        return EXIT_DONE;
    remove(run->checkpoint); /* holds no work */
    return EXIT_FAILED;
}

/* "1 h 04 min", "3 min 20 s", "12 s" */
static void describe_time(double seconds, char *out, size_t size)
{
    long whole = seconds < 1e8 ? (long)(seconds + 0.5) : 100000000;

    if (whole >= 3600)
        snprintf(out, size, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
    else if (whole >= 60)
        snprintf(out, size, "%ld min %02ld s", whole / 60, whole % 60);
    else
        snprintf(out, size, "%ld s", whole);
}

typedef struct progress {
    double start, told; /* seconds */
    int64_t from;       /* pixels that were done at the start */
    bool terminal;
    int width; /* of the line on the terminal */
} progress;

static void show_progress(progress *p, const reference *work, report *r)
{
    double now = report_seconds();
    int64_t done = reference_done(work), left = reference_total(work) - done;
    char time[64], line[128];

    if (r->quiet || (!p->terminal && !r->verbose) || done == p->from
        || (!p->terminal && now - p->told < LINE_SECONDS))
        return;
    p->told = now;
    describe_time((now - p->start) * (double)left / (double)(done - p->from), time,
                  sizeof time);
    const int width =
        snprintf(line, sizeof line, "reference: %5.1f %%, %s left",
                 100.0 * (double)done / (double)reference_total(work), time);
    if (p->terminal)
        fprintf(stderr, "\r%s%*s", line, p->width > width ? p->width - width : 0, "");
    else
        report_info(r, "%s", line);
    p->width = width;
    fflush(stderr);
}

static void end_progress(const progress *p)
{
    if (p->width > 0 && p->terminal)
        fprintf(stderr, "\r%*s\r", p->width, "");
}

/* A checkpoint that fails does not end the work, which is still in memory. */
static void save(reference_run *run, report *r)
{
    crv_logger errors = report_errors_only(r);

    run->is_saved = reference_save(run->work, run->checkpoint, &errors) == 0;
}

static void compute(reference_run *run, int32_t threads, report *r)
{
    progress p = {.start = report_seconds(),
                  .told = report_seconds(),
                  .from = reference_done(run->work),
                  .terminal = isatty(STDERR_FILENO) != 0};
    double last_save = p.start;
    int64_t batch = FIRST_BATCH;

    run->is_saved = true;
    while (reference_done(run->work) < reference_total(run->work) && stop_signal == 0) {
        double start = report_seconds();

        reference_advance(run->work, batch, threads);
        run->is_saved = false;
        const double now = report_seconds();
        if (now - start < 0.5 * BATCH_SECONDS)
            batch *= 2;
        else if (now - start > 2.0 * BATCH_SECONDS && batch > FIRST_BATCH)
            batch /= 2;
        show_progress(&p, run->work, r);
        if (now - last_save >= CHECKPOINT_SECONDS) {
            save(run, r);
            last_save = report_seconds();
        }
    }
    end_progress(&p);
}

int reference_run_all(reference_run *run, const char *output, bool resume,
                      int32_t threads, report *r)
{
    struct sigaction former[STOP_COUNT];

    hold_signals(former);
    const int result = begin(run, output, resume, r);
    if (result == EXIT_DONE)
        compute(run, threads, r);
    int caught = stop_signal;
    if (result == EXIT_DONE && caught != 0 && !run->is_saved)
        save(run, r);
    release_signals(former);
    if (caught == 0)
        return result;
    if (result == EXIT_DONE && run->is_saved)
        report_error(r, "%s: interrupted at %.1f %%; go on with --resume",
                     run->checkpoint,
                     100.0 * (double)reference_done(run->work)
                         / (double)reference_total(run->work));
    raise(caught);
    return EXIT_FAILED;
}

void reference_run_keep(reference_run *run, report *r)
{
    save(run, r);
    if (run->is_saved)
        report_info(r, "%s: holds the finished work; write it with --resume",
                    run->checkpoint);
    else
        report_info(r,
                    "%s: holds all but the last seconds of the work; go on with "
                    "--resume",
                    run->checkpoint);
}

void reference_run_finish(reference_run *run)
{
    remove(run->checkpoint);
}
