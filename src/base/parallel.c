/* SPDX-License-Identifier: MIT */
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
#endif

void crv__parallel_for(const crv_parallel *hook, int32_t threads, uint32_t count,
                       void (*task)(void *data, uint32_t index), void *data)
{
    if (hook->run) {
        hook->run(hook->user, count, task, data);
        return;
    }
#if defined(_OPENMP)
    const int team = threads > 0 ? threads : default_team();
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
