/* SPDX-License-Identifier: MIT */
/* bytes.c: reading and writing that go on after a signal has interrupted a call. */
#include <errno.h>

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
