/* SPDX-License-Identifier: MIT */
/* The CPU backend: visits tiles in parallel and computes their rows with the kernels of
 * the best instruction set, or pixel by pixel with the specification.
 */
#include "core/backend.h"
#include "cpu/deinterleaved.h"
#include "cpu/isa.h"

#include <math.h>

/* Tiles are small enough that a picture gives every thread many, and wide enough that
 * rows of depth are read along the cache line; strips of them: see tile_place(). */
enum {
    TILE_WIDTH = 128,
    TILE_HEIGHT = 32,
    TILE_STRIP = 8,
    GROUP_TILE_WIDTH = CRV__TILE_GROUPS,
    GROUP_TILE_HEIGHT = CRV__TILE_ROWS * CRV__PHASES,
    GROUP_TILE_STRIP = 4
};

typedef struct tiles {
    const crv__work *work;
    const crv__method *method;
    const crv__filter *filter;
    crv__estimate_kernel estimate_kernel; /* NULL: the specification */
    crv__bent_kernel bent_kernel;
    crv__filter_kernel filter_kernel;
    crv__deinterleaved_kernel
        group_kernel; /* with di: for groups rather than tiles of pixels */
    const crv__deinterleaved *di;
    int32_t pass;
    const crv__picture *input; /* of a filter's pass */
    const crv__picture *out;
    crv__rectangle area;
    int32_t width, height; /* of a tile: pixels, or groups and rows of pixels */
    int32_t columns, rows;
    void (*row)(const struct tiles *tiles, int32_t x0, int32_t x1, int32_t y);
} tiles;

static float clamped(float a)
{
    return a > 0 ? (a < 1 ? a : 1) : 0; /* a NaN would become 0 and be seen */
}

static int is_background(const tiles *t, int32_t x, int32_t y)
{
    return !(*crv__plane_at(&t->work->frame->depth[0], x, y) < INFINITY);
}

/* A row of a picture, or room for one. */
typedef struct picture_row {
    float *accessibility;
    float *bent[3]; /* NULL: not wanted */
} picture_row;

static picture_row row_of(const crv__picture *picture, int32_t x, int32_t y)
{
    picture_row row = {.accessibility = crv__plane_at(&picture->accessibility, x, y)};
    for (int k = 0; k < 3 && picture->bent[0].data; k++)
        row.bent[k] = crv__plane_at(&picture->bent[k], x, y);
    return row;
}

static void put_bent(const picture_row *row, int32_t i, crv__vec3 bent)
{
    row->bent[0][i] = bent.x;
    row->bent[1][i] = bent.y;
    row->bent[2][i] = bent.z;
}

/* The specification of pixels x0 to x1 - 1. */
static void specify_row(const tiles *t, int32_t x0, int32_t x1, int32_t y,
                        const picture_row *to)
{
    const crv__frame *frame = t->work->frame;
    for (int32_t x = x0; x < x1; x++) {
        crv__estimate e = {.accessibility = 1};
        if (!is_background(t, x, y) && to->bent[0])
            e.accessibility = t->method->estimate(frame, x, y, &e.bent);
        else if (!is_background(t, x, y))
            e.accessibility = t->method->accessibility(frame, x, y);
        to->accessibility[x - x0] =
            clamped(1 - frame->params->intensity * (1 - e.accessibility));
        if (to->bent[0])
            put_bent(to, x - x0, e.bent);
    }
}

static void apply_contrast(const crv__params *p, float *row, int32_t count)
{
    for (int32_t i = 0; i < count && p->contrast != 1; i++)
        row[i] = powf(row[i], p->contrast);
}

static void estimate_pixels(const tiles *t, int32_t x0, int32_t x1, int32_t y,
                            const picture_row *to)
{
    const crv__frame *frame = t->work->frame;
    if (!t->estimate_kernel)
        specify_row(t, x0, x1, y, to);
    else if (to->bent[0])
        t->bent_kernel(frame, x0, x1, y, to->accessibility, to->bent);
    else
        t->estimate_kernel(frame, x0, x1, y, to->accessibility);
    apply_contrast(frame->params, to->accessibility, x1 - x0);
}

