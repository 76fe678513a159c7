/* SPDX-License-Identifier: MIT */
/* The CPU backend: walks tiles in parallel and computes their rows with the kernels of
 * the best instruction set, or pixel by pixel with the specification.
 */
#include "core/backend.h"
#include "cpu/isa.h"

#include <math.h>

/* Tiles are small enough that a picture gives every thread many, and wide enough that
 * rows of depth are read along the cache line. */
enum { TILE_WIDTH = 128, TILE_HEIGHT = 16 };

typedef struct tiles {
    const crv__work *work;
    const crv__method *method;
    const crv__filter *filter;
    crv__estimate_kernel estimate_kernel; /* NULL: the specification */
    crv__filter_kernel filter_kernel;
    int32_t pass;
    const crv__plane *input, *out;
    int32_t columns;
    void (*row)(const struct tiles *tiles, int32_t x0, int32_t x1, int32_t y, float *out);
} tiles;

static float clamped(float a)
{
    return a > 0 ? (a < 1 ? a : 1) : 0; /* a NaN would become 0 and be seen */
}

static int is_background(const tiles *t, int32_t x, int32_t y)
{
    return !(*crv__plane_at(&t->work->frame->depth[0], x, y) < INFINITY);
}

static void estimate_row(const tiles *t, int32_t x0, int32_t x1, int32_t y, float *out)
{
    const crv__frame *frame = t->work->frame;
    const crv__params *p = frame->params;
    const int32_t count = x1 - x0;
    if (t->estimate_kernel)
        t->estimate_kernel(frame, x0, x1, y, out);
    for (int32_t i = 0; i < count && !t->estimate_kernel; i++) {
        const float a =
            is_background(t, x0 + i, y) ? 1 : t->method->accessibility(frame, x0 + i, y);
        out[i] = clamped(1 - p->intensity * (1 - a));
    }
    for (int32_t i = 0; i < count && p->contrast != 1; i++)
        out[i] = powf(out[i], p->contrast);
}

static void filter_row(const tiles *t, int32_t x0, int32_t x1, int32_t y, float *out)
{
    const crv__frame *frame = t->work->frame;
    if (t->filter_kernel) {
        t->filter_kernel(frame, t->input, t->pass, x0, x1, y, out);
        return;
    }
    for (int32_t x = x0; x < x1; x++) {
        const float own = *crv__plane_at(t->input, x, y);
        if (is_background(t, x, y))
            out[x - x0] = 1;
        else if (isnan(own)) /* not part of the picture: stays so */
            out[x - x0] = own;
        else
            out[x - x0] = clamped(t->filter->filter(frame, t->input, t->pass, x, y));
    }
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
    for (int32_t y = y0; y < y1; y++)
        t->row(t, x0, x1, y, crv__plane_at(out, x0, y));
}

static void run_tiles(tiles *t)
{
    t->columns = (t->out->width + TILE_WIDTH - 1) / TILE_WIDTH;
    const int32_t rows = (t->out->height + TILE_HEIGHT - 1) / TILE_HEIGHT;
    crv__run_parallel(t->work->setup->context, (uint32_t)t->columns * (uint32_t)rows,
                      run_tile, t);
}

/* The kernels that fit this frame: they index planes with 32 bits and know nothing of
 * fields. */
static const crv__kernels *kernels_for(const crv__work *work)
{
    const crv__plane *depth = &work->frame->depth[0];
    if (work->frame->params->use_field || depth->pitch > INT32_MAX / depth->height)
        return NULL;
    return crv__kernels_best(work->setup->context->isa_mask);
}

static void estimate(const crv__work *work, const crv__plane *out)
{
    const crv__method *method = work->setup->method;
    tiles t = {.work = work,
               .method = method,
               .estimate_kernel =
                   crv__kernels_estimate(kernels_for(work), method->info.name),
               .out = out,
               .row = estimate_row};
    run_tiles(&t);
}

static void filter_pass(const crv__work *work, int32_t pass, const crv__plane *input,
                        const crv__plane *out)
{
    const crv__filter *filter = work->setup->filter;
    tiles t = {.work = work,
               .filter = filter,
               .filter_kernel = crv__kernels_filter(kernels_for(work), filter->info.name),
               .pass = pass,
               .input = input,
               .out = out,
               .row = filter_row};
    run_tiles(&t);
}

static crv_status plan_create(const crv__setup *setup, const crv__plane *rectangle,
                              void **state)
{
    (void)setup;
    (void)rectangle;
    (void)state;
    return CRV_OK;
}

static void plan_destroy(const crv__setup *setup, void *state)
{
    (void)setup;
    (void)state;
}

static crv_status run(const crv__work *work, int filter_only, const crv__plane planes[2],
                      const crv__plane **result)
{
    const int32_t passes = work->setup->filter ? work->setup->filter->passes : 0;
    if (!filter_only)
        estimate(work, &planes[0]);
    for (int32_t pass = 0; pass < passes; pass++)
        filter_pass(work, pass, &planes[pass % 2], &planes[(pass + 1) % 2]);
    *result = &planes[passes % 2];
    return CRV_OK;
}

const crv__backend crv__cpu_backend = {"cpu", plan_create, plan_destroy, run, NULL};
