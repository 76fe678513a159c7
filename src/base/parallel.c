/* SPDX-License-Identifier: MIT */
#include "base/parallel.h"

#if defined(_OPENMP)
#include <omp.h>
enum { MAX_THREADS = 1024 };
#endif

void crv__parallel_for(const crv_parallel *hook, int32_t threads, uint32_t count,
                       void (*task)(void *data, uint32_t index), void *data)
{
    if (hook->run) {
        hook->run(hook->user, count, task, data);
        return;
    }
#if defined(_OPENMP)
    /* OMP_NUM_THREADS may be anything. */
    const int all =
        omp_get_max_threads() < MAX_THREADS ? omp_get_max_threads() : MAX_THREADS;
    const int team = threads > 0 ? threads : all;
    if (team > 1 && count > 1) {
        /* Rows of a picture differ in cost by a factor of ten (sky against grass). */
#pragma omp parallel for schedule(dynamic, 1) num_threads(team)
        for (uint32_t i = 0; i < count; i++)
            task(data, i);
        return;
    }
#else
    (void)threads;
#endif
    for (uint32_t i = 0; i < count; i++)
        task(data, i);
}
