/* SPDX-License-Identifier: MIT */
#include "bent.h"

#include <stdio.h>

#include "common/estimate.h"
#include "common/output.h"

const char *const bent_spaces[] = {"view", "world", NULL};

bool bent_is_there(const io_image *result)
{
    return result->channel_count == 4;
}

void bent_name(const char *layer, int32_t k, char out[IO_NAME_SIZE])
{
    snprintf(out, IO_NAME_SIZE, "%.250s.%c", layer, "?XYZ"[k]);
}

int bent_check(const bent_settings *s, const crv_options *options, const char *output,
               report *r)
{
    const bool on = options->bent_normal;
    if (!on && (s->space.given || s->output))
        report_error(r, "%s: is for bent normals; add --bent-normal on",
                     s->output ? "--bent-output" : "--bent-space");
    else if (s->output && io_is_same_file(s->output, output))
        report_error(r, "--bent-output: is the file of the result, too; choose another "
                        "name");
    else
        return on ? estimate_check_method("--bent-normal", "bent_normal", options->method,
                                          r)
                  : EXIT_DONE;
    return EXIT_USAGE;
}

void bent_turn(io_image *result, const double to_view[9])
{
    const size_t count = (size_t)result->width * (size_t)result->height;
    float *const v[3] = {result->channels[1].data, result->channels[2].data,
                         result->channels[3].data};
    for (size_t i = 0; i < count; i++) {
        double turned[3]; /* by the transpose, which is the inverse */
        for (int k = 0; k < 3; k++)
            turned[k] = to_view[k] * (double)v[0][i] + to_view[3 + k] * (double)v[1][i]
                        + to_view[6 + k] * (double)v[2][i];
        for (int k = 0; k < 3; k++)
            v[k][i] = (float)turned[k];
    }
}

io_image bent_left_out(const io_image *result)
{
    io_image alone = *result;
    alone.channel_count = 1;
    return alone;
}

/* n / 2 + 1/2; no direction is grey. */
static void encode(io_image *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (int32_t k = 0; k < 3; k++)
        for (size_t i = 0; i < count; i++)
            image->channels[k].data[i] = 0.5f + 0.5f * image->channels[k].data[i];
}

int bent_write(const char *path, const io_image *result, const io_write_options *options,
               report *r)
{
    static const char *const vectors[] = {"bent.X", "bent.Y", "bent.Z"};
    static const char *const colours[] = {"R", "G", "B"};
    const bool exr = io_keeps_windows(path), png = !exr && io_keeps_made(path);
    /* Formats without windows get the whole picture. */
    const int32_t width = exr ? result->width : result->display_width;
    const int32_t height = exr ? result->height : result->display_height;
    io_image image = {0};
    if (io_image_init(&image, width, height, exr ? vectors : colours, 3, &r->logger) != 0)
        return EXIT_FAILED;
    io_image described = *result;
    described.width = width;
    described.height = height;
    described.data_x = exr ? result->data_x : 0;
    described.data_y = exr ? result->data_y : 0;
    described.channel_count = 3;
    described.channels = image.channels;
    for (int32_t k = 0; k < 3; k++)
        io_copy_window(result, result->channels[1 + k].data, &described,
                       image.channels[k].data);
    if (png)
        encode(&image);
    const int code = output_write(path, &described, options, r);
    io_image_free(&image);
    return code;
}
