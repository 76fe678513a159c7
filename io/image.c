/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "internal.h"

/* All channels lie in one block that begins at channels[0].data. */
static int allocate_channels(io_image *image, int32_t count)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    if ((size_t)count > SIZE_MAX / sizeof(float) / pixels)
        return -1;
    io_channel *channels = calloc((size_t)count, sizeof *channels);
    float *data = calloc((size_t)count * pixels, sizeof *data);
    if (!channels || !data) {
        free(channels);
        free(data);
        return -1;
    }
    for (int32_t i = 0; i < count; i++)
        channels[i].data = data + (size_t)i * pixels;
    image->channels = channels;
    image->channel_count = count;
    return 0;
}

int io_image_init(io_image *image, int32_t width, int32_t height,
                  const char *const *names, int32_t count, const crv_logger *log)
{
    io_image made = {.width = width,
                     .height = height,
                     .display_width = width,
                     .display_height = height,
                     .pixel_aspect = 1.0f};
    if (io__check_size(log, "new picture", width, height))
        return -1;
    if (count < 1)
        return io__fail(log, "new picture", "has no channels; name at least one");
    for (int32_t i = 0; i < count; i++)
        if (!names[i] || !names[i][0] || strlen(names[i]) >= IO_NAME_SIZE)
            return io__fail(log, "new picture",
                            "the name of channel %d is empty or longer than %d bytes; "
                            "use another",
                            (int)i, IO_NAME_SIZE - 1);
    if (allocate_channels(&made, count))
        return io__fail(log, "new picture",
                        "no memory for %d channels of %d x %d pixels; use a smaller "
                        "picture or fewer channels",
                        (int)count, (int)width, (int)height);
    for (int32_t i = 0; i < count; i++)
        memcpy(made.channels[i].name, names[i], strlen(names[i]) + 1);
    *image = made;
    return 0;
}

void io_image_free(io_image *image)
{
    if (!image)
        return;
    if (image->channels)
        free(image->channels[0].data);
    free(image->channels);
    memset(image, 0, sizeof *image);
}

io_channel *io_image_find(const io_image *image, const char *name)
{
    for (int32_t i = 0; i < image->channel_count; i++)
        if (!strcmp(image->channels[i].name, name))
            return &image->channels[i];
    return NULL;
}

int io__select_channels(const io__file *file, io_image *all, const char *const *names,
                        int32_t count, io_image *out)
{
    if (!names) {
        *out = *all;
        return 0;
    }
    const size_t bytes = (size_t)all->width * (size_t)all->height * sizeof(float);
    io_image chosen = {0};
    int result = io_image_init(&chosen, all->width, all->height, names, count, file->log);
    for (int32_t i = 0; !result && i < count; i++) {
        const io_channel *channel = io_image_find(all, names[i]);
        if (channel)
            memcpy(chosen.channels[i].data, channel->data, bytes);
        else
            result = io__fail_channel(file->log, file->path, names[i], all);
    }
    if (result)
        io_image_free(&chosen);
    else
        *out = chosen;
    io_image_free(all);
    return result;
}

static const char *const grey_names[] = {"Y", "A"};
static const char *const colour_names[] = {"R", "G", "B", "A"};

int io__image_init_colour(io_image *image, int32_t width, int32_t height,
                          int32_t channels, const io__file *file)
{
    return io_image_init(image, width, height, channels < 3 ? grey_names : colour_names,
                         channels, file->log);
}

int io__probe_colour(const io__file *file, int32_t width, int32_t height,
                     int32_t channels, io_image *out)
{
    io_image probed = {0};
    /* One pixel's worth of channels, given the real size afterwards. */
    if (io__image_init_colour(&probed, 1, 1, channels, file))
        return -1;
    free(probed.channels[0].data);
    for (int32_t i = 0; i < channels; i++)
        probed.channels[i].data = NULL;
    probed.width = probed.display_width = width;
    probed.height = probed.display_height = height;
    *out = probed;
    return 0;
}

int io__colour_channels(const io_image *image, int32_t index[3], const char *path,
                        const char *format, const crv_logger *log)
{
    static const char *const rgb[] = {"R", "G", "B"};
    const int count = (int)image->channel_count;
    if (count != 1 && count != 3)
        return io__fail(log, path,
                        "%s takes one channel (grey) or three (R, G, B), not %d; write "
                        ".exr for other channels",
                        format, count);
    for (int32_t i = 0; i < count; i++) {
        const io_channel *named = io_image_find(image, rgb[i]);
        index[i] = count == 3 && named ? (int32_t)(named - image->channels) : i;
    }
    return count;
}

crv_image io_image_view(const io_image *image, int32_t first, int32_t channels)
{
    const ptrdiff_t row = (ptrdiff_t)image->width * (ptrdiff_t)sizeof(float);
    return (crv_image){.data = image->channels[first].data,
                       .width = image->width,
                       .height = image->height,
                       .channels = channels,
                       .row_stride = row,
                       .pixel_stride = sizeof(float),
                       .channel_stride = row * image->height};
}

void io_copy_window(const io_image *from, const float *source, const io_image *to,
                    float *target)
{
    const int32_t dx = to->data_x - from->data_x, dy = to->data_y - from->data_y;
    const int32_t first = dx < 0 ? -dx : 0;
    const int32_t last = to->width < from->width - dx ? to->width : from->width - dx;
    if (first >= last)
        return;
    for (int32_t y = 0; y < to->height; y++) {
        const int32_t source_y = y + dy;
        if (source_y < 0 || source_y >= from->height)
            continue;
        memcpy(target + (size_t)y * (size_t)to->width + first,
               source + (ptrdiff_t)source_y * from->width + first + dx,
               (size_t)(last - first) * sizeof *target);
    }
}
