/* SPDX-License-Identifier: MIT */
/*
 * atomic_write.c: a result appears under its name when it is complete and on disk, or not
 * at all.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "internal.h"

enum { MAX_LINKS = 40, MAX_TRIES = 100 };

/* Length of the folder's part of a path, its last slash included. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* folder (the first `length` bytes of path) + name, or just name if it is absolute. */
static char *beside(const char *path, size_t length, const char *name)
{
    if (name[0] == '/')
        length = 0;
    char *joined = malloc(length + strlen(name) + 1);
    if (joined) {
        memcpy(joined, path, length);
        memcpy(joined + length, name, strlen(name) + 1);
    }
    return joined;
}

static int fail_memory(const crv_logger *log, const char *path)
{
    return io__fail(log, path, "no memory to write it; close other programs");
}

/* Follows links one by one, because realpath() refuses a link whose target is yet to be
 * made. The caller frees *target. */
static int follow_links(const char *path, char **target, const crv_logger *log)
{
    char *current = beside(path, 0, path);
    for (int i = 0; i < MAX_LINKS; i++) {
        char link[4096];
        if (!current)
            return fail_memory(log, path);
        const ssize_t length = readlink(current, link, sizeof link);
        if (length < 0 || (size_t)length >= sizeof link) {
            *target = current;
            return 0;
        }
        link[length] = '\0';
        char *next = beside(current, folder_length(current), link);
        free(current);
        current = next;
    }
    free(current);
    return io__fail(log, path, "is a chain of links without an end; name a file");
}

/* What must hold of the target itself and of its folder. */
static int check_target(const char *target, const char *path, const crv_logger *log)
{
    struct stat status;
    if (!path[0] || !target[0])
        return io__fail(log, "output", "the file name is empty; give one");
    if (!stat(target, &status)) {
        if (S_ISDIR(status.st_mode))
            return io__fail(log, path, "is a folder; name a file in it");
        if (!S_ISREG(status.st_mode))
            return io__fail(log, path, "is a device or a pipe; name a regular file");
        if (access(target, W_OK))
            return io__fail(log, path, "may not be written (%s); choose another name",
                            strerror(errno));
    }
    const size_t length = folder_length(target);
    char *folder = beside(length ? target : "./", length ? length : 2, "");
    if (!folder)
        return fail_memory(log, path);
    int result = 0;
    if (stat(folder, &status))
        result = io__fail(log, path, "its folder cannot be used (%s); make it first",
                          strerror(errno));
    else if (!S_ISDIR(status.st_mode) || access(folder, W_OK | X_OK))
        result =
            io__fail(log, path, "its folder may not be written; choose another place");
    free(folder);
    return result;
}

int io__output_check(const char *path, const crv_logger *log)
{
    char *target = NULL;
    if (follow_links(path, &target, log))
        return -1;
    const int result = check_target(target, path, log);
    free(target);
    return result;
}

/* Opens a file with a name that nobody uses. Made by hand rather than by mkstemp(), which
 * would hide the result from the group and from others whatever the umask says. */
static int open_temporary(io__output *output)
{
    for (unsigned attempt = 0; attempt < MAX_TRIES; attempt++) {
        struct timespec now = {0};
        char name[80];
        clock_gettime(CLOCK_REALTIME, &now);
        snprintf(name, sizeof name, ".crevice-%ld-%lx%lx-%u.tmp", (long)getpid(),
                 (unsigned long)now.tv_sec, (unsigned long)now.tv_nsec, attempt);
        free(output->temporary);
        output->temporary = beside(output->target, folder_length(output->target), name);
        if (!output->temporary) {
            errno = ENOMEM;
            return -1;
        }
        const int descriptor =
            open(output->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0)
            return descriptor;
        if (errno != EEXIST)
            return -1;
    }
    return -1;
}

int io__output_open(io__output *output, const char *path, const crv_logger *log)
{
    io__output made = {.path = path, .log = log};
    if (follow_links(path, &made.target, log))
        return -1;
    if (check_target(made.target, path, log)) {
        free(made.target);
        return -1;
    }
    const int descriptor = open_temporary(&made);
    struct stat former;
    if (descriptor >= 0 && !stat(made.target, &former)) {
        /* What is replaced keeps its permissions; if that is refused, as some
         * network's file systems do, the picture matters more. */
        if (fchmod(descriptor, former.st_mode & 07777))
            errno = 0;
    }
    if (descriptor >= 0)
        made.stream = fdopen(descriptor, "wb");
    if (!made.stream) {
        io__output_fail(&made);
        if (descriptor >= 0) {
            close(descriptor);
            unlink(made.temporary);
        }
        free(made.target);
        free(made.temporary);
        return -1;
    }
    *output = made;
    return 0;
}

int io__output_fail(const io__output *output)
{
    const int reason = errno;
    if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG)
        return io__fail(output->log, output->path,
                        "cannot be written (%s); free some space", strerror(reason));
    return io__fail(output->log, output->path,
                    "cannot be written (%s); choose another place",
                    reason ? strerror(reason) : "unknown reason");
}

void io__output_discard(io__output *output)
{
    if (output->stream)
        fclose(output->stream);
    if (output->temporary)
        unlink(output->temporary);
    free(output->target);
    free(output->temporary);
    memset(output, 0, sizeof *output);
}

int io__output_commit(io__output *output)
{
    /* fsync before the rename: otherwise a power cut could leave the new name with no
     * data behind it, and the old picture gone. */
    errno = 0;
    bool written = !ferror(output->stream) && !fflush(output->stream)
                   && !fsync(fileno(output->stream));
    int reason = errno;
    if (fclose(output->stream) && written) {
        written = false;
        reason = errno;
    }
    output->stream = NULL;
    if (written && rename(output->temporary, output->target)) {
        written = false;
        reason = errno;
    }
    if (written) {
        free(output->temporary);
        output->temporary = NULL; /* it has become the target */
    } else {
        errno = reason;
        io__output_fail(output);
    }
    io__output_discard(output);
    return written ? 0 : -1;
}
