/* SPDX-License-Identifier: MIT */
/* bytes.c: reading and writing that go on after a signal has interrupted a call. */
#include <errno.h>
#include <unistd.h>

#include "internal.h"

size_t io__read(FILE *stream, void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        errno = 0;
        done += fread((char *)bytes + done, 1, size - done, stream);
        if (done == size || errno != EINTR)
            break;
        clearerr(stream);
    }
    return done;
}

size_t io__write(FILE *stream, const void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        errno = 0;
        done += fwrite((const char *)bytes + done, 1, size - done, stream);
        if (done == size || errno != EINTR)
            break;
        clearerr(stream);
    }
    return done;
}

int64_t io__read_at(int descriptor, void *bytes, uint64_t size, uint64_t offset)
{
    uint64_t done = 0;
    while (done < size) {
        const ssize_t n =
            pread(descriptor, (char *)bytes + done, size - done, (off_t)(offset + done));
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

int io__write_at(int descriptor, const void *bytes, uint64_t size, uint64_t offset)
{
    uint64_t done = 0;
    while (done < size) {
        const ssize_t n = pwrite(descriptor, (const char *)bytes + done, size - done,
                                 (off_t)(offset + done));
        if (n < 0 && errno == EINTR)
            continue;
        if (n == 0)
            errno = ENOSPC;
        if (n <= 0)
            return -1;
        done += (uint64_t)n;
    }
    return 0;
}