/* What is filtered of bent normals is how they deviate from the surface's normals: the
 * mean of the directions themselves would flatten curved surfaces. Zero stands for the
 * normal. */
static void take_deviations(const tiles *t, int32_t x0, int32_t x1, int32_t y,
                            const picture_row *row)
{
    const crv__plane *normal = t->work->frame->normal;
    const float *n[3];
    if (!row->bent[0] || !t->work->setup->filter)
        return;
    for (int k = 0; k < 3; k++)
        n[k] = crv__plane_at(&normal[k], x0, y);
    for (int32_t x = 0; x < x1 - x0; x++) {
        const float any =
            fabsf(row->bent[0][x]) + fabsf(row->bent[1][x]) + fabsf(row->bent[2][x]);
        for (int k = 0; k < 3; k++)
            row->bent[k][x] = any > 0 ? row->bent[k][x] - n[k][x] : 0;
    }
}

/* And bent normals again, once they are filtered. */
static void restore_bent(const tiles *t, int32_t x0, int32_t x1, int32_t y,
                         const picture_row *row)
{
    for (int k = 0; k < 3 && row->bent[k]; k++) {
        const float *n = crv__plane_at(&t->work->frame->normal[k], x0, y);
        for (int32_t x = 0; x < x1 - x0; x++)
            row->bent[k][x] += n[x];
    }
}

static void estimate_row(const tiles *t, int32_t x0, int32_t x1, int32_t y)
{
    const picture_row to = row_of(t->out, x0, y);
    estimate_pixels(t, x0, x1, y, &to);
    take_deviations(t, x0, x1, y, &to);
}

static float filtered(float accessibility, float own, bool background)
{
    if (background)
        return 1;
    return isnan(own) ? own : clamped(accessibility); /* NaN: not part of the picture */
}

static void filter_row(const tiles *t, int32_t x0, int32_t x1, int32_t y)
{
    const picture_row to = row_of(t->out, x0, y);
    for (int32_t x = x0; x < x1; x++) {
        const float own = *crv__plane_at(&t->input->accessibility, x, y);
        const bool background = is_background(t, x, y);
        crv__estimate e = {.accessibility = 1};
        if (!background && !isnan(own))
            e = t->filter->filter(t->work->frame, t->input, t->pass, x, y);
        to.accessibility[x - x0] = filtered(e.accessibility, own, background);
        if (to.bent[0])
            put_bent(&to, x - x0, e.bent);
    }
    if (t->pass + 1 == t->filter->passes)
        restore_bent(t, x0, x1, y, &to);
}

/* The column and row of a tile by its number. They are visited in strips from the top to
 * the bottom: what the samples of a row of tiles read is read again by the next, and of
 * a wide picture's whole row it would not stay in the cache until then. */
static void tile_place(uint32_t index, int32_t columns, int32_t rows, int32_t strip,
                       int32_t *column, int32_t *row)
{
    if (columns <= 2 * strip) /* all of them stay */
        strip = columns;
    const int32_t first = (int32_t)(index / (uint32_t)(strip * rows)) * strip;
    const int32_t width = columns - first < strip ? columns - first : strip;
    const int32_t rest = (int32_t)(index - (uint32_t)first * (uint32_t)rows);
    *column = first + rest % width;
    *row = rest / width;
}

/* Nobody is told how far a run is before its first tiles are done: tiles are smaller the
 * more samples a pixel takes. `pixels`: in a unit of t->width and t->height. */
static void choose_tile(tiles *t, int32_t pixels, int32_t least_width,
                        int32_t least_height)
{
    enum { MOST_SAMPLES = 1 << 24 };
    const crv__setup *s = t->work->setup;
    const crv_options *o = &s->options;
    const double samples =
        (s->pattern ? (double)o->samples : (double)o->directions * (double)o->steps)
        * (1.0 + (double)o->normal_rays) * (double)s->desc.layers * (double)pixels;
    while (t->height > least_height && samples * t->width * t->height > MOST_SAMPLES)
        t->height /= 2;
    while (t->width > least_width && samples * t->width * t->height > MOST_SAMPLES)
        t->width /= 2;
}

