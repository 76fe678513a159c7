/* SPDX-License-Identifier: MIT */
#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#elif !defined(__APPLE__)       /* which hides the number of processors from POSIX */
#define _POSIX_C_SOURCE 200809L /* sysconf() */
#endif
#include "base/parallel.h"

/* A number that threads share. */
#if defined(__EMSCRIPTEN__)
/* There is one thread. */
#elif defined(_WIN32)

#include <windows.h>

typedef volatile LONG counter;

static uint32_t take(counter *c)
{
    return (uint32_t)InterlockedIncrement(c) - 1;
}

static uint32_t peek(counter *c)
{
    return (uint32_t)InterlockedCompareExchange(c, 0, 0);
}

#else

#include <stdatomic.h>

typedef atomic_uint counter;

static uint32_t take(counter *c)
{
    return atomic_fetch_add(c, 1);
}

static uint32_t peek(counter *c)
{
    return atomic_load(c);
}

#endif

/* Tells the host after task i; false if it ends the loop. */
static bool goes_on(const crv_progress *progress, uint32_t i, uint32_t count)
{
    return !progress || !progress->fn || i + 1 >= count || i >= INT32_MAX
           || progress->fn(progress->user, (int32_t)i + 1, (int32_t)count) == 0;
}

#if defined(_OPENMP) || defined(__EMSCRIPTEN__)
static bool run_alone(const crv_progress *progress, uint32_t count,
                      void (*task)(void *data, uint32_t index), void *data)
{
    for (uint32_t i = 0; i < count; i++) {
        task(data, i);
        if (!goes_on(progress, i, count))
            return false;
    }
    return true;
}
#endif

#if defined(_OPENMP)

#include <omp.h>

/* OpenMP's own choice comes from the environment, which may ask for more threads than the
 * system can start; more than four for each processor never help. */
static int default_team(void)
{
    const int most = 4 * omp_get_num_procs();
    const int chosen = omp_get_max_threads();
    return chosen < most ? chosen : most;
}

/* Tasks are handed out in order: those before the caller's last one are done or begun. */
static bool run_team(int32_t threads, const crv_progress *progress, uint32_t count,
                     void (*task)(void *data, uint32_t index), void *data)
{
    const int team = threads > 0 ? threads : default_team();
    if (team < 2 || count < 2)
        return run_alone(progress, count, task, data);
    counter ended = 0;
    /* Rows of a picture differ in cost by a factor of ten (sky against grass). Some
     * compilers have OpenMP 2.0, whose index is signed and declared before. */
    int64_t i;
#pragma omp parallel for schedule(dynamic, 1) num_threads(team)
    for (i = 0; i < (int64_t)count; i++) {
        if (peek(&ended) > 0)
            continue;
        task(data, (uint32_t)i);
        if (omp_get_thread_num() == 0 && !goes_on(progress, (uint32_t)i, count))
            take(&ended);
    }
    return peek(&ended) == 0;
}

#elif !defined(__EMSCRIPTEN__)

/* What differs between systems: threads. */
#if defined(_WIN32)

#include <process.h>

typedef HANDLE thread;

static bool start(thread *out, unsigned(__stdcall *run)(void *), void *argument)
{
    *out = (HANDLE)_beginthreadex(NULL, 0, run, argument, 0, NULL);
    return *out;
}

static void join(thread one)
{
    WaitForSingleObject(one, INFINITE);
    CloseHandle(one);
}

static int64_t processors(void)
{
    SYSTEM_INFO info;
    GetSystemInfo(&info);
    return info.dwNumberOfProcessors;
}

#define THREAD_FUNCTION unsigned __stdcall
#define THREAD_DONE     0

#else

#include <pthread.h>
#include <unistd.h>

typedef pthread_t thread;

static bool start(thread *out, void *(*run)(void *), void *argument)
{
    return pthread_create(out, NULL, run, argument) == 0;
}

static void join(thread one)
{
    pthread_join(one, NULL);
}

static int64_t processors(void)
{
    return sysconf(_SC_NPROCESSORS_ONLN);
}

#define THREAD_FUNCTION void *
#define THREAD_DONE     NULL

#endif

enum { MOST_THREADS = 1024 };

typedef struct team {
    uint32_t count;
    void (*task)(void *data, uint32_t index);
    void *data;
    counter next, ended;
} team;

static void work(team *t, const crv_progress *progress)
{
    for (uint32_t i = take(&t->next); i < t->count && peek(&t->ended) == 0;
         i = take(&t->next)) {
        t->task(t->data, i);
        if (!goes_on(progress, i, t->count))
            take(&t->ended);
    }
}

static THREAD_FUNCTION work_beside(void *argument)
{
    work(argument, NULL);
    return THREAD_DONE;
}

static int32_t default_team(void)
{
    const int64_t count = processors();
    return count < 1 ? 1 : count < MOST_THREADS ? (int32_t)count : MOST_THREADS;
}

/* The calling thread works as well, so that all is done even if no other can be made. */
static bool run_team(int32_t threads, const crv_progress *progress, uint32_t count,
                     void (*task)(void *data, uint32_t index), void *data)
{
    team t = {.count = count, .task = task, .data = data, .next = 0, .ended = 0};
    thread others[MOST_THREADS];
    const int32_t wanted = threads > 0 ? threads : default_team();
    int32_t made = 0;
    while (made < wanted - 1 && (uint32_t)made + 1 < count && made < MOST_THREADS
           && start(&others[made], work_beside, &t))
        made++;
    work(&t, progress);
    for (int32_t i = 0; i < made; i++)
        join(others[i]);
    return peek(&t.ended) == 0;
}

#else

static bool run_team(int32_t threads, const crv_progress *progress, uint32_t count,
                     void (*task)(void *data, uint32_t index), void *data)
{
    (void)threads;
    return run_alone(progress, count, task, data);
}

#endif

bool crv__parallel_is_openmp(void)
{
#if defined(_OPENMP)
    return true;
#else
    return false;
#endif
}

bool crv__parallel_for(const crv_parallel *hook, int32_t threads,
                       const crv_progress *progress, uint32_t count,
                       void (*task)(void *data, uint32_t index), void *data)
{
    if (!hook->run)
        return run_team(threads, progress, count, task, data);
    hook->run(hook->user, count, task, data);
    return true;
}
