/* SPDX-License-Identifier: MIT */
/*
 * atomic_write.c: a result appears under its name when it is complete and on disk, or not
 * at all.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "internal.h"

enum { MAX_TRIES = 100 };

/* Locks the file, for io__remove_leftovers() of another process: that may have removed
 * it before, or be about to, if it has the lock. File systems without locks remove
 * nothing. */
static bool is_still_ours(int descriptor)
{
    struct stat status;
    if (flock(descriptor, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK)
        return false;
    return fstat(descriptor, &status) || status.st_nlink > 0;
}

/* Opens a file with a name that nobody uses. Made by hand rather than by mkstemp(), which
 * would hide the result from the group and from others whatever the umask says. */
static int open_temporary(io__output *output)
{
    for (unsigned attempt = 0; attempt < MAX_TRIES; attempt++) {
        struct timespec now = {0};
        char name[100];
        clock_gettime(CLOCK_REALTIME, &now);
        snprintf(name, sizeof name,
                 IO__TEMPORARY_PREFIX "%ld-%lx%lx-%u" IO__TEMPORARY_SUFFIX,
                 (long)getpid(), (unsigned long)now.tv_sec, (unsigned long)now.tv_nsec,
                 attempt);
        free(output->temporary);
        output->temporary = io__beside(output->target, name);
        if (!output->temporary) {
            errno = ENOMEM;
            return -1;
        }
        const int descriptor =
            open(output->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno != EEXIST)
            return -1;
        if (descriptor >= 0 && is_still_ours(descriptor))
            return descriptor;
        if (descriptor >= 0)
            close(descriptor);
    }
    return -1;
}

int io__output_open(io__output *output, const char *path, const crv_logger *log)
{
    io__output made = {.path = path, .log = log};
    made.target = io__writable_target(path, log);
    if (!made.target)
        return -1;
    char *folder = io__beside(made.target, ".");
    if (folder)
        io__remove_leftovers(folder, log);
    free(folder);
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

bool io__output_stops(const io__output *output)
{
    return output->stop && output->stop();
}

int io__output_stopped(const io__output *output)
{
    return io__fail(output->log, output->path, "is not written: interrupted");
}

int io__output_flush(const io__output *output)
{
    int result = 0;
    do {
        errno = 0;
        result = fflush(output->stream);
    } while (result && errno == EINTR);
    while (!result) {
        result = fsync(fileno(output->stream));
        if (!result)
            return 0;
        if (errno == EINTR)
            result = 0;
    }
    return -1;
}

int io__output_commit(io__output *output)
{
    /* fsync before the rename: otherwise a power cut could leave the new name with no
     * data behind it, and the old picture gone. */
    errno = 0;
    bool written = !ferror(output->stream) && !io__output_flush(output);
    int reason = errno;
    /* Keeps the lock until the file has its name; closed and unlocked before, it would
     * look like a leftover to another process. */
    const int lock = fcntl(fileno(output->stream), F_DUPFD_CLOEXEC, 0);
    if (fclose(output->stream) && written && errno != EINTR) {
        written = false;
        reason = errno;
    }
    output->stream = NULL;
    if (written && rename(output->temporary, output->target)) {
        written = false;
        reason = errno;
    }
    if (lock >= 0)
        close(lock);
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