static void run_tile(void *data, uint32_t index)
{
    const tiles *t = data;
    const crv__rectangle area = t->area;
    int32_t column, row;
    tile_place(index, t->columns, t->rows, TILE_STRIP, &column, &row);
    const int32_t x0 = area.x + column * t->width, y0 = area.y + row * t->height;
    const int32_t right = area.x + area.width, bottom = area.y + area.height;
    const int32_t x1 = x0 + t->width < right ? x0 + t->width : right;
    const int32_t y1 = y0 + t->height < bottom ? y0 + t->height : bottom;
    for (int32_t y = y0; y < y1; y++)
        t->row(t, x0, x1, y);
}

/* Loops of a run return false if the host's crv_progress ended them. */
static bool run_tiles(tiles *t)
{
    t->area = crv__setup_rectangle(t->work->setup);
    t->width = TILE_WIDTH;
    t->height = TILE_HEIGHT;
    if (t->method)
        choose_tile(t, 1, CRV__GROUP_SPAN, 1);
    t->columns = (t->area.width + t->width - 1) / t->width;
    t->rows = (t->area.height + t->height - 1) / t->height;
    return crv__run_step(t->work->setup->context,
                         (uint32_t)t->columns * (uint32_t)t->rows, run_tile, t);
}

/* What a plan is computed with: kernels where there are, else NULL. */
typedef struct plan_state {
    crv__estimate_kernel estimate;
    crv__bent_kernel bent; /* of every method that gives them and has the other */
    crv__filter_kernel filter;
    crv__deinterleaved_state *di;
    crv__map_kernel map_kernel;
    crv__plane map; /* where the setup has one */
} plan_state;

/* Kernels know nothing of fields. */
static const plan_state *state_of(const crv__work *work)
{
    static const plan_state SPECIFICATION;
    return work->frame->params->use_field ? &SPECIFICATION : work->state;
}

/* The pixels of a row whose radius is beyond the deinterleaved structure's table. */
static void mend_row(const tiles *t, int32_t x0, int32_t x1, int32_t y,
                     const picture_row *out)
{
    float room[4][CRV__GROUP_SPAN];
    picture_row exact = {.accessibility = room[0]};
    for (int k = 0; k < 3 && out->bent[0]; k++)
        exact.bent[k] = room[k + 1];
    for (int32_t x = x0; x < x1; x += CRV__GROUP_SPAN) {
        const int32_t end = x + CRV__GROUP_SPAN < x1 ? x + CRV__GROUP_SPAN : x1;
        const float *depth = crv__plane_at(&t->work->frame->depth[0], x, y);
        estimate_pixels(t, x, end, y, &exact);
        for (int32_t i = 0; i < end - x; i++) {
            if (!crv__deinterleaved_is_beyond(t->di, t->work->frame->params, depth[i]))
                continue;
            out->accessibility[x - x0 + i] = exact.accessibility[i];
            for (int k = 0; k < 3 && out->bent[0]; k++)
                out->bent[k][x - x0 + i] = exact.bent[k][i];
        }
    }
}

/* A tile of groups: rows of the same phase at once, which share their lists. */
static void run_group_tile(void *data, uint32_t index)
{
    const tiles *t = data;
    const crv__plane *out = &t->out->accessibility;
    const int32_t left = (out->x0 + t->di->left) / CRV__GROUP_SPAN;
    const int32_t end =
        (out->x0 + out->width + t->di->left + CRV__GROUP_SPAN - 1) / CRV__GROUP_SPAN;
    int32_t column, row;
    tile_place(index, t->columns, t->rows, GROUP_TILE_STRIP, &column, &row);
    const int32_t first = left + column * t->width;
    const int32_t last = first + t->width < end ? first + t->width : end;
    const int32_t y0 = out->y0 + row * t->height;
    const int32_t bottom = out->y0 + out->height;
    const int32_t y1 = y0 + t->height < bottom ? y0 + t->height : bottom;
    const int32_t from = first * CRV__GROUP_SPAN - t->di->left;
    const int32_t to = last * CRV__GROUP_SPAN - t->di->left;
    const int32_t x0 = from > out->x0 ? from : out->x0;
    const int32_t x1 = to < out->x0 + out->width ? to : out->x0 + out->width;
    for (int32_t i = 0; i < CRV__PHASES && y0 + i < y1; i++) {
        const crv__group_tile tile = {first, last, y0 + i, y1};
        const int beyond = t->group_kernel(t->work->frame, t->di, &tile, t->out);
        for (int32_t y = y0 + i; y < y1; y += CRV__PHASES) {
            const picture_row to_row = row_of(t->out, x0, y);
            apply_contrast(t->work->frame->params, to_row.accessibility, x1 - x0);
            if (beyond)
                mend_row(t, x0, x1, y, &to_row);
            take_deviations(t, x0, x1, y, &to_row);
        }
    }
}

