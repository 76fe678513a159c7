/* SPDX-License-Identifier: MIT */
#include "reading.h"

#include "progress.h"

int reading_picture(const char *path, const char *const *names, int32_t count,
                    io_image *out, const crv_logger *log, report *r)
{
    progress p = progress_begin(r, path, 0, PROGRESS_SHARES);
    const io_watch watch = {progress_share, &p};
    const int result = io_read_watched(path, names, count, &watch, out, log);
    progress_end(&p);
    return result;
}

int reading_frame(const char *path, const io_passes_request *request, io_frame *out,
                  const crv_logger *log, report *r)
{
    progress p = progress_begin(r, path, 0, PROGRESS_SHARES);
    const io_watch watch = {progress_share, &p};
    io_passes_request watched = *request;
    watched.watch = &watch;
    const int result = io_frame_load(path, &watched, out, log);
    progress_end(&p);
    return result;
}
