/* SPDX-License-Identifier: MIT */
#include "paint.h"

#include <math.h>
#include <stdbool.h>

#include "common/heatmap.h"
#include "io.h"

/* Steps of the heat map's colours on each side; more than a byte can tell apart. */
enum { HEAT_STEPS = 1024 };
/* Of the sRGB curve: its steepest part spans a fifth of a byte's step in one. */
enum { CURVE_STEPS = 16384 };

static uint32_t pixel(uint8_t r, uint8_t g, uint8_t b)
{
    return 0xff000000u | (uint32_t)r << 16 | (uint32_t)g << 8 | b;
}

/* io_quantise(), which is too far away to be made a loop of vectors. */
static inline uint32_t grey_of(float accessibility)
{
    const float value = accessibility > 0.0f ? accessibility : 0.0f;
    return (uint32_t)((value < 1.0f ? value : 1.0f) * 255.0f + 0.5f);
}

void paint_grey(const float *accessibility, size_t count, uint32_t *out)
{
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (size_t i = 0; i < count; i++) {
        out[i] = 0xff000000u | grey_of(accessibility[i]) * 0x010101u;
    }
}

void paint_lit(const float *dark, const float *light, const float *accessibility,
               size_t count, uint32_t *out)
{
    uint8_t curve[CURVE_STEPS + 1];
    for (int i = 0; i <= CURVE_STEPS; i++)
        curve[i] = (uint8_t)io_quantise((float)i / CURVE_STEPS, true, 255);
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (size_t i = 0; i < count; i++) {
        uint8_t byte[3];
        for (size_t c = 0; c < 3; c++) {
            const float low = dark ? dark[3 * i + c] : 0.0f;
            const float value = low + accessibility[i] * (light[3 * i + c] - low);
            const float inside = value > 0.0f ? fminf(value, 1.0f) : 0.0f; /* NaN: 0 */
            byte[c] = curve[(int)(inside * CURVE_STEPS + 0.5f)];
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

/* A row of squares, 8 pixels wide. */
static void paint_squares(const float *instead, int32_t from, int32_t width, int32_t y,
                          uint32_t *row)
{
    for (int32_t x = from; x < width; x++) {
        uint32_t grey = (x / 8 + y / 8) % 2 == 0 ? 96 : 112;
        if (instead)
            grey = (grey + grey_of(instead[x])) / 2;
        row[x] = 0xff000000u | grey * 0x010101u;
    }
}

void paint_unknown(const float *instead, size_t first, size_t count, int32_t width,
                   uint32_t *out)
{
    const int32_t rows = (int32_t)(count / (size_t)width);
    const int32_t first_row = (int32_t)(first / (size_t)width);
    const int32_t first_column = (int32_t)(first % (size_t)width);
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (int32_t y = first_row; y < rows; y++) {
        const size_t begin = (size_t)y * (size_t)width;
        paint_squares(instead ? instead + begin : NULL, y == first_row ? first_column : 0,
                      width, y, out + begin);
    }
}