static bool run_group_tiles(tiles *t)
{
    const crv__plane *out = &t->out->accessibility;
    const int32_t left = (out->x0 + t->di->left) / CRV__GROUP_SPAN;
    const int32_t end =
        (out->x0 + out->width + t->di->left + CRV__GROUP_SPAN - 1) / CRV__GROUP_SPAN;
    t->width = GROUP_TILE_WIDTH;
    t->height = GROUP_TILE_HEIGHT;
    choose_tile(t, CRV__GROUP_SPAN, 1, CRV__PHASES);
    t->columns = (end - left + t->width - 1) / t->width;
    t->rows = (out->height + t->height - 1) / t->height;
    return crv__run_step(t->work->setup->context,
                         (uint32_t)t->columns * (uint32_t)t->rows, run_group_tile, t);
}

typedef struct map_job {
    const crv__map *map;
    crv__map_kernel kernel; /* NULL: the specification */
    const crv__frame *frame;
    const crv__plane *out;
} map_job;

static void run_map_tile(void *data, uint32_t index)
{
    const map_job *job = data;
    const int32_t columns = (job->out->width - 1) / CRV__MAP_TILE_WIDTH + 1;
    const int32_t x0 = (int32_t)index % columns * CRV__MAP_TILE_WIDTH,
                  y0 = (int32_t)index / columns * CRV__MAP_TILE_HEIGHT;
    const int32_t x1 = x0 + CRV__MAP_TILE_WIDTH, y1 = y0 + CRV__MAP_TILE_HEIGHT;
    const int32_t right = job->out->width, bottom = job->out->height;
    const crv__tile tile = {x0, x1 < right ? x1 : right, y0, y1 < bottom ? y1 : bottom};
    job->kernel(job->frame, job->out, tile);
}

static void map_row(void *data, uint32_t index)
{
    const map_job *job = data;
    const int32_t y = (int32_t)index;
    float *row = crv__plane_at(job->out, 0, y);
    for (int32_t x = 0; x < job->out->width; x++)
        row[x] = job->map->value(job->frame, x, y);
}

static bool make_map(const crv__work *work)
{
    const crv_context *context = work->setup->context;
    const crv__plane *out = work->frame->map;
    map_job job = {.map = crv__setup_map(work->setup),
                   .kernel = state_of(work)->map_kernel,
                   .frame = work->frame,
                   .out = out};
    const int32_t columns = (out->width - 1) / CRV__MAP_TILE_WIDTH + 1,
                  rows = (out->height - 1) / CRV__MAP_TILE_HEIGHT + 1;
    if (job.kernel)
        return crv__run_step(context, (uint32_t)columns * (uint32_t)rows, run_map_tile,
                             &job);
    return crv__run_step(context, (uint32_t)out->height, map_row, &job);
}

static bool estimate(const crv__work *work, const crv__picture *to)
{
    const plan_state *state = state_of(work);
    tiles t = {.work = work,
               .method = work->setup->method,
               .estimate_kernel = state->estimate,
               .bent_kernel = state->bent,
               .out = to,
               .row = estimate_row};
    if (work->frame->map && !make_map(work))
        return false;
    if (!state->di)
        return run_tiles(&t);
    t.di = crv__deinterleaved_prepare(state->di, work->setup, work->frame);
    t.group_kernel = crv__deinterleaved_kernel_of(state->di, to->bent[0].data);
    return run_group_tiles(&t);
}

