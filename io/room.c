/* SPDX-License-Identifier: MIT */
/* room.c: whether a disk holds what will be written. */
#include "internal.h"

/* Zeros, brought to disk: some file systems find out no earlier that they are full. */
static int fill(const io__output *output, size_t room)
{
    static const char zeros[1 << 16];
    while (room > 0) {
        const size_t part = room < sizeof zeros ? room : sizeof zeros;
        if (io__write(output->file.stream, zeros, part) != part)
            return io__output_fail(output);
        room -= part;
    }
    return file_sync(output->file.stream) ? 0 : io__output_fail(output);
}

int io_check_room(const char *path, size_t room, const crv_logger *log)
{
    io__output output;
    if (io__output_open(&output, path, log))
        return -1;
    const int result = fill(&output, room);
    io__output_discard(&output);
    return result;
}
