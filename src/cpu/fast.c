/* SPDX-License-Identifier: MIT */
/*
 * Builds what the fast structure's kernels read: depth by phases, and the table of
 * samples by bucket and phase. The table depends on the camera and the options alone, so
 * that frames of one camera share it.
 */
#include "cpu/fast.h"

#include <math.h>
#include <string.h>

enum {
    PHASES = CRV__FAST_PHASES * CRV__FAST_PHASES,
    OCTAVES = 14,       /* of projected radii, from half a pixel on */
    FAR_PX = 32,        /* samples from here on are on the phase's grid */
    MOST_LAYERS = 3,    /* 48 bytes a pixel do not hold more */
    BYTES_A_PIXEL = 48, /* beyond input and output */
    TABLES_WHATEVER_THE_SIZE = 2 << 20
};

/* Numbers of things. */
typedef struct sizes {
    size_t depths, samples, counts, lists;
} sizes;

struct crv__fast_state {
    crv__fast fast;
    const crv__fast_kind *kind;
    crv__fast_deal_kernel deal;
    sizes needed, memory; /* by this plan; what there is */
    float fx, fy;         /* that the tables were made for; 0: none */
};

typedef struct fill_job {
    crv__fast_state *state;
    const crv__frame *frame;
} fill_job;

static int32_t wrapped(int64_t value, int32_t size)
{
    return (int32_t)((value % size + size) % size);
}

/* Places of a plan's pixels and the sizes of all; 0 where the structure does not fit. */
static bool measure(crv__fast_state *s, const crv__setup *setup)
{
    crv__fast *fast = &s->fast;
    const crv_gbuffer_desc *d = &setup->desc;
    const crv_options *o = &setup->options;
    const int32_t is_walk = s->kind->is_walk;
    const int32_t count = is_walk ? o->directions : o->samples;
    fast->paired = s->kind->in_pairs && count % 2 == 0;
    fast->walks = is_walk ? count / (1 + fast->paired) : 1;
    fast->steps = is_walk ? o->steps : count / (1 + fast->paired);
    fast->buckets = OCTAVES << s->kind->fineness;
    fast->shift = CRV__FAST_MANTISSA - s->kind->fineness;
    fast->left = wrapped((int64_t)d->origin_x - d->guard_left, CRV__FAST_SPAN);
    fast->top = wrapped((int64_t)d->origin_y - d->guard_top, CRV__FAST_PHASES);
    fast->columns = (fast->left + d->width + CRV__FAST_PHASES - 1) / CRV__FAST_PHASES;
    fast->rows = (fast->top + d->height + CRV__FAST_PHASES - 1) / CRV__FAST_PHASES;
    /* An odd number of cache lines: the pixels of a column fall into different sets. */
    const int32_t groups = (fast->columns + CRV__FAST_GROUP - 1) / CRV__FAST_GROUP;
    fast->pitch = (groups | 1) * CRV__FAST_GROUP + 2 * CRV__FAST_PADDING;
    fast->plane = fast->pitch * fast->rows;
    fast->layer_pitch = fast->pitch + (ptrdiff_t)PHASES * fast->plane;
    const size_t lists = (size_t)fast->buckets * PHASES;
    s->needed = (sizes){.depths = (size_t)fast->layer_pitch * (size_t)d->layers,
                        .samples = lists * (size_t)(fast->walks * fast->steps),
                        .counts = lists * (size_t)fast->walks,
                        .lists = lists};

    const double pixels = (double)d->width * d->height;
    const double planes = 4.0 * d->layers + 12 + 4 + (setup->filter ? 4 : 0);
    const double table =
        (double)s->needed.samples * (sizeof(crv__fast_sample) + sizeof(crv__fast_place));
    const double left =
        (BYTES_A_PIXEL - planes) * pixels - 4.0 * (double)s->needed.depths;
    return fast->walks * fast->steps <= CRV__FAST_MOST_SAMPLES && d->layers <= MOST_LAYERS
           && s->needed.depths < INT32_MAX
           && (table <= left || table <= TABLES_WHATEVER_THE_SIZE);
}