static bool filter_pass(const crv__work *work, int32_t pass, const crv__picture *input,
                        const crv__picture *out)
{
    tiles t = {.work = work,
               .filter = work->setup->filter,
               .pass = pass,
               .input = input,
               .out = out,
               .row = filter_row};
    return run_tiles(&t);
}

static void run_filter_tile(void *data, uint32_t index)
{
    const tiles *t = data;
    const crv__plane *out = &t->out->accessibility;
    const int32_t x0 =
        out->x0 + (int32_t)(index % (uint32_t)t->columns) * CRV__FILTER_TILE_WIDTH;
    const int32_t y0 =
        out->y0 + (int32_t)(index / (uint32_t)t->columns) * CRV__FILTER_TILE_HEIGHT;
    const int32_t right = out->x0 + out->width, bottom = out->y0 + out->height;
    const int32_t x1 = x0 + CRV__FILTER_TILE_WIDTH, y1 = y0 + CRV__FILTER_TILE_HEIGHT;
    const crv__tile tile = {x0, x1 < right ? x1 : right, y0, y1 < bottom ? y1 : bottom};
    t->filter_kernel(t->work->frame, t->input, t->out, tile);
    for (int32_t y = tile.y0; y < tile.y1; y++) {
        const picture_row row = row_of(t->out, x0, y);
        restore_bent(t, x0, tile.x1, y, &row);
    }
}

/* What the host gives to be filtered alone has nothing beyond the guard band: kernels are
 * not shown that part. */
static crv__plane shown_part(const crv__work *work, const crv__plane *plane)
{
    const crv_gbuffer_desc *d = &work->setup->desc;
    crv__plane part = *plane;
    if (!work->filter_only)
        return part;
    part.data = crv__plane_at(plane, d->guard_left, d->guard_top);
    part.x0 = d->guard_left;
    part.y0 = d->guard_top;
    part.width = d->width - d->guard_left - d->guard_right;
    part.height = d->height - d->guard_top - d->guard_bottom;
    return part;
}

/* All passes at once, from pictures[0] to pictures[1]. */
static bool filter_with(const crv__work *work, crv__filter_kernel kernel,
                        const crv__picture pictures[2])
{
    crv__picture shown[2] = {pictures[0], pictures[1]};
    for (int i = 0; i < 2; i++)
        shown[i].accessibility = shown_part(work, &pictures[i].accessibility);
    const int32_t width = shown[1].accessibility.width,
                  height = shown[1].accessibility.height;
    tiles t = {
        .work = work, .filter_kernel = kernel, .input = &shown[0], .out = &shown[1]};
    t.columns = (width + CRV__FILTER_TILE_WIDTH - 1) / CRV__FILTER_TILE_WIDTH;
    const int32_t rows = (height + CRV__FILTER_TILE_HEIGHT - 1) / CRV__FILTER_TILE_HEIGHT;
    return crv__run_step(work->setup->context, (uint32_t)t.columns * (uint32_t)rows,
                         run_filter_tile, &t);
}

/* ---- plans ---- */

/* The kernels that a plan takes: they index planes with 32 bits. */
static void choose_kernels(const crv__setup *setup, const crv__plane *plane,
                           plan_state *state)
{
    const crv__kernels *kernels = setup->context->kernels;
    state->estimate = NULL;
    state->bent = NULL;
    state->filter = NULL;
    state->map_kernel = NULL;
    if (!kernels || plane->pitch > INT32_MAX / setup->desc.height)
        return;
    const crv__method_id method = crv__method_id_of(setup->method);
    state->estimate = kernels->estimates[method];
    state->bent = kernels->bents[method];
    state->map_kernel = kernels->maps[method];
    if (setup->filter)
        state->filter = kernels->filters[crv__filter_id_of(setup->filter)];
}

static void plan_destroy(const crv__setup *setup, void *data)
{
    plan_state *state = data;
    crv__deinterleaved_destroy(setup, state->di);
    crv__plane_destroy(&state->map, &setup->context->allocator);
    crv__release(&setup->context->allocator, state, 1, sizeof *state);
}

