/* SPDX-License-Identifier: MIT */
#include "read.h"

#include <string.h>

#include "internal.h"

static bool same_window(const io_image *a, const io_image *b)
{
    return a->width == b->width && a->height == b->height && a->data_x == b->data_x
           && a->data_y == b->data_y;
}

/* For files whose parts were cropped one by one: depth decides the window. */
static int read_apart(const char *path, const char *const *names, int32_t layers,
                      int32_t count, io_image *out, const crv_logger *log)
{
    io_image depth = {0}, normals = {0}, both = {0};
    if (io_read(path, names, layers, &depth, log))
        return -1;
    int result = io_read(path, names + layers, count - layers, &normals, log);
    if (!result)
        result = io_image_init(&both, depth.width, depth.height, names, count, log);
    if (!result) {
        io_channel *channels = both.channels;
        both = depth;
        both.channels = channels;
        both.channel_count = count;
        for (int32_t i = 0; i < count; i++) {
            const io_image *from = i < layers ? &depth : &normals;
            /* The rest stays zero, which is "no normal here". */
            io_copy_window(from, from->channels[i < layers ? i : i - layers].data, &both,
                           channels[i].data);
        }
        if (!same_window(&depth, &normals))
            io__info(log, path,
                     "normals lie in another data window than depth; they are "
                     "used where they overlap");
        *out = both;
    }
    io_image_free(&depth);
    io_image_free(&normals);
    return result;
}

int32_t io__depth_channels(const io__pass_names *chosen)
{
    return chosen->position[0] ? 3 : chosen->layers;
}

int io__read_passes(const char *path, const io__pass_names *chosen, const io_watch *watch,
                    io_image *out, const crv_logger *log)
{
    const char *names[CRV_MAX_LAYERS + 3];
    int32_t count = io__depth_channels(chosen);
    memcpy(names, chosen->position[0] ? chosen->position : chosen->depth,
           (size_t)count * sizeof *names);
    if (!chosen->normal[0])
        return io_read_watched(path, names, count, watch, out, log);
    for (int c = 0; c < 3; c++)
        names[count++] = chosen->normal[c];
    if (!io_read_watched(path, names, count, watch, out, NULL))
        return 0;
    return read_apart(path, names, io__depth_channels(chosen), count, out, log);
}