static bool suits(const crv__setup *setup, const crv__fast_kind *kind)
{
    const crv_options *o = &setup->options;
    const int32_t size = o->noise_size;
    return kind && !setup->context->exact && (size == 1 || size == 2 || size == 4)
           && !(setup->method->volumetric && setup->desc.layers > 1);
}

/* The scales of the phases spread the borders between buckets over a bucket's width, so
 * that no border is seen. */
static void fill_scales(crv__fast *fast, int32_t fineness)
{
    static const float RANK[PHASES] = {0, 8,  2, 10, 12, 4, 14, 6,
                                       3, 11, 1, 9,  15, 7, 13, 5};
    const float width = 1.0f / (float)(1 << fineness);
    for (int32_t i = 0; i < PHASES; i++)
        fast->scale[i] = exp2f(((RANK[i] + 0.5f) / PHASES - 0.5f) * width);
    fast->largest = CRV__FAST_SMALLEST * (1 << OCTAVES) * exp2f(-0.5f * width) * 0.99f;
}

/* Everything but the memory; false if the plan is better or only computed exactly. */
static bool plan(crv__fast_state *s, const crv__setup *setup)
{
    const crv__kernels *kernels = setup->context->kernels;
    if (!kernels)
        return false;
    s->kind = kernels->fast[crv__method_id_of(setup->method)];
    s->deal = kernels->deal;
    if (!suits(setup, s->kind) || !measure(s, setup))
        return false;
    fill_scales(&s->fast, s->kind->fineness);
    s->fx = s->fy = 0;
    return true;
}

static crv_status allocate(crv__fast_state *s, const crv_allocator *allocator)
{
    crv__fast *fast = &s->fast;
    const sizes n = s->memory = s->needed;
    fast->depth = crv__allocate(allocator, n.depths, sizeof(float));
    fast->samples = crv__allocate(allocator, n.samples, sizeof *fast->samples);
    fast->places = crv__allocate(allocator, n.samples, sizeof *fast->places);
    fast->counts = crv__allocate(allocator, n.counts, sizeof *fast->counts);
    fast->reaches = crv__allocate(allocator, n.lists, sizeof *fast->reaches);
    return fast->depth && fast->samples && fast->places && fast->counts && fast->reaches
               ? CRV_OK
               : CRV_ERROR_OUT_OF_MEMORY;
}

crv_status crv__fast_create(const crv__setup *setup, crv__fast_state **state)
{
    crv__fast_state planned = {0};
    *state = NULL;
    if (!plan(&planned, setup))
        return CRV_OK;
    const crv_allocator *allocator = &setup->context->allocator;
    crv__fast_state *s = crv__allocate(allocator, 1, sizeof *s);
    if (!s)
        return CRV_ERROR_OUT_OF_MEMORY;
    *s = planned;
    *state = s;
    const crv_status status = allocate(s, allocator);
    if (status) {
        crv__fast_destroy(setup, s);
        *state = NULL;
    }
    return status;
}

void crv__fast_destroy(const crv__setup *setup, crv__fast_state *s)
{
    if (!s)
        return;
    const crv_allocator *allocator = &setup->context->allocator;
    crv__fast *fast = &s->fast;
    const sizes n = s->memory;
    crv__release(allocator, fast->depth, n.depths, sizeof(float));
    crv__release(allocator, fast->samples, n.samples, sizeof *fast->samples);
    crv__release(allocator, fast->places, n.samples, sizeof *fast->places);
    crv__release(allocator, fast->counts, n.counts, sizeof *fast->counts);
    crv__release(allocator, fast->reaches, n.lists, sizeof *fast->reaches);
    crv__release(allocator, s, 1, sizeof *s);
}

