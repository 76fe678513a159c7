/* SPDX-License-Identifier: MIT */
/* Each side is a straight line in CIELAB from white to a dark end of the same lightness,
 * so equal steps of the error are about equal steps to the eye. */
#include "heatmap.h"

#include <math.h>

#include "output.h"
#include "system/text.h"

static const double white_lightness = 97.0, end_lightness = 35.0;
/* a* and b* of the ends: hues 275 and 55 degrees, as saturated as sRGB holds at that
 * lightness. */
static const double blue_end[2] = {3.0, -38.0}, orange_end[2] = {28.0, 40.0};

const float heatmap_background = 0.2140411f; /* sRGB 0.5 */

static double lab_inverse(double f)
{
    const double delta = 6.0 / 29.0;
    return f > delta ? f * f * f : 3.0 * delta * delta * (f - 4.0 / 29.0);
}

void heatmap_colour(double t, float linear[3])
{
    /* XYZ of D65 white to linear sRGB, IEC 61966-2-1. */
    static const double to_rgb[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                        {-0.9692660, 1.8760108, 0.0415560},
                                        {0.0556434, -0.2040259, 1.0572252}};
    const double size = fmin(fabs(t), 1.0);
    const double *end = t < 0.0 ? blue_end : orange_end;
    const double lightness = white_lightness + (end_lightness - white_lightness) * size;
    const double fy = (lightness + 16.0) / 116.0;
    const double x = 0.9504700 * lab_inverse(fy + end[0] * size / 500.0);
    const double y = lab_inverse(fy);
    const double z = 1.0888300 * lab_inverse(fy - end[1] * size / 200.0);

    for (int i = 0; i < 3; i++) {
        const double value = to_rgb[i][0] * x + to_rgb[i][1] * y + to_rgb[i][2] * z;
        linear[i] = (float)fmin(fmax(value, 0.0), 1.0);
    }
}

void heatmap_fill(const float *a, const float *b, const uint8_t *mask, size_t count,
                  double scale, float *red, float *green, float *blue)
{
    for (size_t i = 0; i < count; i++) {
        float colour[3] = {heatmap_background, heatmap_background, heatmap_background};

        if (!mask || mask[i])
            heatmap_colour(((double)a[i] - (double)b[i]) / scale, colour);
        red[i] = colour[0];
        green[i] = colour[1];
        blue[i] = colour[2];
    }
}

int heatmap_check(const char *path, const char *input_a, const char *input_b, report *r)
{
    if (!text_ends_with(path, ".png") && !text_ends_with(path, ".exr")) {
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
    const int32_t channels = text_ends_with(path, ".exr") ? 4 : 3;
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