static crv_status take_memory(const crv__setup *setup, plan_state *state)
{
    const crv_gbuffer_desc *d = &setup->desc;
    if (setup->map
        && crv__plane_create(&state->map, &setup->context->allocator, 0, 0, d->width,
                             d->height))
        return CRV_ERROR_OUT_OF_MEMORY;
    return crv__deinterleaved_create(setup, &state->di);
}

static crv_status plan_create(const crv__setup *setup, const crv__plane *rectangle,
                              void **out)
{
    const crv_allocator *allocator = &setup->context->allocator;
    plan_state *state = crv__allocate(allocator, 1, sizeof *state);
    crv_status status = CRV_ERROR_OUT_OF_MEMORY;
    if (state) {
        choose_kernels(setup, rectangle, state);
        status = take_memory(setup, state);
        if (status)
            plan_destroy(setup, state);
    }
    if (status == CRV_OK) {
        *out = state;
        return CRV_OK;
    }
    return crv__fail(&setup->context->logger, status, "plan: no memory for %d x %d",
                     rectangle->width, rectangle->height);
}

static bool plan_update(const crv__setup *setup, void *data)
{
    plan_state *state = data;
    if (!crv__deinterleaved_update(setup, state->di))
        return false;
    if (state->filter)
        state->filter =
            setup->context->kernels->filters[crv__filter_id_of(setup->filter)];
    return true;
}

/* Makes the plane the host's image, if kernels can write that; or it is copied to. All
 * planes of a picture have one pitch. */
static void take_target(const crv__work *work, crv__plane *plane)
{
    const crv_gbuffer_desc *d = &work->setup->desc;
    const crv_image *to = work->target;
    const ptrdiff_t size = sizeof(float);
    if (to && !work->with_bent && to->pixel_stride == size && to->row_stride % size == 0
        && to->row_stride >= to->width * size
        && to->row_stride / size <= INT32_MAX / d->height)
        *plane = (crv__plane){.data = to->data,
                              .pitch = to->row_stride / size,
                              .x0 = d->guard_left,
                              .y0 = d->guard_top,
                              .width = to->width,
                              .height = to->height};
}

static crv_status run(const crv__work *given, const crv__picture given_pictures[2],
                      crv__picture *result)
{
    const plan_state *own = given->state;
    crv__frame frame = *given->frame;
    frame.map = crv__setup_map(given->setup) ? &own->map : NULL;
    crv__work work = *given;
    work.frame = &frame;
    crv__picture pictures[2] = {given_pictures[0], given_pictures[1]};
    for (int i = 0; i < 2 && !work.with_bent; i++)
        pictures[i].bent[0].data = NULL;
    const crv__filter *filter = work.setup->filter;
    const crv__filter_kernel kernel = state_of(&work)->filter;
    const int32_t passes = filter && !kernel ? filter->passes : 0;
    bool goes_on = work.filter_only || estimate(&work, &pictures[0]);
    if (!goes_on)
        return CRV_ERROR_STOPPED;
    if (kernel) {
        take_target(&work, &pictures[1].accessibility);
        goes_on = filter_with(&work, kernel, pictures);
    }
    for (int32_t pass = 0; pass < passes && goes_on; pass++)
        goes_on =
            filter_pass(&work, pass, &pictures[pass % 2], &pictures[(pass + 1) % 2]);
    if (!goes_on)
        return CRV_ERROR_STOPPED;
    *result = pictures[kernel ? 1 : passes % 2];
    return CRV_OK;
}

static crv_status open_host(crv_context *context, int32_t index)
{
    (void)index; /* there is one */
    crv__isa_choose(context);
    if (context->kernels)
        context->conversions = &context->kernels->conversions;
    return CRV_OK;
}

extern const crv__backend crv__cpu_backend;
const crv__backend crv__cpu_backend = {.name = "cpu",
                                       .device = CRV_DEVICE_CPU,
                                       .open = open_host,
                                       .plan_create = plan_create,
                                       .plan_destroy = plan_destroy,
                                       .plan_update = plan_update,
                                       .run = run};