bool crv__fast_update(const crv__setup *setup, crv__fast_state *s)
{
    crv__fast_state next = s ? *s : (crv__fast_state){0};
    if (!plan(&next, setup))
        return !s;
    const sizes n = next.needed;
    if (!s || n.depths > s->memory.depths || n.samples > s->memory.samples
        || n.counts > s->memory.counts || n.lists > s->memory.lists)
        return false;
    *s = next;
    return true;
}

static float radius_of_bits(uint32_t bits)
{
    float radius;
    memcpy(&radius, &bits, sizeof radius);
    return radius;
}

/* The projected radius, before the phase's scale, in the middle of the depths that share
 * this bucket. */
static float radius_of(const crv__fast *fast, int32_t bucket)
{
    const uint32_t bits = CRV__FAST_SMALLEST_BITS + ((uint32_t)bucket << fast->shift);
    const float low = radius_of_bits(bits),
                high = radius_of_bits(bits + (1u << fast->shift));
    return 2 * low * high / (low + high);
}

/* Fills a sample and its place for the step (du, dv) in pixels from a pixel of a phase.
 */
static void fill_sample(const crv__fast *fast, const crv__params *p, int32_t phase,
                        float du, float dv, crv__fast_sample *sample,
                        crv__fast_place *place)
{
    const int32_t px = phase % CRV__FAST_PHASES, py = phase / CRV__FAST_PHASES;
    const float x = du * p->inv_fx, y = -dv * p->inv_fy;
    const float squared = x * x + y * y, length = sqrtf(squared);
    const float cosine = length > 0 ? x / length : 0, sine = length > 0 ? y / length : 0;
    *sample = (crv__fast_sample){2 * x,
                                 2 * y,
                                 squared,
                                 -2 * squared,
                                 cosine,
                                 sine,
                                 cosine * cosine - sine * sine,
                                 2 * cosine * sine};
    *place = (crv__fast_place){{0, 0}, {CRV__FAST_OFF, CRV__FAST_OFF}, 0, 0};
    if (!(fabsf(du) < CRV_MAX_SIZE && fabsf(dv) < CRV_MAX_SIZE))
        return;
    place->dv = (int16_t)dv;
    for (int32_t side = 0; side < 2; side++) {
        const int32_t column = px + (int32_t)(side ? -du : du),
                      row = py + (int32_t)(side ? -dv : dv);
        const int32_t to_x = column & (CRV__FAST_PHASES - 1),
                      to_y = row & (CRV__FAST_PHASES - 1);
        const int32_t shift = (column - to_x) / CRV__FAST_PHASES;
        place->shift[side] = (int16_t)shift;
        place->offset[side] = (to_y * CRV__FAST_PHASES + to_x - phase) * fast->plane
                              + (row - to_y) / CRV__FAST_PHASES * fast->pitch + shift;
    }
}

static void extend(crv__fast_reach *reach, const crv__fast_place *place)
{
    const int16_t rows = (int16_t)(place->dv < 0 ? -place->dv : place->dv);
    reach->rows = rows > reach->rows ? rows : reach->rows;
    for (int32_t side = 0; side < 2; side++) {
        const int16_t shift = place->shift[side];
        reach->shift_min = shift < reach->shift_min ? shift : reach->shift_min;
        reach->shift_max = shift > reach->shift_max ? shift : reach->shift_max;
    }
}

/* The step to sample i of walk k in pixels, to the right and down, as the methods have
 * it, or, without walks, to point i; far ones to the grid of the pixel's phase. Radii in
 * pixels. */
static void step_to(const crv__fast_kind *kind, const crv__frame *f,
                    const crv__noise_texel *noise, int32_t k, int32_t i, float radius_x,
                    float radius_y, float step[2])
{
    const crv__params *p = f->params;
    crv__vec2 to;
    float t = 1;
    if (kind->is_walk) {
        to = crv__direction(f, noise, k);
        t = ((float)i + 0.5f + 0.5f * noise->beta) / (float)p->steps;
        if (p->spacing == CRV_SPACING_QUADRATIC)
            t *= t;
    } else {
        to = crv__turned(noise, f->pattern[4 * i], f->pattern[4 * i + 1]);
    }
    step[0] = t * (to.x * radius_x);
    step[1] = t * (-to.y * radius_y);
    for (int32_t axis = 0; axis < 2; axis++)
        step[axis] = kind->is_rounded ? rintf(step[axis]) : floorf(step[axis] + 0.5f);
    if (kind->on_grid && fmaxf(fabsf(step[0]), fabsf(step[1])) >= FAR_PX) {
        for (int32_t axis = 0; axis < 2; axis++)
            step[axis] = CRV__FAST_PHASES * rintf(step[axis] / CRV__FAST_PHASES);
    }
}

