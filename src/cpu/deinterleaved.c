/* SPDX-License-Identifier: MIT */
/*
 * Builds what the deinterleaved kernels read (kernels/deinterleaved.h): depth by phases
 * of the noise tile, and a table of samples for each phase and each bucket of projected
 * radii. The table depends only on camera and options: frames of one camera share it.
 */
#include "cpu/deinterleaved.h"

#include "cpu/border.h"

#include <math.h>
#include <string.h>

enum {
    PHASES = CRV__PHASES * CRV__PHASES,
    OCTAVES = 14,       /* of projected radii, from half a pixel on */
    FAR_PX = 32,        /* samples from here on are on the phase's grid */
    MOST_LAYERS = 3,    /* more would exceed 48 bytes a pixel */
    BYTES_A_PIXEL = 48, /* beyond input and output */
    TABLES_WHATEVER_THE_SIZE = 2 << 20
};

/* Numbers of things. */
typedef struct sizes {
    size_t depths, samples, counts, lists, borders;
} sizes;

struct crv__deinterleaved_state {
    crv__deinterleaved di;
    const crv__deinterleaved_method *method;
    crv__deinterleave_kernel deinterleave;
    sizes needed, memory; /* by this plan; what there is */
    float fx, fy;         /* that the tables were made for; 0: none */
};

typedef struct fill_job {
    crv__deinterleaved_state *state;
    const crv__frame *frame;
} fill_job;

static int32_t wrapped(int64_t value, int32_t size)
{
    return (int32_t)((value % size + size) % size);
}

/* Lays out a plan's pixels and computes the sizes of all memory; false if the structure
 * does not fit. */
static bool measure(crv__deinterleaved_state *s, const crv__setup *setup)
{
    crv__deinterleaved *di = &s->di;
    const crv_gbuffer_desc *d = &setup->desc;
    const crv_options *o = &setup->options;
    const int32_t in_slices = s->method->in_slices;
    const int32_t count = in_slices ? o->directions : o->samples;
    di->paired = s->method->in_pairs && count % 2 == 0;
    di->slices = in_slices ? count / (1 + di->paired) : 1;
    di->steps = in_slices ? o->steps : count / (1 + di->paired);
    di->buckets = OCTAVES << s->method->fineness;
    di->shift = CRV__MANTISSA_BITS - s->method->fineness;
    di->left = wrapped((int64_t)d->origin_x - d->guard_left, CRV__GROUP_SPAN);
    di->top = wrapped((int64_t)d->origin_y - d->guard_top, CRV__PHASES);
    di->columns = (di->left + d->width + CRV__PHASES - 1) / CRV__PHASES;
    di->rows = (di->top + d->height + CRV__PHASES - 1) / CRV__PHASES;
    /* An odd number of cache lines: the pixels of a column fall into different sets. */
    const int32_t groups = (di->columns + CRV__GROUP_PIXELS - 1) / CRV__GROUP_PIXELS;
    di->pitch = (groups | 1) * CRV__GROUP_PIXELS + 2 * CRV__ROW_PADDING;
    di->plane = di->pitch * di->rows;
    di->layer_pitch = di->pitch + (ptrdiff_t)PHASES * di->plane;
    const int32_t has_map = crv__setup_map(setup) ? 1 : 0;
    const size_t lists = (size_t)di->buckets * PHASES;
    s->needed = (sizes){.depths = (size_t)di->layer_pitch * (size_t)(d->layers + has_map),
                        .samples = lists * (size_t)(di->slices * di->steps),
                        .counts = lists * (size_t)di->slices,
                        .lists = lists,
                        .borders = s->method->jittered ? crv__border_size(di) : 0};

    const double pixels = (double)d->width * d->height;
    const double planes = 4.0 * (d->layers + has_map) + 12 + 4 + (setup->filter ? 4 : 0);
    const double table =
        (double)s->needed.samples * (sizeof(crv__sample) + sizeof(crv__sample_place));
    const double left = (BYTES_A_PIXEL - planes) * pixels
                        - 4.0 * ((double)s->needed.depths + (double)s->needed.borders);
    return di->slices * di->steps <= CRV__MOST_SAMPLES && d->layers <= MOST_LAYERS
           && s->needed.depths < INT32_MAX
           && (table <= left || table <= TABLES_WHATEVER_THE_SIZE);
}

static bool suits(const crv__setup *setup, const crv__deinterleaved_method *method)
{
    const crv_options *o = &setup->options;
    const int32_t size = o->noise_size;
    return method && !setup->context->exact && (size == 1 || size == 2 || size == 4)
           && !((setup->method->volumetric || method->one_layer)
                && setup->desc.layers > 1);
}

