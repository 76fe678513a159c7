/* SPDX-License-Identifier: MIT */
#include "cloud.h"

#include <math.h>
#include <stdlib.h>

void io__load_position(const io_image *image, size_t i, float p[3])
{
    for (int c = 0; c < 3; c++)
        p[c] = image->channels[c].data[i];
}

bool io__is_position(const float p[3])
{
    bool zero = true;
    for (int c = 0; c < 3; c++) {
        if (!(fabsf(p[c]) < IO__NOWHERE))
            return false;
        zero = zero && !(fabsf(p[c]) > 0.0f);
    }
    return !zero;
}

bool io__is_position_at(const io_image *image, int32_t x, int32_t y)
{
    float p[3];
    io__load_position(image, (size_t)y * (size_t)image->width + (size_t)x, p);
    return io__is_position(p);
}

/* Filtered positions at the border to nothing are drawn to 0, 0, 0. Those between two
 * surfaces stay on their ray. */
static bool is_inside(const io_image *image, int32_t x, int32_t y)
{
    return (x == 0 || io__is_position_at(image, x - 1, y))
           && (y == 0 || io__is_position_at(image, x, y - 1))
           && (x == image->width - 1 || io__is_position_at(image, x + 1, y))
           && (y == image->height - 1 || io__is_position_at(image, x, y + 1));
}

int io__collect_positions(const io_image *image, int32_t step, io__cloud *out)
{
    const size_t most = ((size_t)image->width / (size_t)step + 1)
                        * ((size_t)image->height / (size_t)step + 1);
    out->position = malloc(most * sizeof *out->position);
    out->pixel = malloc(most * sizeof *out->pixel);
    if (!out->position || !out->pixel)
        return -1;
    for (int32_t y = step / 2; y < image->height; y += step)
        for (int32_t x = step / 2; x < image->width; x += step) {
            float p[3];
            io__load_position(image, (size_t)y * (size_t)image->width + (size_t)x, p);
            if (!io__is_position(p) || !is_inside(image, x, y))
                continue;
            for (int c = 0; c < 3; c++)
                out->position[out->count][c] = (double)p[c];
            out->pixel[out->count][0] = x + 0.5;
            out->pixel[out->count][1] = y + 0.5;
            out->count++;
        }
    return 0;
}
