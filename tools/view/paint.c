/* SPDX-License-Identifier: MIT */
#include "paint.h"

#include <math.h>
#include <stdbool.h>

#include "common/heatmap.h"
#include "io.h"

/* Steps of the heat map's colours on each side; more than a byte can tell apart. */
enum { HEAT_STEPS = 1024 };

static uint32_t pixel(uint8_t r, uint8_t g, uint8_t b)
{
    return 0xff000000u | (uint32_t)r << 16 | (uint32_t)g << 8 | b;
}

void paint_grey(const float *accessibility, size_t count, uint32_t *out)
{
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (size_t i = 0; i < count; i++) {
        const uint8_t grey = (uint8_t)io_quantise(accessibility[i], false, 255);
        out[i] = pixel(grey, grey, grey);
    }
}

void paint_lit(const float *dark, const float *light, const float *accessibility,
               size_t count, uint32_t *out)
{
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (size_t i = 0; i < count; i++) {
        uint8_t byte[3];
        for (size_t c = 0; c < 3; c++) {
            const double low = (double)dark[3 * i + c];
            const double value =
                low + (double)accessibility[i] * ((double)light[3 * i + c] - low);
            byte[c] = (uint8_t)io_quantise((float)value, true, 255);
        }
        out[i] = pixel(byte[0], byte[1], byte[2]);
    }
}

static uint32_t screen_colour(const float linear[3])
{
    uint8_t byte[3];
    for (int c = 0; c < 3; c++)
        byte[c] = (uint8_t)io_quantise(linear[c], true, 255);
    return pixel(byte[0], byte[1], byte[2]);
}

void paint_difference(const float *a, const float *b, const uint8_t *surface,
                      double scale, size_t count, uint32_t *out)
{
    uint32_t colours[2 * HEAT_STEPS + 1];
    const float none[3] = {heatmap_background, heatmap_background, heatmap_background};
    for (int k = -HEAT_STEPS; k <= HEAT_STEPS; k++) {
        float linear[3];
        heatmap_colour((double)k / HEAT_STEPS, linear);
        colours[k + HEAT_STEPS] = screen_colour(linear);
    }
    const uint32_t grey = screen_colour(none);
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (size_t i = 0; i < count; i++) {
        const double t = fmin(fmax(((double)a[i] - (double)b[i]) / scale, -1.0), 1.0);
        out[i] = surface[i] ? colours[(int)lround(t * HEAT_STEPS) + HEAT_STEPS] : grey;
    }
}

void paint_unknown(size_t first, size_t count, int32_t width, uint32_t *out)
{
    for (size_t i = first; i < count; i++) {
        const size_t x = i % (size_t)width, y = i / (size_t)width;
        const uint8_t grey = (x / 8 + y / 8) % 2 == 0 ? 96 : 112;
        out[i] = pixel(grey, grey, grey);
    }
}