/* The scales of the phases spread the borders between buckets over a bucket's width, so
 * that no border is seen. */
static void fill_scales(crv__deinterleaved *di, int32_t fineness)
{
    static const float RANK[PHASES] = {0, 8,  2, 10, 12, 4, 14, 6,
                                       3, 11, 1, 9,  15, 7, 13, 5};
    const float width = 1.0f / (float)(1 << fineness);
    for (int32_t i = 0; i < PHASES; i++)
        di->scale[i] = exp2f(((RANK[i] + 0.5f) / PHASES - 0.5f) * width);
    di->largest = CRV__SMALLEST_RADIUS_PX * (1 << OCTAVES) * exp2f(-0.5f * width) * 0.99f;
}

/* Everything but the memory; false if the plan must or should be computed exactly. */
static bool plan(crv__deinterleaved_state *s, const crv__setup *setup)
{
    const crv__kernels *kernels = setup->context->kernels;
    if (!kernels)
        return false;
    s->method = kernels->deinterleaved[crv__method_id_of(setup->method)];
    s->deinterleave = kernels->deinterleave;
    if (!suits(setup, s->method) || !measure(s, setup))
        return false;
    fill_scales(&s->di, s->method->fineness);
    s->fx = s->fy = 0;
    return true;
}

static crv_status allocate(crv__deinterleaved_state *s, const crv_allocator *allocator)
{
    crv__deinterleaved *di = &s->di;
    const sizes n = s->memory = s->needed;
    di->depth = crv__allocate(allocator, n.depths, sizeof(float));
    di->samples = crv__allocate(allocator, n.samples, sizeof *di->samples);
    di->places = crv__allocate(allocator, n.samples, sizeof *di->places);
    di->counts = crv__allocate(allocator, n.counts, sizeof *di->counts);
    di->footprints = crv__allocate(allocator, n.lists, sizeof *di->footprints);
    if (n.borders > 0)
        di->border = crv__allocate(allocator, n.borders, sizeof(float));
    return (di->border || !n.borders) && di->depth && di->samples && di->places
                   && di->counts && di->footprints
               ? CRV_OK
               : CRV_ERROR_OUT_OF_MEMORY;
}

crv_status crv__deinterleaved_create(const crv__setup *setup,
                                     crv__deinterleaved_state **state)
{
    crv__deinterleaved_state planned = {0};
    *state = NULL;
    if (!plan(&planned, setup))
        return CRV_OK;
    const crv_allocator *allocator = &setup->context->allocator;
    crv__deinterleaved_state *s = crv__allocate(allocator, 1, sizeof *s);
    if (!s)
        return CRV_ERROR_OUT_OF_MEMORY;
    *s = planned;
    *state = s;
    const crv_status status = allocate(s, allocator);
    if (status) {
        crv__deinterleaved_destroy(setup, s);
        *state = NULL;
    }
    return status;
}

void crv__deinterleaved_destroy(const crv__setup *setup, crv__deinterleaved_state *s)
{
    if (!s)
        return;
    const crv_allocator *allocator = &setup->context->allocator;
    crv__deinterleaved *di = &s->di;
    const sizes n = s->memory;
    crv__release(allocator, di->depth, n.depths, sizeof(float));
    crv__release(allocator, di->samples, n.samples, sizeof *di->samples);
    crv__release(allocator, di->places, n.samples, sizeof *di->places);
    crv__release(allocator, di->counts, n.counts, sizeof *di->counts);
    crv__release(allocator, di->footprints, n.lists, sizeof *di->footprints);
    crv__release(allocator, di->border, n.borders, sizeof(float));
    crv__release(allocator, s, 1, sizeof *s);
}

