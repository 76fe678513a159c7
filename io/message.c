/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "internal.h"

static void send_line(const crv_logger *log, crv_log_level level, const char *path,
                      const char *format, va_list arguments) IO__PRINTF(4, 0);

static void send_line(const crv_logger *log, crv_log_level level, const char *path,
                      const char *format, va_list arguments)
{
    char line[4096];
    if (!log || !log->fn)
        return;
    int used = snprintf(line, sizeof line, "%s: ", path);
    if (used < 0 || (size_t)used >= sizeof line)
        used = 0;
    vsnprintf(line + used, sizeof line - (size_t)used, format, arguments);
    /* File names and channel names come from outside: they must not break the line. */
    text_clean(line);
    log->fn(log->user, level, line);
}

int io__fail(const crv_logger *log, const char *path, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send_line(log, CRV_LOG_ERROR, path, format, arguments);
    va_end(arguments);
    return -1;
}

void io__warn(const crv_logger *log, const char *path, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send_line(log, CRV_LOG_WARNING, path, format, arguments);
    va_end(arguments);
}

void io__info(const crv_logger *log, const char *path, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send_line(log, CRV_LOG_INFO, path, format, arguments);
    va_end(arguments);
}

void io__list_channels(const io_image *image, char *out, size_t size)
{
    const size_t tail = 32; /* room for "... (N in all)" */
    size_t used = 0;
    out[0] = '\0';
    for (int32_t i = 0; i < image->channel_count; i++) {
        const char *name = image->channels[i].name;
        if (used + strlen(name) + 2 + tail >= size) {
            snprintf(out + used, size - used, ", ... (%d in all)",
                     (int)image->channel_count);
            return;
        }
        int n = snprintf(out + used, size - used, "%s%s", i ? ", " : "", name);
        used += n > 0 ? (size_t)n : 0;
    }
}

const char *io__nearest_channel(const io_image *image, const char *wanted)
{
    const char *best = NULL;
    if (strlen(wanted) >= IO_NAME_SIZE)
        return NULL;
    /* More than half of the name wrong is no typing error. */
    size_t limit = strlen(wanted) / 2 + 1;
    for (int32_t i = 0; i < image->channel_count; i++) {
        const size_t distance = text_distance(wanted, image->channels[i].name);
        if (distance < limit) {
            limit = distance;
            best = image->channels[i].name;
        }
    }
    return best;
}

int io__fail_channel(const crv_logger *log, const char *path, const char *wanted,
                     const io_image *image)
{
    char list[1500], hint[IO_NAME_SIZE + 32] = "choose one of them";
    const char *nearest = io__nearest_channel(image, wanted);
    io__list_channels(image, list, sizeof list);
    if (nearest)
        snprintf(hint, sizeof hint, "did you mean \"%s\"?", nearest);
    return io__fail(log, path, "has no channel \"%.300s\" (there are: %s); %s", wanted,
                    list, hint);
}

int io__check_size(const crv_logger *log, const char *path, int64_t width, int64_t height)
{
    if (width < 1 || height < 1)
        return io__fail(log, path,
                        "its size is %lld x %lld pixels; give a picture with at least "
                        "one pixel",
                        (long long)width, (long long)height);
    if (width > CRV_MAX_SIZE || height > CRV_MAX_SIZE)
        return io__fail(log, path,
                        "its size is %lld x %lld pixels, the largest that can be used is "
                        "%d x %d; scale or crop it",
                        (long long)width, (long long)height, CRV_MAX_SIZE, CRV_MAX_SIZE);
    return 0;
}
