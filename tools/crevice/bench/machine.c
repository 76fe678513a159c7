/* SPDX-License-Identifier: MIT */
#include "bench/machine.h"

#include <stdio.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

static void find_processor(char *out, size_t size)
{
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[512];
    snprintf(out, size, "unknown processor");
    while (file && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon)
            continue;
        colon += 1 + strspn(colon + 1, " \t");
        colon[strcspn(colon, "\n")] = '\0';
        snprintf(out, size, "%s", colon);
        break;
    }
    if (file)
        fclose(file);
}

static int32_t all_threads(void)
{
#ifdef _OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}

machine machine_look(int32_t threads)
{
    machine m;
    find_processor(m.processor, sizeof m.processor);
#if defined(__clang_version__)
    snprintf(m.compiler, sizeof m.compiler, "clang %s", __clang_version__);
#elif defined(__GNUC__)
    snprintf(m.compiler, sizeof m.compiler, "gcc %s", __VERSION__);
#else
    snprintf(m.compiler, sizeof m.compiler, "unknown compiler");
#endif
    m.threads = threads > 0 ? threads : all_threads();
    return m;
}
