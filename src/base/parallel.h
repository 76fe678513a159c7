/* SPDX-License-Identifier: MIT */
#ifndef CRV_BASE_PARALLEL_H
#define CRV_BASE_PARALLEL_H

#include "crevice/base.h"

#include <stdbool.h>

/* Calls task(data, i) for every i in [0, count) through the host's hook, or with
 * `threads` threads (0: a sensible number) of OpenMP or, without it, of POSIX; else on
 * this thread. Without a hook it calls `progress` (NULL: nobody) on this thread between
 * the tasks that this thread runs. False if that ended the loop: some tasks are left
 * out. */
bool crv__parallel_for(const crv_parallel *hook, int32_t threads,
                       const crv_progress *progress, uint32_t count,
                       void (*task)(void *data, uint32_t index), void *data);

/* Whether OpenMP was built in. */
bool crv__parallel_is_openmp(void);

#endif
