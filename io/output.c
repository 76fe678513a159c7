/* SPDX-License-Identifier: MIT */
/* output.c: the file that a picture is written to, with messages. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "internal.h"

static void remove_leftovers(const char *target, const crv_logger *log)
{
    char *folder = file_beside(target, ".");
    const int removed = folder ? new_file_remove_leftovers(folder) : 0;
    if (removed)
        io__info(log, folder, "%d temporary file%s of a run that was killed %s removed",
                 removed, removed == 1 ? "" : "s", removed == 1 ? "is" : "are");
    free(folder);
}

int io__output_open(io__output *output, const char *path, const crv_logger *log)
{
    io__output made = {.path = path, .log = log};
    char *target = io__writable_target(path, log);
    if (!target)
        return -1;
    remove_leftovers(target, log);
    const bool opened = new_file_open(&made.file, target);
    const int reason = errno;
    free(target);
    errno = reason;
    if (!opened)
        return io__output_fail(&made);
    *output = made;
    return 0;
}

int io__output_fail(const io__output *output)
{
    const int reason = errno;
    return io__fail(output->log, output->path, "cannot be written (%s); %s",
                    reason ? strerror(reason) : "unknown reason", new_file_cure(reason));
}

void io__output_discard(io__output *output)
{
    new_file_discard(&output->file);
}

void io__tell(const io_watch *watch, int64_t done, int64_t count)
{
#ifdef _OPENMP
    if (omp_get_thread_num() != 0)
        return;
#endif
    if (watch)
        watch->tell(watch->user, (double)done / (double)count);
}

bool io__output_stops(const io__output *output)
{
    return output->stop && output->stop();
}

int io__output_stopped(const io__output *output)
{
    return io__fail(output->log, output->path, "is not written: interrupted");
}

int io__output_commit(io__output *output)
{
    return new_file_commit(&output->file) ? 0 : io__output_fail(output);
}
