/* SPDX-License-Identifier: MIT */
#include "jobs.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "system/process.h"

void jobs_tell(const job *part, int32_t frame)
{
    pipe_write(part->told, &frame, sizeof frame);
}

int32_t jobs_threads(int32_t given, int32_t jobs)
{
#ifdef _OPENMP
    if (given < 1)
        given = omp_get_max_threads();
#endif
    return given > jobs ? given / jobs : 1;
}

static void collect(int from, job_failures *failures)
{
    int32_t frame;
    while (pipe_read(from, &frame, sizeof frame) == (int64_t)sizeof frame)
        if (failures->count < failures->capacity)
            failures->frames[failures->count++] = frame;
}

static int compare(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* The worst of two exit codes. */
static int worse(int a, int b)
{
    return a > b ? a : b;
}

static int wait_for(process child, report *r)
{
    process_end end;
    if (!process_wait(child, &end))
        return EXIT_FAILED;
    if (!end.signal)
        return end.code;
    report_error(r,
                 "--jobs: a process was ended by signal %d; start again with "
                 "--skip-existing, and fewer jobs if memory is short",
                 end.signal);
    return EXIT_FAILED;
}

/* What a child gets. */
typedef struct assignment {
    int (*work)(void *user, const job *part);
    void *user;
    job part;
    int unused; /* the end of the pipe that is the parent's */
} assignment;

static int run_part(void *data)
{
    const assignment *a = data;
    pipe_close(a->unused);
    const int code = a->work(a->user, &a->part);
    fflush(NULL);
    return code;
}

int jobs_run(int32_t count, int (*work)(void *user, const job *part), void *user,
             job_failures *failures, report *r)
{
    pipe_ends ends;
    int result = EXIT_DONE;
    process *children = calloc((size_t)count, sizeof *children);
    if (!children)
        return report_no_memory(r);
    if (!pipe_open(&ends)) {
        free(children);
        report_error(r, "--jobs: no pipe (%s); leave it out", strerror(errno));
        return EXIT_FAILED;
    }
    fflush(NULL);
    int32_t started = 0;
    for (; started < count; started++) {
        assignment a = {.work = work,
                        .user = user,
                        .part = {.slice = started, .count = count, .told = ends.to},
                        .unused = ends.from};
        if (!process_start(&children[started], true, run_part, &a))
            break;
    }
    pipe_close(ends.to);
    if (started < count) {
        report_error(r, "--jobs: no process (%s); give fewer", strerror(errno));
        result = EXIT_FAILED;
    }
    collect(ends.from, failures);
    pipe_close(ends.from);
    for (int32_t i = 0; i < started; i++)
        result = worse(result, wait_for(children[i], r));
    free(children);
    qsort(failures->frames, (size_t)failures->count, sizeof *failures->frames, compare);
    return result;
}
