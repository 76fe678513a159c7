/* SPDX-License-Identifier: MIT */
/*
 * leftovers.c: temporary files of runs that were killed. A writer holds a lock on its
 * temporary file, which ends with the process however it ends: a file of such a name that
 * can be locked is nobody's any more.
 */
#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "internal.h"

static bool has_our_name(const char *name)
{
    static const char prefix[] = IO__TEMPORARY_PREFIX, suffix[] = IO__TEMPORARY_SUFFIX;
    const size_t length = strlen(name);
    return length > sizeof prefix + sizeof suffix
           && !strncmp(name, prefix, sizeof prefix - 1)
           && !strcmp(name + length + 1 - sizeof suffix, suffix);
}

/* File systems without locks leave it alone. */
static bool remove_if_left(int folder, const char *name)
{
    struct stat status;
    const int descriptor =
        openat(folder, name, O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0)
        return false;
    const bool removed = !fstat(descriptor, &status) && S_ISREG(status.st_mode)
                         && !flock(descriptor, LOCK_EX | LOCK_NB)
                         && !unlinkat(folder, name, 0);
    close(descriptor);
    return removed;
}

void io__remove_leftovers(const char *folder, const crv_logger *log)
{
    DIR *directory = opendir(folder);
    if (!directory)
        return;
    int removed = 0;
    for (const struct dirent *entry = readdir(directory); entry;
         entry = readdir(directory))
        if (has_our_name(entry->d_name))
            removed += remove_if_left(dirfd(directory), entry->d_name);
    closedir(directory);
    if (removed)
        io__info(log, folder, "%d temporary file%s of a run that was killed %s removed",
                 removed, removed == 1 ? "" : "s", removed == 1 ? "is" : "are");
}
