/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L

#include "heatmap_file.h"

#include <string.h>
#include <strings.h>

#include "heatmap.h"
#include "output.h"

static bool ends_in(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');

    return dot && strcasecmp(dot, extension) == 0;
}

int heatmap_check(const char *path, const char *input_a, const char *input_b, report *r)
{
    if (!ends_in(path, ".png") && !ends_in(path, ".exr")) {
        report_error(r, "%s: a heat map is a .png or .exr; give it such a name", path);
        return EXIT_USAGE;
    }
    const int result = output_check(path, input_a, r);
    return result == EXIT_DONE ? output_check(path, input_b, r) : result;
}

int heatmap_write(const char *path, const heatmap_source *source, report *r)
{
    static const char *const names[] = {"R", "G", "B", "error"};
    const io_write_options options = {.srgb = true};
    const int32_t channels = ends_in(path, ".exr") ? 4 : 3;
    const size_t count = (size_t)source->width * (size_t)source->height;
    io_image image = {0};

    if (io_image_init(&image, source->width, source->height, names, channels, &r->logger)
        != 0)
        return EXIT_FAILED;
    heatmap_fill(source->a, source->b, source->mask, count, source->scale,
                 image.channels[0].data, image.channels[1].data, image.channels[2].data);
    for (size_t i = 0; channels == 4 && i < count; i++)
        if (!source->mask || source->mask[i])
            image.channels[3].data[i] = source->a[i] - source->b[i];
    const int result = output_write(path, &image, &options, r);
    io_image_free(&image);
    return result;
}
