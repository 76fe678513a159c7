/* SPDX-License-Identifier: MIT */
#ifdef __linux__
#define _GNU_SOURCE
#else
#define _XOPEN_SOURCE 700
#endif

#include "jobs.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif

/* A process that is killed takes those that it waits for along, where that is possible;
 * elsewhere they end with their last frame. */
static void end_with(pid_t parent)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent)
        _exit(EXIT_FAILED);
#else
    (void)parent;
#endif
}

void jobs_tell(const job *part, int32_t frame)
{
    /* Less than what a pipe takes at once, so that no two tales mix. */
    while (write(part->told, &frame, sizeof frame) < 0 && errno == EINTR) {
    }
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
    for (;;) {
        const ssize_t size = read(from, &frame, sizeof frame);
        if (size < 0 && errno == EINTR)
            continue;
        if (size != (ssize_t)sizeof frame)
            return;
        if (failures->count < failures->capacity)
            failures->frames[failures->count++] = frame;
    }
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

static int wait_for(pid_t process, report *r)
{
    int status = 0;
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR)
            return EXIT_FAILED;
    if (WIFEXITED(status))
        return WEXITSTATUS(status);
    report_error(r,
                 "--jobs: a process was ended by signal %d; start again with "
                 "--skip-existing, and fewer jobs if memory is short",
                 WTERMSIG(status));
    return EXIT_FAILED;
}

int jobs_run(int32_t count, int (*work)(void *user, const job *part), void *user,
             job_failures *failures, report *r)
{
    int ends[2], result = EXIT_DONE;
    pid_t *processes = calloc((size_t)count, sizeof *processes);
    if (!processes)
        return report_no_memory(r);
    if (pipe(ends) != 0) {
        free(processes);
        report_error(r, "--jobs: no pipe (%s); leave it out", strerror(errno));
        return EXIT_FAILED;
    }
    fflush(NULL);
    const pid_t parent = getpid();
    int32_t started = 0;
    for (; started < count; started++) {
        processes[started] = fork();
        if (processes[started] < 0)
            break;
        if (processes[started] == 0) {
            const job part = {.slice = started, .count = count, .told = ends[1]};
            end_with(parent);
            close(ends[0]);
            const int code = work(user, &part);
            fflush(NULL);
            _exit(code);
        }
    }
    close(ends[1]);
    if (started < count) {
        report_error(r, "--jobs: no process (%s); give fewer", strerror(errno));
        result = EXIT_FAILED;
    }
    collect(ends[0], failures);
    close(ends[0]);
    for (int32_t i = 0; i < started; i++)
        result = worse(result, wait_for(processes[i], r));
    free(processes);
    qsort(failures->frames, (size_t)failures->count, sizeof *failures->frames, compare);
    return result;
}
