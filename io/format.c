/* SPDX-License-Identifier: MIT */
/*
 * format.c: the table of file formats. A new format is a file that fills an io__format,
 * and a line here.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

static const io__format *const formats[] = {&io__format_exr, &io__format_png,
                                            &io__format_pfm};
static const size_t format_count = sizeof formats / sizeof formats[0];

static const char *extension_of(const char *path)
{
    const char *dot = strrchr(file_name(path), '.');
    return dot ? dot : "";
}

static const io__format *format_by_extension(const char *path)
{
    for (size_t i = 0; i < format_count; i++)
        if (text_is_same(extension_of(path), formats[i]->extension))
            return formats[i];
    return NULL;
}

static const io__format *format_for_writing(const char *path, const crv_logger *log)
{
    const io__format *format = format_by_extension(path);
    if (!format && !extension_of(path)[0])
        io__fail(log, path,
                 "has no extension that names a format; use .exr, .png or "
                 ".pfm");
    else if (!format)
        io__fail(log, path, "unknown picture format \"%.60s\"; use .exr, .png or .pfm",
                 extension_of(path));
    return format;
}

bool io_keeps_windows(const char *path)
{
    return format_by_extension(path) == &io__format_exr;
}

bool io_keeps_made(const char *path)
{
    const io__format *format = format_by_extension(path);
    return format == &io__format_exr || format == &io__format_png;
}

int io__file_open(const char *path, const crv_logger *log, io__file *file)
{
    file_facts facts;
    /* Asked before opening, because opening a device can do things; and opened without
     * waiting, because a pipe may have taken the file's place since. */
    if (!file_look(path, &facts))
        return io__fail(log, path, "cannot be opened (%s); check the name",
                        strerror(errno));
    if (facts.is_folder)
        return io__fail(log, path, "is a folder; name a file in it");
    if (!facts.is_regular)
        return io__fail(log, path, "is not a regular file; save the picture to one");
    if (facts.size == 0)
        return io__fail(log, path, "is empty; write it again");
    FILE *stream = file_open(path);
    if (!stream)
        return io__fail(log, path, "cannot be opened (%s); check its permissions",
                        strerror(errno));
    *file = (io__file){.path = path, .stream = stream, .size = facts.size, .log = log};
    return 0;
}

static const io__format *recognise(const io__file *file)
{
    unsigned char head[16];
    const size_t size = io__read(file->stream, head, sizeof head);
    if (size < sizeof head && errno) {
        io__fail(file->log, file->path, "cannot be read (%s); copy it to another disk",
                 strerror(errno));
        return NULL;
    }
    if (fseek(file->stream, 0, SEEK_SET)) {
        io__fail(file->log, file->path, "cannot be read (%s); copy it to a disk",
                 strerror(errno));
        return NULL;
    }
    for (size_t i = 0; i < format_count; i++)
        if (formats[i]->recognises(head, size))
            return formats[i];
    const io__format *claimed = format_by_extension(file->path);
    if (claimed)
        io__fail(file->log, file->path,
                 "is not %s in spite of its name; write it again as EXR, PNG or PFM",
                 claimed->name);
    else
        io__fail(file->log, file->path,
                 "is not a picture in a known format; convert it to EXR, PNG or PFM");
    return NULL;
}

int io_probe(const char *path, io_image *out, const crv_logger *log)
{
    io__file file;
    if (io__file_open(path, log, &file))
        return -1;
    const io__format *format = recognise(&file);
    const int result = format ? format->probe(&file, out) : -1;
    fclose(file.stream);
    return result;
}

int io_read(const char *path, const char *const *names, int32_t count, io_image *out,
            const crv_logger *log)
{
    return io_read_watched(path, names, count, NULL, out, log);
}

int io_read_watched(const char *path, const char *const *names, int32_t count,
                    const io_watch *watch, io_image *out, const crv_logger *log)
{
    io__file file;
    if (names && count < 1)
        return io__fail(log, path, "no channel was asked for; name at least one");
    if (io__file_open(path, log, &file))
        return -1;
    const io__format *format = recognise(&file);
    file.watch = watch;
    const int result = format ? format->read(&file, names, count, out) : -1;
    fclose(file.stream);
    return result;
}

static int check_image(const char *path, const io_image *image, const crv_logger *log)
{
    if (io__check_size(log, path, image->width, image->height)
        || io__check_size(log, path, image->display_width, image->display_height))
        return -1;
    if (image->channel_count < 1 || !image->channels)
        return io__fail(log, path, "there are no channels to write; add one");
    for (int32_t i = 0; i < image->channel_count; i++)
        if (!image->channels[i].data)
            return io__fail(log, path, "channel \"%s\" has no pixels; read them first",
                            image->channels[i].name);
    return 0;
}

int io_write(const char *path, const io_image *image, const io_write_options *options,
             const crv_logger *log)
{
    const io_write_options defaults = {0};
    const io__format *format = format_for_writing(path, log);
    io__output output;
    if (!format || check_image(path, image, log) || io__output_open(&output, path, log))
        return -1;
    output.stop = options ? options->stop : NULL;
    output.watch = options ? options->watch : NULL;
    if (format->write(&output, image, options ? options : &defaults)) {
        io__output_discard(&output);
        return -1;
    }
    return io__output_commit(&output);
}

int io_check_writable(const char *path, const crv_logger *log)
{
    if (!format_for_writing(path, log))
        return -1;
    char *target = io__writable_target(path, log);
    free(target);
    return target ? 0 : -1;
}