bool crv__deinterleaved_update(const crv__setup *setup, crv__deinterleaved_state *s)
{
    crv__deinterleaved_state next = s ? *s : (crv__deinterleaved_state){0};
    if (!plan(&next, setup))
        return !s;
    const sizes n = next.needed;
    if (!s || n.depths > s->memory.depths || n.samples > s->memory.samples
        || n.counts > s->memory.counts || n.lists > s->memory.lists
        || n.borders > s->memory.borders)
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
static float radius_of(const crv__deinterleaved *di, int32_t bucket)
{
    const uint32_t bits = CRV__SMALLEST_RADIUS_BITS + ((uint32_t)bucket << di->shift);
    const float low = radius_of_bits(bits),
                high = radius_of_bits(bits + (1u << di->shift));
    return 2 * low * high / (low + high);
}

/* Fills a sample and its place for the step (du, dv) in pixels from a pixel of a phase.
 */
static void fill_sample(const crv__deinterleaved *di, const crv__params *p, int32_t phase,
                        float du, float dv, crv__sample *sample, crv__sample_place *place)
{
    const int32_t px = phase % CRV__PHASES, py = phase / CRV__PHASES;
    const float x = du * p->inv_fx, y = -dv * p->inv_fy;
    const float squared = x * x + y * y, length = sqrtf(squared);
    const float cosine = length > 0 ? x / length : 0, sine = length > 0 ? y / length : 0;
    *sample = (crv__sample){.x2 = 2 * x,
                            .y2 = 2 * y,
                            .squared = squared,
                            .minus_squared2 = -2 * squared,
                            .cosine = cosine,
                            .sine = sine,
                            .cosine2 = cosine * cosine - sine * sine,
                            .sine2 = 2 * cosine * sine};
    *place = (crv__sample_place){.shift = {CRV__SHIFT_OFF, CRV__SHIFT_OFF}};
    if (!(fabsf(du) < CRV_MAX_SIZE && fabsf(dv) < CRV_MAX_SIZE))
        return;
    place->dv = (int16_t)dv;
    for (int32_t side = 0; side < 2; side++) {
        const int32_t column = px + (int32_t)(side ? -du : du),
                      row = py + (int32_t)(side ? -dv : dv);
        const int32_t to_x = column & (CRV__PHASES - 1), to_y = row & (CRV__PHASES - 1);
        const int32_t shift = (column - to_x) / CRV__PHASES;
        place->shift[side] = (int16_t)shift;
        place->offset[side] = (to_y * CRV__PHASES + to_x - phase) * di->plane
                              + (row - to_y) / CRV__PHASES * di->pitch + shift;
    }
}

static void extend(crv__list_footprint *footprint, const crv__sample_place *place)
{
    const int16_t rows = (int16_t)(place->dv < 0 ? -place->dv : place->dv);
    footprint->rows = rows > footprint->rows ? rows : footprint->rows;
    for (int32_t side = 0; side < 2; side++) {
        const int16_t shift = place->shift[side];
        footprint->shift_min =
            shift < footprint->shift_min ? shift : footprint->shift_min;
        footprint->shift_max =
            shift > footprint->shift_max ? shift : footprint->shift_max;
    }
}

static float spaced(const crv__params *p, float t)
{
    t /= (float)p->steps;
    return p->spacing == CRV_SPACING_QUADRATIC ? t * t : t;
}

/* The share of a slice's length in pixels at which its sample i lies: a pixel at least
 * (methods/slice.h). */
static float jittered_share(const crv__params *p, const crv__noise_texel *noise,
                            int32_t k, int32_t i, float length_px)
{
    const float t = spaced(p, (float)i + crv__stratum(noise, k));
    return t * length_px > 1 ? t : 1 / length_px;
}

/* What a jittered method's sample stands for, as methods/slice.h has it. */
static void fill_cell(const crv__params *p, int32_t i, float share, float length_px,
                      crv__sample *sample)
{
    const float near = fminf(1, fmaxf(0.5f / length_px, spaced(p, (float)i)) / share);
    sample->front = 1 - 0.3f * (1 - near);
    sample->far = fmaxf(1, spaced(p, (float)(i + 1)) / share);
}

/* The step to sample i of slice k in pixels, to the right and down, as the methods have
 * it, or, without slices, to point i; distant ones on the grid of the pixel's phase.
 * Radii in pixels. */
static void step_to(const crv__deinterleaved_method *method, const crv__frame *f,
                    const crv__noise_texel *noise, int32_t k, int32_t i, float radius_x,
                    float radius_y, float step[2])
{
    const crv__params *p = f->params;
    crv__vec2 to;
    float t = 1;
    if (method->jittered) {
        to = crv__direction(f, noise, k);
        t = jittered_share(p, noise, k, i, hypotf(to.x * radius_x, to.y * radius_y));
    } else if (method->in_slices) {
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
        step[axis] = method->is_rounded ? rintf(step[axis]) : floorf(step[axis] + 0.5f);
    if (method->far_on_grid && fmaxf(fabsf(step[0]), fabsf(step[1])) >= FAR_PX) {
        for (int32_t axis = 0; axis < 2; axis++)
            step[axis] = CRV__PHASES * rintf(step[axis] / CRV__PHASES);
    }
}

/* What only jittered methods have of a sample. */
static void fill_jittered(const crv__frame *f, const crv__noise_texel *noise, int32_t k,
                          int32_t i, float radius, const float step[2],
                          crv__sample *sample, crv__sample_place *place)
{
    const crv__params *p = f->params;
    const crv__vec2 to = crv__direction(f, noise, k);
    const float length = hypotf(to.x * (radius * (p->fx * p->inv_fy)), to.y * radius);
    fill_cell(p, i, jittered_share(p, noise, k, i, length), length, sample);
    place->du = (int16_t)fmaxf(fminf(step[0], INT16_MAX), INT16_MIN);
}

/* One list: the samples of one bucket and phase. */
static void fill_list(const fill_job *job, uint32_t index)
{
    crv__deinterleaved *di = &job->state->di;
    const crv__deinterleaved_method *method = job->state->method;
    const crv__params *p = job->frame->params;
    const int32_t phase = (int32_t)index % PHASES, px = phase % CRV__PHASES;
    const crv__noise_texel *noise =
        &job->frame->noise[phase / CRV__PHASES % p->noise_size * p->noise_size
                           + px % p->noise_size];
    const float radius = radius_of(di, (int32_t)index / PHASES) / di->scale[phase];
    crv__list_footprint footprint = {.radius = radius};
    for (int32_t k = 0; k < di->slices; k++) {
        const size_t first =
            ((size_t)index * (size_t)di->slices + (size_t)k) * (size_t)di->steps;
        uint16_t count = 0;
        for (int32_t i = 0; i < di->steps; i++) {
            float step[2];
            step_to(method, job->frame, noise, k,
                    method->in_slices ? i : i * (1 + di->paired),
                    radius * (p->fx * p->inv_fy), radius, step);
            if (!method->keeps_centre && step[0] == 0 && step[1] == 0)
                continue;
            crv__sample_place *place = &di->places[first + count];
            fill_sample(di, p, phase, step[0], step[1], &di->samples[first + count],
                        place);
            place->index = (int16_t)i;
            if (method->jittered)
                fill_jittered(job->frame, noise, k, i, radius, step,
                              &di->samples[first + count], place);
            extend(&footprint, place);
            count++;
        }
        di->counts[(size_t)index * (size_t)di->slices + (size_t)k] = count;
    }
    di->footprints[index] = footprint;
}

static void fill_bucket(void *data, uint32_t index)
{
    for (uint32_t i = 0; i < PHASES; i++)
        fill_list(data, index * PHASES + i);
}

static void deinterleave_rows(void *data, uint32_t index)
{
    enum { ROWS = 16 };
    const fill_job *job = data;
    const int32_t first = (int32_t)index * ROWS, height = job->frame->params->height;
    for (int32_t y = first; y < first + ROWS && y < height; y++)
        job->state->deinterleave(job->frame, &job->state->di, y);
}

const crv__deinterleaved *crv__deinterleaved_prepare(crv__deinterleaved_state *s,
                                                     const crv__setup *setup,
                                                     const crv__frame *frame)
{
    const crv__params *p = frame->params;
    fill_job job = {s, frame};
    if (s->fx != p->fx || s->fy != p->fy) {
        crv__run_parallel(setup->context, (uint32_t)s->di.buckets, fill_bucket, &job);
        s->fx = p->fx;
        s->fy = p->fy;
    }
    s->di.cap = !s->method->in_slices ? INFINITY
                : p->fx > p->fy       ? p->max_radius_px * (p->fy / p->fx)
                                      : p->max_radius_px;
    s->di.extends = s->method->jittered && p->border != CRV_BORDER_BACKGROUND;
    s->di.background = p->orthographic ? 1e18f : 1024 * p->radius * p->fy;
    if (s->di.extends)
        crv__border_fill(&s->di, frame);
    crv__run_parallel(setup->context, (uint32_t)(p->height + 15) / 16, deinterleave_rows,
                      &job);
    return &s->di;
}

crv__deinterleaved_kernel crv__deinterleaved_kernel_of(const crv__deinterleaved_state *s,
                                                       bool with_bent)
{
    return with_bent ? s->method->run_bent : s->method->run;
}

int crv__deinterleaved_is_beyond(const crv__deinterleaved *di, const crv__params *p,
                                 float depth)
{
    const float radius = p->radius * p->fy;
    return depth < di->background
           && !((p->orthographic ? radius : radius * (1 / depth)) < di->largest);
}
