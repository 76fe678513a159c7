/* SPDX-License-Identifier: MIT */
/* The CPU backend: walks tiles in parallel and calls the specification for every pixel.
 */
#include "core/backend.h"

#include <math.h>

/* Tiles are small enough that a picture gives every thread many, and wide enough that
 * rows of depth are read along the cache line. */
enum { TILE_WIDTH = 128, TILE_HEIGHT = 16 };

typedef struct tiles {
    const crv__work *work;
    const crv__method *method;
    const crv__filter *filter;
    int32_t pass;
    const crv__plane *input, *out;
    int32_t columns;
    float (*pixel)(const struct tiles *tiles, int32_t x, int32_t y);
} tiles;

static float clamped(float a)
{
    return a > 0 ? (a < 1 ? a : 1) : 0; /* a NaN would become 0 and be seen */
}

static float estimate_pixel(const tiles *t, int32_t x, int32_t y)
{
    const crv__frame *frame = t->work->frame;
    const crv__params *p = frame->params;
    const float raw = t->method->accessibility(frame, x, y);
    if (p->intensity == 1 && p->contrast == 1)
        return clamped(raw);
    return clamped(powf(fmaxf(0, 1 - p->intensity * (1 - raw)), p->contrast));
}

static float filter_pixel(const tiles *t, int32_t x, int32_t y)
{
    const float own = *crv__plane_at(t->input, x, y);
    if (isnan(own)) /* not part of the picture: stays so */
        return own;
    return clamped(t->filter->filter(t->work->frame, t->input, t->pass, x, y));
}

static void run_tile(void *data, uint32_t index)
{
    const tiles *t = data;
    const crv__plane *out = t->out;
    const int32_t x0 = out->x0 + (int32_t)(index % (uint32_t)t->columns) * TILE_WIDTH;
    const int32_t y0 = out->y0 + (int32_t)(index / (uint32_t)t->columns) * TILE_HEIGHT;
    const int32_t right = out->x0 + out->width, bottom = out->y0 + out->height;
    const int32_t x1 = x0 + TILE_WIDTH < right ? x0 + TILE_WIDTH : right;
    const int32_t y1 = y0 + TILE_HEIGHT < bottom ? y0 + TILE_HEIGHT : bottom;
    for (int32_t y = y0; y < y1; y++) {
        for (int32_t x = x0; x < x1; x++) {
            const int background =
                !(*crv__plane_at(&t->work->frame->depth[0], x, y) < INFINITY);
            *crv__plane_at(out, x, y) = background ? 1 : t->pixel(t, x, y);
        }
    }
}

static void run_tiles(tiles *t)
{
    t->columns = (t->out->width + TILE_WIDTH - 1) / TILE_WIDTH;
    const int32_t rows = (t->out->height + TILE_HEIGHT - 1) / TILE_HEIGHT;
    crv__run_parallel(t->work->context, (uint32_t)t->columns * (uint32_t)rows, run_tile,
                      t);
}

static void estimate(const crv__work *work, const crv__method *method,
                     const crv__plane *out)
{
    tiles t = {.work = work, .method = method, .out = out, .pixel = estimate_pixel};
    run_tiles(&t);
}

static void filter_pass(const crv__work *work, const crv__filter *filter, int32_t pass,
                        const crv__plane *input, const crv__plane *out)
{
    tiles t = {.work = work,
               .filter = filter,
               .pass = pass,
               .input = input,
               .out = out,
               .pixel = filter_pixel};
    run_tiles(&t);
}

const crv__backend crv__cpu_backend = {"cpu", estimate, filter_pass};
