/* SPDX-License-Identifier: MIT */
/* machine.h: where times were measured. */
#ifndef TOOL_BENCH_MACHINE_H
#define TOOL_BENCH_MACHINE_H

#include <stdint.h>

typedef struct machine {
    char processor[128]; /* as /proc/cpuinfo calls it, or "unknown processor" */
    char compiler[64];
    int32_t threads; /* that these settings make */
} machine;

/* threads: 0 for all. */
machine machine_look(int32_t threads);

#endif
