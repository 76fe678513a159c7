/* SPDX-License-Identifier: MIT */
#include "output.h"

#include <stdio.h>

#include "interrupt.h"

/* To bring the bytes to disk; what is not packed then is given up before. */
enum { GRACE_S = 5 };

int output_spare(const char *path, const char *input, report *r)
{
    if (!input || !io_is_same_file(path, input))
        return EXIT_DONE;
    report_error(r, "%s: is an input; choose another name for the output", path);
    return EXIT_USAGE;
}

int output_spare_all(const char *path, const arg_texts *inputs, report *r)
{
    int result = EXIT_DONE;

    for (int32_t i = 0; i < inputs->count && result == EXIT_DONE; i++)
        result = output_spare(path, inputs->value[i], r);
    return result;
}

int output_check(const char *path, const char *input, report *r)
{
    const int result = output_spare(path, input, r);

    if (result != EXIT_DONE)
        return result;
    return io_check_writable(path, &r->logger) == 0 ? EXIT_DONE : EXIT_FAILED;
}

/* io_write() goes through a temporary file, which a signal in the middle would leave
 * behind. */
int output_guarded(int (*write)(void *data), void *data)
{
    interrupt_hold(GRACE_S);
    const int result = write(data);
    interrupt_release();
    return result;
}

typedef struct picture {
    const char *path;
    const io_image *image;
    const io_write_options *options;
    const crv_logger *log;
} picture;

static int write_picture(void *data)
{
    const picture *p = data;
    io_write_options options = p->options ? *p->options : (io_write_options){0};

    options.stop = interrupt_is_late;
    return io_write(p->path, p->image, &options, p->log);
}

int output_write(const char *path, const io_image *image, const io_write_options *options,
                 report *r)
{
    picture p = {path, image, options, &r->logger};

    if (output_guarded(write_picture, &p) != 0)
        return EXIT_FAILED;
    report_info(r, "wrote %s", path);
    return EXIT_DONE;
}
