/* SPDX-License-Identifier: MIT */
#include "paint.h"

#include <math.h>
#include <stdbool.h>

#include "common/heatmap.h"
#include "io.h"

/* Steps of the heat map's colours on each side; more than a byte can tell apart. */
enum { HEAT_STEPS = 1024, OPAQUE = 255 };

static void put(uint8_t *out, size_t i, uint8_t r, uint8_t g, uint8_t b)
{
    out[4 * i] = r;
    out[4 * i + 1] = g;
    out[4 * i + 2] = b;
    out[4 * i + 3] = OPAQUE;
}

void paint_grey(const float *accessibility, size_t count, uint8_t *out)
{
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (size_t i = 0; i < count; i++) {
        const uint8_t grey = (uint8_t)io_quantise(accessibility[i], false, 255);
        put(out, i, grey, grey, grey);
    }
}

void paint_lit(const float *dark, const float *light, const float *accessibility,
               size_t count, uint8_t *out)
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
        put(out, i, byte[0], byte[1], byte[2]);
    }
}

static void byte_colour(const float linear[3], uint8_t out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = (uint8_t)io_quantise(linear[c], true, 255);
}

void paint_difference(const float *a, const float *b, const uint8_t *surface,
                      double scale, size_t count, uint8_t *out)
{
    uint8_t colours[2 * HEAT_STEPS + 1][3], grey[3];
    const float none[3] = {heatmap_background, heatmap_background, heatmap_background};
    for (int k = -HEAT_STEPS; k <= HEAT_STEPS; k++) {
        float linear[3];
        heatmap_colour((double)k / HEAT_STEPS, linear);
        byte_colour(linear, colours[k + HEAT_STEPS]);
    }
    byte_colour(none, grey);
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (size_t i = 0; i < count; i++) {
        const double t = fmin(fmax(((double)a[i] - (double)b[i]) / scale, -1.0), 1.0);
        const uint8_t *colour =
            surface[i] ? colours[(int)lround(t * HEAT_STEPS) + HEAT_STEPS] : grey;
        put(out, i, colour[0], colour[1], colour[2]);
    }
}

void paint_unknown(size_t first, size_t count, int32_t width, uint8_t *out)
{
    for (size_t i = first; i < count; i++) {
        const size_t x = i % (size_t)width, y = i / (size_t)width;
        const uint8_t grey = (x / 8 + y / 8) % 2 == 0 ? 96 : 112;
        put(out, i, grey, grey, grey);
    }
}
