/* SPDX-License-Identifier: MIT */
#include "reference_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "common/progress.h"
#include "io.h"
#include "system/file.h"
#include "system/interrupt.h"

#define BATCH_SECONDS      0.25
#define CHECKPOINT_SECONDS 10.0

/* A pixel takes a tenth of a second at most. A checkpoint is worth some waiting. Pixels
 * of the sky cost nothing and say nothing of the next ones, so that a batch is bounded by
 * the rays that it may need of each thread: a tenth of a second, and half a second on a
 * machine that is slow or busy. */
enum { FIRST_BATCH = 4, BATCH_RAYS = 500000, GRACE_S = 10 };

int reference_run_check(reference_run *run, const char *output, bool resume, report *r)
{
    static const char extension[] = ".checkpoint";
    size_t length = strlen(output);
    run->checkpoint = malloc(length + sizeof extension);
    if (!run->checkpoint)
        return report_no_memory(r);
    memcpy(run->checkpoint, output, length);
    memcpy(run->checkpoint + length, extension, sizeof extension);
    if (resume || !file_exists(run->checkpoint))
        return EXIT_DONE;
    report_error(r, "%s: holds unfinished work; go on with --resume, or delete it",
                 run->checkpoint);
    return EXIT_USAGE;
}

/* Before the work a full disk is told of: while a checkpoint takes the place of another
 * both are there, and so are the last one and the picture, whose channels take nine
 * floats a pixel where they cannot be compressed. */
static int try_room(reference_run *run, const char *output, report *r)
{
    size_t picture = (size_t)reference_total(run->work) * 9 * sizeof(float) + 65536;
    return reference_save(run->work, run->checkpoint, &r->logger) == 0
                   && io_check_room(output, picture, &r->logger) == 0
               ? EXIT_DONE
               : EXIT_FAILED;
}

static int begin(reference_run *run, const char *output, bool resume, report *r)
{
    if (resume && file_exists(run->checkpoint)) {
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

/* A checkpoint that fails does not end the work, which is still in memory. */
static void save(reference_run *run, report *r)
{
    crv_logger errors = report_errors_only(r);
    run->is_saved = reference_save(run->work, run->checkpoint, &errors) == 0;
}

static int32_t thread_count(int32_t wanted)
{
#ifdef _OPENMP
    return wanted > 0 ? wanted : omp_get_max_threads();
#else
    (void)wanted;
    return 1;
#endif
}

static void compute(reference_run *run, int32_t rays, int32_t threads, report *r)
{
    const int64_t share = BATCH_RAYS / rays > 1 ? BATCH_RAYS / rays : 1;
    const int64_t most = share * thread_count(threads);
    progress p = progress_begin(r, "reference", reference_done(run->work),
                                reference_total(run->work));
    double last_save = p.start;
    int64_t batch = FIRST_BATCH;
    run->is_saved = true;
    while (reference_done(run->work) < reference_total(run->work) && !interrupt_waits()) {
        const double start = report_seconds();

        reference_advance(run->work, batch, threads);
        run->is_saved = false;
        const double now = report_seconds();
        if (now - start < 0.5 * BATCH_SECONDS)
            batch = 2 * batch < most ? 2 * batch : most;
        else if (now - start > 2.0 * BATCH_SECONDS && batch > 1)
            batch /= 2;
        progress_show(&p, reference_done(run->work));
        if (now - last_save >= CHECKPOINT_SECONDS) {
            save(run, r);
            last_save = report_seconds();
        }
    }
    progress_end(&p);
}

int reference_run_all(reference_run *run, const char *output, bool resume, int32_t rays,
                      int32_t threads, report *r)
{
    interrupt_hold(GRACE_S);
    const int result = begin(run, output, resume, r);
    if (result == EXIT_DONE)
        compute(run, rays, threads, r);
    const bool stopped = interrupt_waits();
    if (result == EXIT_DONE && stopped && !run->is_saved)
        save(run, r);
    if (result == EXIT_DONE && stopped && run->is_saved)
        report_error(r, "%s: interrupted at %.1f %%; go on with --resume",
                     run->checkpoint,
                     100.0 * (double)reference_done(run->work)
                         / (double)reference_total(run->work));
    interrupt_release();
    return stopped ? EXIT_FAILED : result;
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
