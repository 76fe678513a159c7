/* SPDX-License-Identifier: MIT */
#include "clock.h"

#include <math.h>
#include <stdint.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#ifdef __linux__
#include <linux/perf_event.h>
#include <sys/syscall.h>
#endif

static double seconds_of(clockid_t which)
{
    struct timespec now = {0};
    clock_gettime(which, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double clock_seconds(void)
{
    return seconds_of(CLOCK_MONOTONIC);
}

double clock_cpu_seconds(void)
{
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

int clock_cycles_open(void)
{
#ifdef __linux__
    struct perf_event_attr what;
    memset(&what, 0, sizeof what);
    what.size = sizeof what;
    what.type = PERF_TYPE_HARDWARE;
    what.config = PERF_COUNT_HW_CPU_CYCLES;
    what.exclude_kernel = 1;
    what.exclude_hv = 1;
    what.inherit = 1;
    const int counter = (int)syscall(SYS_perf_event_open, &what, 0, -1, -1, 0UL);
    if (!isnan(clock_cycles_read(counter)))
        return counter;
    clock_cycles_close(counter);
#endif
    return -1;
}

double clock_cycles_read(int counter)
{
    uint64_t value = 0;
    if (counter < 0 || read(counter, &value, sizeof value) != sizeof value)
        return (double)NAN;
    return (double)value;
}

void clock_cycles_close(int counter)
{
    if (counter >= 0)
        close(counter);
}
