/* SPDX-License-Identifier: MIT */
/*
 * folder.c: files that are no pictures, and folders for many files.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "internal.h"

static int write_all(const io__output *output, const void *bytes, size_t size)
{
    return io__write(output->stream, bytes, size) == size ? 0 : io__output_fail(output);
}

int io_write_bytes(const char *path, const void *bytes, size_t size,
                   const crv_logger *log)
{
    io__output output;
    if (io__output_open(&output, path, log))
        return -1;
    if (write_all(&output, bytes, size)) {
        io__output_discard(&output);
        return -1;
    }
    return io__output_commit(&output);
}

/* Zeros, brought to disk: some file systems find out no earlier that they are full. */
static int fill(const io__output *output, size_t room)
{
    static const char zeros[1 << 16];
    while (room > 0) {
        const size_t part = room < sizeof zeros ? room : sizeof zeros;
        if (write_all(output, zeros, part))
            return -1;
        room -= part;
    }
    return io__output_flush(output) ? io__output_fail(output) : 0;
}

int io_check_room(const char *path, size_t room, const crv_logger *log)
{
    io__output output;
    if (io__output_open(&output, path, log))
        return -1;
    int result = fill(&output, room);
    io__output_discard(&output);
    return result;
}

static int try_room(const char *path, size_t room, const crv_logger *log)
{
    static const char name[] = "/.crevice-room";
    char *inside = malloc(strlen(path) + sizeof name);
    if (!inside)
        return io__fail(log, path, "no memory to write to it; close other programs");
    memcpy(inside, path, strlen(path));
    memcpy(inside + strlen(path), name, sizeof name);
    io__output output;
    int result = io__output_open(&output, inside, log);
    if (!result) {
        /* Messages name the folder; the file is nobody's business. */
        output.path = path;
        result = fill(&output, room);
        io__output_discard(&output);
    }
    free(inside);
    return result;
}

int io_make_folder(const char *path, size_t room, bool *made, const crv_logger *log)
{
    struct stat status;
    bool is_new = false;
    if (!path[0])
        return io__fail(log, "output", "the folder's name is empty; give one");
    if (stat(path, &status)) {
        if (mkdir(path, 0777))
            return io__fail(log, path, "the folder cannot be made (%s); %s",
                            strerror(errno),
                            errno == ENOENT ? "make the folder around it first"
                                            : "choose another place");
        is_new = true;
    } else if (!S_ISDIR(status.st_mode)) {
        return io__fail(log, path, "is a file, not a folder; choose another name");
    } else if (access(path, W_OK | X_OK)) {
        return io__fail(log, path, "the folder may not be written (%s); choose another",
                        strerror(errno));
    }
    if (try_room(path, room, log)) {
        if (is_new)
            rmdir(path);
        return -1;
    }
    if (made)
        *made = is_new;
    return 0;
}
