/* SPDX-License-Identifier: MIT */
#if !defined(_WIN32)
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
        /* Rows of a picture differ in cost by a factor of ten (sky against grass). */
#pragma omp parallel for schedule(dynamic, 1) num_threads(team)
        for (uint32_t i = 0; i < count; i++)
            task(data, i);
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        task(data, i);
}

#elif !defined(_WIN32) && !defined(__EMSCRIPTEN__) && !defined(__STDC_NO_ATOMICS__)

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { MOST_THREADS = 1024 };

typedef struct team {
    uint32_t count;
    void (*task)(void *data, uint32_t index);
    void *data;
    atomic_uint next;
} team;

static void *work(void *argument)
{
    team *t = argument;
    for (uint32_t i = atomic_fetch_add(&t->next, 1); i < t->count;
         i = atomic_fetch_add(&t->next, 1))
        t->task(t->data, i);
    return NULL;
}

static int32_t processors(void)
{
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count < MOST_THREADS ? (int32_t)count : MOST_THREADS;
}

/* The calling thread works as well, so that all is done even if no other can be made. */
static void run_team(int32_t threads, uint32_t count,
                     void (*task)(void *data, uint32_t index), void *data)
{
    team t = {.count = count, .task = task, .data = data};
    atomic_init(&t.next, 0);
    pthread_t others[MOST_THREADS];
    const int32_t wanted = threads > 0 ? threads : processors();
    int32_t made = 0;
    while (made < wanted - 1 && (uint32_t)made + 1 < count && made < MOST_THREADS
           && pthread_create(&others[made], NULL, work, &t) == 0)
        made++;
    work(&t);
    for (int32_t i = 0; i < made; i++)
        pthread_join(others[i], NULL);
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
