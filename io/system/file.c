/* SPDX-License-Identifier: MIT */
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static file_facts facts_of(const struct stat *status)
{
    return (file_facts){.is_folder = S_ISDIR(status->st_mode),
                        .is_regular = S_ISREG(status->st_mode),
                        .size = (int64_t)status->st_size};
}

bool file_look(const char *path, file_facts *facts)
{
    struct stat status;
    if (stat(path, &status))
        return false;
    *facts = facts_of(&status);
    return true;
}

bool file_exists(const char *path)
{
    return access(path, F_OK) == 0;
}

bool file_is_same(const char *a, const char *b)
{
    struct stat first, second;
    return !stat(a, &first) && !stat(b, &second) && first.st_dev == second.st_dev
           && first.st_ino == second.st_ino;
}

bool file_may_be_written(const char *path)
{
    return access(path, W_OK) == 0;
}

bool folder_may_be_written(const char *path)
{
    file_facts facts;
    return file_look(path, &facts) && facts.is_folder && access(path, W_OK | X_OK) == 0;
}

const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

char *file_beside(const char *path, const char *name)
{
    const size_t length = name[0] == '/' ? 0 : (size_t)(file_name(path) - path);
    char *joined = malloc(length + strlen(name) + 1);
    if (joined) {
        memcpy(joined, path, length);
        memcpy(joined + length, name, strlen(name) + 1);
    }
    return joined;
}

bool file_link(const char *path, char *out, size_t size)
{
    const ssize_t length = readlink(path, out, size);
    if (length < 0 || (size_t)length >= size)
        return false;
    out[length] = '\0';
    return true;
}

FILE *file_open(const char *path)
{
    struct stat status;
    const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return NULL;
    FILE *file = NULL;
    if (!fstat(descriptor, &status)) {
        if (S_ISREG(status.st_mode))
            file = fdopen(descriptor, "rb");
        else
            errno = EINVAL;
    }
    if (!file) {
        const int reason = errno;
        close(descriptor);
        errno = reason;
    }
    return file;
}

FILE *file_of_bytes(const void *bytes, size_t size)
{
    return fmemopen((void *)(uintptr_t)bytes, size, "rb");
}

int64_t file_read_at(FILE *file, void *bytes, uint64_t size, uint64_t offset)
{
    uint64_t done = 0;
    while (done < size) {
        const ssize_t n = pread(fileno(file), (char *)bytes + done, size - done,
                                (off_t)(offset + done));
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return -1;
        if (n == 0)
            break;
        done += (uint64_t)n;
    }
    return (int64_t)done;
}

bool file_write_at(FILE *file, const void *bytes, uint64_t size, uint64_t offset)
{
    uint64_t done = 0;
    while (done < size) {
        const ssize_t n = pwrite(fileno(file), (const char *)bytes + done, size - done,
                                 (off_t)(offset + done));
        if (n < 0 && errno == EINTR)
            continue;
        if (n == 0)
            errno = ENOSPC;
        if (n <= 0)
            return false;
        done += (uint64_t)n;
    }
    return true;
}

bool file_sync(FILE *file)
{
    int result = 0;
    do {
        errno = 0;
        result = fflush(file);
    } while (result && errno == EINTR);
    while (!result) {
        result = fsync(fileno(file));
        if (!result)
            return true;
        if (errno == EINTR)
            result = 0;
    }
    return false;
}

bool file_is_terminal(FILE *file)
{
    return isatty(fileno(file)) != 0;
}

void file_limit_fails(void)
{
    signal(SIGXFSZ, SIG_IGN);
}
