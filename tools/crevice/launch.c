/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L

#include "launch.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 4096 };

/* The folder of this program with a slash; "" if it cannot be known. */
static void own_folder(char out[PATH_SIZE])
{
    const ssize_t length = readlink("/proc/self/exe", out, PATH_SIZE - 1);
    out[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(out, '/');
    out[slash ? slash + 1 - out : 0] = '\0';
}

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
    own_folder(own);
    for (size_t i = 0; i < 2 && own[0]; i++) {
        snprintf(path, sizeof path, "%s%s%s", own, folders[i], c->program);
        execv(path, words);
    }
    execvp(c->program, words);
    free(words);
    report_error(r,
                 "%s: %s is not here (%s); build it with GTK 4 installed (Debian: "
                 "libgtk-4-dev), or install the package that has it",
                 c->name, c->program, strerror(errno));
    return EXIT_FAILED;
}