/* One list: the samples of one bucket and phase. */
static void fill_list(const fill_job *job, uint32_t index)
{
    crv__fast *fast = &job->state->fast;
    const crv__fast_kind *kind = job->state->kind;
    const crv__params *p = job->frame->params;
    const int32_t phase = (int32_t)index % PHASES, px = phase % CRV__FAST_PHASES;
    const crv__noise_texel *noise =
        &job->frame->noise[phase / CRV__FAST_PHASES % p->noise_size * p->noise_size
                           + px % p->noise_size];
    const float radius = radius_of(fast, (int32_t)index / PHASES) / fast->scale[phase];
    crv__fast_reach reach = {.radius = radius};
    for (int32_t k = 0; k < fast->walks; k++) {
        const size_t first =
            ((size_t)index * (size_t)fast->walks + (size_t)k) * (size_t)fast->steps;
        uint16_t count = 0;
        for (int32_t i = 0; i < fast->steps; i++) {
            float step[2];
            step_to(kind, job->frame, noise, k,
                    kind->is_walk ? i : i * (1 + fast->paired),
                    radius * (p->fx * p->inv_fy), radius, step);
            if (!kind->keeps_own && step[0] == 0 && step[1] == 0)
                continue;
            crv__fast_place *place = &fast->places[first + count];
            fill_sample(fast, p, phase, step[0], step[1], &fast->samples[first + count],
                        place);
            place->index = (int16_t)i;
            extend(&reach, place);
            count++;
        }
        fast->counts[(size_t)index * (size_t)fast->walks + (size_t)k] = count;
    }
    fast->reaches[index] = reach;
}

static void fill_bucket(void *data, uint32_t index)
{
    for (uint32_t i = 0; i < PHASES; i++)
        fill_list(data, index * PHASES + i);
}

static void deal_rows(void *data, uint32_t index)
{
    enum { ROWS = 16 };
    const fill_job *job = data;
    const int32_t first = (int32_t)index * ROWS, height = job->frame->params->height;
    for (int32_t y = first; y < first + ROWS && y < height; y++)
        job->state->deal(job->frame, &job->state->fast, y);
}

const crv__fast *crv__fast_prepare(crv__fast_state *s, const crv__setup *setup,
                                   const crv__frame *frame)
{
    const crv__params *p = frame->params;
    fill_job job = {s, frame};
    if (s->fx != p->fx || s->fy != p->fy) {
        crv__run_parallel(setup->context, (uint32_t)s->fast.buckets, fill_bucket, &job);
        s->fx = p->fx;
        s->fy = p->fy;
    }
    s->fast.cap = !s->kind->is_walk ? INFINITY
                  : p->fx > p->fy   ? p->max_radius_px * (p->fy / p->fx)
                                    : p->max_radius_px;
    s->fast.background = p->orthographic ? 1e18f : 1024 * p->radius * p->fy;
    crv__run_parallel(setup->context, (uint32_t)(p->height + 15) / 16, deal_rows, &job);
    return &s->fast;
}

crv__fast_kernel crv__fast_kernel_of(const crv__fast_state *s)
{
    return s->kind->run;
}

int crv__fast_is_beyond(const crv__fast *fast, const crv__params *p, float depth)
{
    const float radius = p->radius * p->fy;
    return depth < fast->background
           && !((p->orthographic ? radius : radius * (1 / depth)) < fast->largest);
}
