/* SPDX-License-Identifier: MIT */
#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#elif !defined(__APPLE__)       /* which hides the number of processors from POSIX */
#define _POSIX_C_SOURCE 200809L /* sysconf() */
#endif
#include "base/parallel.h"

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

static void run_team(int32_t threads, uint32_t count,
                     void (*task)(void *data, uint32_t index), void *data)
{
    const int team = threads > 0 ? threads : default_team();
    if (team > 1 && count > 1) {
        /* Rows of a picture differ in cost by a factor of ten (sky against grass). Some
         * compilers have OpenMP 2.0, whose index is signed and declared before. */
        int64_t i;
#pragma omp parallel for schedule(dynamic, 1) num_threads(team)
        for (i = 0; i < (int64_t)count; i++)
            task(data, (uint32_t)i);
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        task(data, i);
}

#elif !defined(__EMSCRIPTEN__)

/* What differs between systems: a counter that threads share, and threads. */
#if defined(_WIN32)

#include <process.h>
#include <windows.h>

typedef volatile LONG counter;
typedef HANDLE thread;

static uint32_t take(counter *next)
{
    return (uint32_t)InterlockedIncrement(next) - 1;
}

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
#include <stdatomic.h>
#include <unistd.h>

typedef atomic_uint counter;
typedef pthread_t thread;

static uint32_t take(counter *next)
{
    return atomic_fetch_add(next, 1);
}

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
    counter next;
} team;

static THREAD_FUNCTION work(void *argument)
{
    team *t = argument;
    for (uint32_t i = take(&t->next); i < t->count; i = take(&t->next))
        t->task(t->data, i);
    return THREAD_DONE;
}

static int32_t default_team(void)
{
    const int64_t count = processors();
    return count < 1 ? 1 : count < MOST_THREADS ? (int32_t)count : MOST_THREADS;
}

/* The calling thread works as well, so that all is done even if no other can be made. */
static void run_team(int32_t threads, uint32_t count,
                     void (*task)(void *data, uint32_t index), void *data)
{
    team t = {.count = count, .task = task, .data = data, .next = 0};
    thread others[MOST_THREADS];
    const int32_t wanted = threads > 0 ? threads : default_team();
    int32_t made = 0;
    while (made < wanted - 1 && (uint32_t)made + 1 < count && made < MOST_THREADS
           && start(&others[made], work, &t))
        made++;
    work(&t);
    for (int32_t i = 0; i < made; i++)
        join(others[i]);
}

#else

static void run_team(int32_t threads, uint32_t count,
                     void (*task)(void *data, uint32_t index), void *data)
{
    (void)threads;
    for (uint32_t i = 0; i < count; i++)
        task(data, i);
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

void crv__parallel_for(const crv_parallel *hook, int32_t threads, uint32_t count,
                       void (*task)(void *data, uint32_t index), void *data)
{
    if (hook->run)
        hook->run(hook->user, count, task, data);
    else
        run_team(threads, count, task, data);
}
