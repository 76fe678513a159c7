/* SPDX-License-Identifier: MIT */
#include "output.h"

#include <stdio.h>

#include "progress.h"
#include "system/interrupt.h"

/* To bring the bytes to disk; what is not packed then is given up before. */
enum { GRACE_S = 5 };

int output_spare(const char *path, const char *input, report *r)
{
    if (!input || !io_is_same_file(path, input))
        return EXIT_DONE;
    report_error(r, "%s: is an input; choose another name for the output", path);
    return EXIT_USAGE;
}

int output_check(const char *path, const char *input, report *r)
{
    const int result = output_spare(path, input, r);
    if (result != EXIT_DONE)
        return result;
    return io_check_writable(path, &r->logger) == 0 ? EXIT_DONE : EXIT_FAILED;
}

int output_write(const char *path, const io_image *image, const io_write_options *options,
                 report *r)
{
    io_write_options with_stop = options ? *options : (io_write_options){0};
    progress p = progress_begin(r, path, 0, PROGRESS_SHARES);
    const io_watch watch = {progress_share, &p};
    with_stop.stop = interrupt_is_late;
    with_stop.watch = &watch;
    /* io_write() goes through a temporary file, which a signal in the middle would leave
     * behind. */
    interrupt_hold(GRACE_S);
    const int written = io_write(path, image, &with_stop, &r->logger);
    progress_end(&p);
    interrupt_release();
    if (written != 0)
        return EXIT_FAILED;
    report_info(r, "wrote %s", path);
    return EXIT_DONE;
}

int output_append(const char *input, const char *path, const io_addition *additions,
                  int32_t count, const io_append_options *options, report *r)
{
    io_append_options with_stop = *options;
    progress p = progress_begin(r, path, 0, PROGRESS_SHARES);
    const io_watch watch = {progress_share, &p};
    with_stop.stop = interrupt_is_late;
    with_stop.watch = &watch;
    interrupt_hold(GRACE_S);
    const int written = io_append(input, path, additions, count, &with_stop, &r->logger);
    progress_end(&p);
    interrupt_release();
    if (written != 0)
        return EXIT_FAILED;
    report_info(r, "wrote %s", path);
    return EXIT_DONE;
}
