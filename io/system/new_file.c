/* SPDX-License-Identifier: MIT */
/*
 * A writer holds a lock on its temporary file, which ends with the process however it
 * ends: a file of such a name that can be locked is nobody's any more.
 */
#include "new_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "file.h"
#include "text.h"

#define PREFIX ".crevice-"
#define SUFFIX ".tmp"

enum { MAX_TRIES = 100 };

/* Locks the file. new_file_remove_leftovers() of another process may have removed it
 * before, or be about to, if it has the lock. File systems without locks remove nothing.
 */
static bool is_still_ours(int descriptor)
{
    struct stat status;
    if (flock(descriptor, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK)
        return false;
    return fstat(descriptor, &status) || status.st_nlink > 0;
}

/* Opens a file with a name that nobody uses. Made by hand rather than by mkstemp(), which
 * would hide the result from the group and from others whatever the umask says. */
static int open_temporary(new_file *file)
{
    for (unsigned attempt = 0; attempt < MAX_TRIES; attempt++) {
        struct timespec now = {0};
        char name[100];
        clock_gettime(CLOCK_REALTIME, &now);
        snprintf(name, sizeof name, PREFIX "%ld-%lx%lx-%u" SUFFIX, (long)getpid(),
                 (unsigned long)now.tv_sec, (unsigned long)now.tv_nsec, attempt);
        free(file->temporary);
        file->temporary = file_beside(file->target, name);
        if (!file->temporary) {
            errno = ENOMEM;
            return -1;
        }
        const int descriptor =
            open(file->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno != EEXIST)
            return -1;
        if (descriptor >= 0 && is_still_ours(descriptor))
            return descriptor;
        if (descriptor >= 0)
            close(descriptor);
    }
    return -1;
}

bool new_file_open(new_file *file, const char *target)
{
    *file = (new_file){.target = text_copy(target)};
    if (!file->target) {
        errno = ENOMEM;
        return false;
    }
    const int descriptor = open_temporary(file);
    struct stat former;
    if (descriptor >= 0 && !stat(target, &former)) {
        /* What is replaced keeps its permissions; if that is refused, as some
         * network's file systems do, the picture matters more. */
        if (fchmod(descriptor, former.st_mode & 07777))
            errno = 0;
    }
    if (descriptor >= 0)
        file->stream = fdopen(descriptor, "wb");
    if (file->stream)
        return true;
    const int reason = errno;
    if (descriptor >= 0) {
        close(descriptor);
        unlink(file->temporary);
    }
    free(file->target);
    free(file->temporary);
    *file = (new_file){0};
    errno = reason;
    return false;
}

void new_file_discard(new_file *file)
{
    if (file->stream)
        fclose(file->stream);
    if (file->temporary)
        unlink(file->temporary);
    free(file->target);
    free(file->temporary);
    *file = (new_file){0};
}

bool new_file_commit(new_file *file)
{
    /* To disk before the rename: otherwise a power cut could leave the new name with no
     * data behind it, and the old picture gone. */
    errno = 0;
    bool written = !ferror(file->stream) && file_sync(file->stream);
    int reason = errno;
    /* Keeps the lock until the file has its name; closed and unlocked before, it would
     * look like a leftover to another process. */
    const int lock = fcntl(fileno(file->stream), F_DUPFD_CLOEXEC, 0);
    if (fclose(file->stream) && written && errno != EINTR) {
        written = false;
        reason = errno;
    }
    file->stream = NULL;
    if (written && rename(file->temporary, file->target)) {
        written = false;
        reason = errno;
    }
    if (lock >= 0)
        close(lock);
    if (written) {
        free(file->temporary);
        file->temporary = NULL; /* it has become the target */
    }
    new_file_discard(file);
    errno = reason;
    return written;
}

const char *new_file_cure(int reason)
{
    if (reason == ENOSPC || reason == EDQUOT)
        return "free some space";
    return reason == EFBIG ? "raise the limit on the size of files (ulimit -f)"
                           : "choose another place";
}

static bool has_our_name(const char *name)
{
    const size_t length = strlen(name);
    return length > sizeof PREFIX + sizeof SUFFIX
           && !strncmp(name, PREFIX, sizeof PREFIX - 1)
           && !strcmp(name + length + 1 - sizeof SUFFIX, SUFFIX);
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

int new_file_remove_leftovers(const char *folder)
{
    int removed = 0;
    DIR *directory = opendir(folder);
    if (!directory)
        return 0;
    for (const struct dirent *entry = readdir(directory); entry;
         entry = readdir(directory))
        if (has_our_name(entry->d_name))
            removed += remove_if_left(dirfd(directory), entry->d_name);
    closedir(directory);
    return removed;
}
