/* SPDX-License-Identifier: MIT */
#include "shrink.h"

#include <math.h>

int shrink_check(const io_frame *frame, int32_t n, const char *path, report *r)
{
    const int32_t width = frame->image.display_width;
    const int32_t height = frame->image.display_height;
    if (width % n == 0 && height % n == 0)
        return EXIT_DONE;
    report_error(r,
                 "%s: is %dx%d pixels, which --aa %d does not divide; render a multiple "
                 "of the result's size",
                 path, width, height, n);
    return EXIT_FAILED;
}

/* Rounds down, below zero too. */
static int32_t divide(int32_t a, int32_t n)
{
    return a >= 0 ? a / n : -((n - 1 - a) / n);
}

/* The mean of a channel over the block of the result's pixel (x, y), in the display
 * window of the result. */
static double mean(const io_frame *frame, const io_image *ao, int32_t channel, int32_t n,
                   int32_t x, int32_t y)
{
    const float *depth = frame->depth[0].data, *values = ao->channels[channel].data;
    double sum = 0.0;
    int32_t count = 0;
    for (int32_t row = y * n - ao->data_y; row < (y + 1) * n - ao->data_y; row++)
        for (int32_t i = x * n - ao->data_x; i < (x + 1) * n - ao->data_x; i++) {
            if (row < 0 || i < 0 || row >= ao->height || i >= ao->width)
                continue;
            const size_t at =
                (size_t)(row + frame->desc.guard_top) * (size_t)frame->image.width
                + (size_t)(i + frame->desc.guard_left);
            if (!isfinite(depth[at]))
                continue;
            sum += (double)values[(size_t)row * (size_t)ao->width + (size_t)i];
            count++;
        }
    if (count)
        return sum / count;
    return channel ? 0.0 : 1.0;
}

/* Of bent normals the mean is made a direction again. */
static void store_means(const io_frame *frame, const io_image *ao, int32_t n, int32_t x,
                        int32_t y, const io_image *to, size_t at)
{
    double length = 0.0, value[4];
    for (int32_t k = 0; k < ao->channel_count; k++) {
        value[k] = mean(frame, ao, k, n, x, y);
        length += k ? value[k] * value[k] : 0.0;
    }
    for (int32_t k = 0; k < ao->channel_count; k++)
        to->channels[k].data[at] =
            (float)(k && length > 0.0 ? value[k] / sqrt(length) : value[k]);
}

int shrink(const io_frame *frame, int32_t n, io_image *ao, report *r)
{
    const char *names[4] = {NULL};
    const int32_t x0 = divide(ao->data_x, n), y0 = divide(ao->data_y, n);
    const int32_t x1 = divide(ao->data_x + ao->width - 1, n) + 1;
    const int32_t y1 = divide(ao->data_y + ao->height - 1, n) + 1;
    io_image small = {0};
    for (int32_t k = 0; k < ao->channel_count; k++)
        names[k] = ao->channels[k].name;
    if (io_image_init(&small, x1 - x0, y1 - y0, names, ao->channel_count, &r->logger)
        != 0)
        return EXIT_FAILED;
    for (int32_t y = y0; y < y1; y++)
        for (int32_t x = x0; x < x1; x++)
            store_means(frame, ao, n, x, y, &small,
                        (size_t)(y - y0) * (size_t)small.width + (size_t)(x - x0));
    io_image described = *ao;
    described.channels = small.channels;
    described.width = small.width;
    described.height = small.height;
    described.data_x = x0;
    described.data_y = y0;
    described.display_width = ao->display_width / n;
    described.display_height = ao->display_height / n;
    io_image_free(ao);
    *ao = described;
    return EXIT_DONE;
}
