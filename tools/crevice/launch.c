/* SPDX-License-Identifier: MIT */
#include "launch.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/process.h"

enum { PATH_SIZE = 4096 };

int launch(const command *c, int argc, char **argv, report *r)
{
    /* Installed programs lie side by side; in a build each has its room's folder. */
    static const char *const folders[] = {"", "../view/"};
    char own[PATH_SIZE], path[2 * PATH_SIZE];
    char **words = calloc((size_t)argc + 2, sizeof *words);
    if (!words)
        return report_no_memory(r);
    words[0] = (char *)(uintptr_t)c->program;
    for (int i = 0; i < argc; i++)
        words[i + 1] = argv[i];
    process_own_folder(own, sizeof own);
    for (size_t i = 0; i < 2 && own[0]; i++) {
        snprintf(path, sizeof path, "%s%s%s", own, folders[i], c->program);
        process_become(path, words);
    }
    process_become(c->program, words);
    free(words);
    report_error(r,
                 "%s: %s is not here (%s); build it with GTK 4 installed (Debian: "
                 "libgtk-4-dev), or install the package that has it",
                 c->name, c->program, strerror(errno));
    return EXIT_FAILED;
}
