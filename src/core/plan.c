/* SPDX-License-Identifier: MIT */
/* Plans: one method, one filter, one size; all memory taken ahead. */
#include "core/backend.h"
#include "core/gbuffer.h"
#include "core/noise.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/*
 * The planes cover the result and, where the guard band has room, the margin that the
 * filter reads beyond it, so that neighbouring pieces of a picture fit together after
 * filtering too.
 */
struct crv_plan {
    crv_context *context;
    crv__setup setup;
    void *state; /* the backend's */
    crv__params params;
    crv__plane planes[2]; /* the second only where there is a filter */
};

static size_t noise_count(const crv__setup *setup)
{
    return (size_t)setup->options.noise_size * (size_t)setup->options.noise_size;
}

static size_t pattern_count(const crv__setup *setup)
{
    return setup->method->pattern_fill ? (size_t)setup->options.samples : 0;
}

static int32_t wrapped(int64_t value, int32_t size)
{
    return (int32_t)((value % size + size) % size);
}

void crv__setup_params(const crv__setup *setup, crv__params *p)
{
    const crv_options *o = &setup->options;
    const crv_gbuffer_desc *d = &setup->desc;
    p->radius = o->radius;
    p->inv_radius = 1 / o->radius;
    p->falloff = (int32_t)o->falloff;
    p->tau = o->tau;
    p->u = o->u;
    p->max_radius_px = o->max_radius_px > 0 ? o->max_radius_px : INFINITY;
    p->directions = o->directions;
    p->steps = o->steps;
    p->sin_bias = (float)sin((double)o->bias_deg * PI / 180);
    p->cos_bias = (float)cos((double)o->bias_deg * PI / 180);
    p->attenuation = (int32_t)o->attenuation;
    p->noise_size = o->noise_size;
    p->noise_x = wrapped((int64_t)d->origin_x - d->guard_left, o->noise_size);
    p->noise_y = wrapped((int64_t)d->origin_y - d->guard_top, o->noise_size);
    p->intensity = o->intensity;
    p->contrast = o->contrast;
    p->layers_solid = d->layer_kind == CRV_LAYERS_SOLID;
    p->normal_rays = o->normal_rays;
    p->growing_sphere = o->growing_sphere;
    p->samples = o->samples;
    p->bands = o->bands;
    p->band_px = o->band_px;
    p->alchemy_bias = o->alchemy_bias;
    p->alchemy_eps = o->alchemy_eps;
    p->normaliser = (int32_t)o->normaliser;
    p->rescale = o->rescale;
    p->filter_depth = o->filter_depth * o->radius;
    p->filter_slope = o->filter_slope;
    p->filter_normal = o->filter_normal < 180
                           ? (float)(1 / (1 - cos((double)o->filter_normal * PI / 180)))
                           : 0;
    p->spacing = (int32_t)o->spacing;
    p->thickness = o->thickness > 0 ? o->thickness * o->radius : INFINITY;
}

int crv__setup_patterns(crv__setup *s)
{
    const crv_allocator *allocator = &s->context->allocator;
    const int has_pattern = s->method->pattern_fill != NULL;
    const int32_t count = s->options.directions;
    s->directions = crv__allocate(allocator, (size_t)count, 2 * sizeof(float));
    s->noise = crv__allocate(allocator, noise_count(s), sizeof *s->noise);
    uint32_t *scratch = crv__allocate(allocator, noise_count(s), sizeof *scratch);
    if (has_pattern)
        s->pattern = crv__allocate(allocator, pattern_count(s), 4 * sizeof(float));
    const int done = s->directions && s->noise && scratch && (s->pattern || !has_pattern);
    if (done) {
        for (int32_t k = 0; k < count; k++) {
            s->directions[2 * k] = (float)cos(2 * PI * k / count);
            s->directions[2 * k + 1] = (float)sin(2 * PI * k / count);
        }
        if (has_pattern)
            s->method->pattern_fill(&s->options, s->pattern);
        crv__noise_fill(s->noise, s->options.noise_size,
                        has_pattern ? 2 * PI : 2 * PI / count, s->options.seed, scratch);
    }
    crv__release(allocator, scratch, noise_count(s), sizeof *scratch);
    return done ? 0 : -1;
}

void crv__setup_release(crv__setup *s)
{
    const crv_allocator *allocator = &s->context->allocator;
    crv__release(allocator, s->noise, noise_count(s), sizeof *s->noise);
    crv__release(allocator, s->directions, (size_t)s->options.directions,
                 2 * sizeof(float));
    crv__release(allocator, s->pattern, pattern_count(s), 4 * sizeof(float));
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

crv__rectangle crv__setup_rectangle(const crv__setup *setup)
{
    const crv_gbuffer_desc *d = &setup->desc;
    const int32_t reach = setup->filter ? setup->filter->reach_px : 0;
    const int32_t x0 = d->guard_left - least(d->guard_left, reach);
    const int32_t y0 = d->guard_top - least(d->guard_top, reach);
    const int32_t x1 = d->width - d->guard_right + least(d->guard_right, reach);
    const int32_t y1 = d->height - d->guard_bottom + least(d->guard_bottom, reach);
    return (crv__rectangle){x0, y0, x1 - x0, y1 - y0};
}

static int create_planes(crv_plan *plan)
{
    const crv_allocator *allocator = &plan->context->allocator;
    const crv__rectangle r = crv__setup_rectangle(&plan->setup);
    for (int i = 0; i < (plan->setup.filter ? 2 : 1); i++) {
        if (crv__plane_create(&plan->planes[i], allocator, r.x, r.y, r.width, r.height))
            return -1;
    }
    return 0;
}

/* Methods that ask what is inside see nothing of a further surface unless they know or
 * assume where the one before it ends. */
static void warn_of_layers(const crv_logger *logger, const crv_options *options,
                           const crv_gbuffer_desc *desc)
{
    const int bounded =
        options->thickness > 0
        && crv_option_applies(crv_option_find("thickness"), options->method, NULL);
    if (crv__method_of(options->method)->volumetric && !bounded && desc->layers > 1
        && desc->layer_kind == CRV_LAYERS_SURFACES)
        crv__log(logger, CRV_LOG_WARNING,
                 "layers: %s uses further layers only as pairs of front and back "
                 "(CRV_LAYERS_SOLID); it sees the first",
                 options->method->name);
}

crv_status crv_plan_create(crv_context *context, const crv_options *options,
                           const crv_gbuffer_desc *desc, crv_plan **out)
{
    if (!context)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_logger *logger = &context->logger;
    if (!out)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT, "plan: out is NULL");
    crv_status status = crv_options_check(options, logger);
    if (status == CRV_OK)
        status = crv__gbuffer_desc_check(logger, desc);
    if (status)
        return status;
    warn_of_layers(logger, options, desc);
    crv_plan *plan = crv__allocate(&context->allocator, 1, sizeof *plan);
    if (plan) {
        plan->context = context;
        plan->setup = (crv__setup){.context = context,
                                   .method = crv__method_of(options->method),
                                   .options = *options,
                                   .desc = *desc};
        if (options->filter)
            plan->setup.filter = crv__filter_of(options->filter);
        crv__setup_params(&plan->setup, &plan->params);
        if (crv__setup_patterns(&plan->setup) == 0 && create_planes(plan) == 0) {
            status = context->backend->plan_create(&plan->setup, &plan->planes[0],
                                                   &plan->state);
            if (status == CRV_OK)
                *out = plan;
            else
                crv_plan_destroy(plan);
            return status;
        }
        crv_plan_destroy(plan);
    }
    return crv__fail(logger, CRV_ERROR_OUT_OF_MEMORY, "plan: no memory for %d x %d",
                     desc->width, desc->height);
}

void crv_plan_destroy(crv_plan *plan)
{
    if (!plan)
        return;
    const crv_allocator *allocator = &plan->context->allocator;
    crv__setup *s = &plan->setup;
    if (plan->state)
        plan->context->backend->plan_destroy(s, plan->state);
    crv__plane_destroy(&plan->planes[0], allocator);
    crv__plane_destroy(&plan->planes[1], allocator);
    crv__setup_release(s);
    crv__release(allocator, plan, 1, sizeof *plan);
}

static int same_desc(const crv_gbuffer_desc *a, const crv_gbuffer_desc *b)
{
    return a->width == b->width && a->height == b->height && a->layers == b->layers
           && a->layer_kind == b->layer_kind && a->guard_left == b->guard_left
           && a->guard_top == b->guard_top && a->guard_right == b->guard_right
           && a->guard_bottom == b->guard_bottom && a->origin_x == b->origin_x
           && a->origin_y == b->origin_y;
}

static crv_status check_image(const crv_plan *plan, const char *what,
                              const crv_image *image, int writes)
{
    const crv_gbuffer_desc *d = &plan->setup.desc;
    return crv__image_check(&plan->context->logger, what, image,
                            d->width - d->guard_left - d->guard_right,
                            d->height - d->guard_top - d->guard_bottom, 1, writes);
}

/* Which characteristic functions this frame has and the options ask for. A field alone
 * that is not there leaves everything outside. */
static void select_characteristic(crv_plan *plan, int32_t has_field)
{
    const crv_characteristic wanted = plan->setup.options.characteristic;
    plan->params.use_depth = wanted != CRV_CHARACTERISTIC_FIELD;
    plan->params.use_field = wanted != CRV_CHARACTERISTIC_DEPTH && has_field;
}

/* Checks the arguments of a run and makes the frame. */
static crv_status begin(crv_plan *plan, crv_gbuffer *g, const crv_image *result,
                        crv__frame *frame)
{
    if (!plan || !g)
        return CRV_ERROR_INVALID_ARGUMENT;
    if (g->context != plan->context || !same_desc(&g->desc, &plan->setup.desc))
        return crv__fail(&plan->context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "plan: the G-buffer was made with another desc or context");
    crv_status status = check_image(plan, "result", result, 1);
    if (status == CRV_OK)
        status = crv__gbuffer_prepare(g);
    if (status)
        return status;
    crv__gbuffer_params(g, &plan->params);
    *frame = (crv__frame){.params = &plan->params,
                          .depth = g->depth,
                          .normal = g->normal,
                          .noise = plan->setup.noise,
                          .directions = plan->setup.directions,
                          .pattern = plan->setup.pattern,
                          .field = g->has_field ? &g->field : NULL};
    select_characteristic(plan, g->has_field);
    return CRV_OK;
}

typedef struct copy_job {
    const crv_plan *plan;
    const crv__plane *from;
    const crv_image *to;
} copy_job;

static void copy_row(void *data, uint32_t index)
{
    const copy_job *job = data;
    const crv_gbuffer_desc *d = &job->plan->setup.desc;
    const int32_t y = (int32_t)index;
    const float *row = crv__plane_at(job->from, d->guard_left, d->guard_top + y);
    if (job->to->pixel_stride == sizeof(float)) {
        memcpy(crv_image_at(job->to, 0, y, 0), row,
               (size_t)job->to->width * sizeof(float));
        return;
    }
    for (int32_t x = 0; x < job->to->width; x++)
        *crv_image_at(job->to, x, y, 0) = row[x];
}

/* Runs the plan and copies the rectangle inside the guard band to the result. */
static crv_status finish(crv_plan *plan, const crv__frame *frame, int filter_only,
                         const crv_image *result)
{
    const crv__work work = {&plan->setup, plan->state, frame};
    copy_job job = {.plan = plan, .to = result};
    crv_status status =
        plan->context->backend->run(&work, filter_only, plan->planes, &job.from);
    if (status == CRV_OK)
        crv__run_rows(plan->context, result->height, copy_row, &job);
    return status;
}

crv_status crv_plan_run(crv_plan *plan, crv_gbuffer *gbuffer, const crv_image *result)
{
    crv__frame frame;
    crv_status status = begin(plan, gbuffer, result, &frame);
    return status ? status : finish(plan, &frame, 0, result);
}

typedef struct take_job {
    const crv_plan *plan;
    const crv_image *from;
    const crv__plane *to;
} take_job;

/* A row of the estimate's plane. Outside the given image its margin holds nothing: NaN,
 * which filters leave out. */
static void take_row(void *data, uint32_t index)
{
    const take_job *job = data;
    const crv_gbuffer_desc *d = &job->plan->setup.desc;
    const int32_t y = job->to->y0 + (int32_t)index;
    float *row = crv__plane_at(job->to, job->to->x0, y);
    const int holds = y >= d->guard_top && y < d->guard_top + job->from->height;
    const int32_t left = holds ? d->guard_left - job->to->x0 : job->to->width;
    const int32_t count = holds ? job->from->width : 0;
    for (int32_t x = 0; x < left; x++)
        row[x] = NAN;
    const ptrdiff_t stride = job->from->pixel_stride / (ptrdiff_t)sizeof(float);
    const float *from = holds ? crv_image_at(job->from, 0, y - d->guard_top, 0) : NULL;
    for (int32_t x = 0; x < count; x++)
        row[left + x] = fabsf(from[x * stride]) < INFINITY ? from[x * stride] : 1;
    for (int32_t x = left + count; x < job->to->width; x++)
        row[x] = NAN;
}

crv_status crv_plan_filter(crv_plan *plan, crv_gbuffer *gbuffer, const crv_image *input,
                           const crv_image *result)
{
    crv__frame frame;
    crv_status status = begin(plan, gbuffer, result, &frame);
    if (status == CRV_OK)
        status = check_image(plan, "input", input, 0);
    if (status)
        return status;
    take_job job = {plan, input, &plan->planes[0]};
    crv__run_rows(plan->context, job.to->height, take_row, &job);
    return finish(plan, &frame, 1, result);
}

crv_status crv_plan_device_times(const crv_plan *plan, crv_device_time *times,
                                 int32_t *count)
{
    if (!plan)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv__backend *backend = plan->context->backend;
    if (!times || !count)
        return crv__fail(&plan->context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "plan: times or count is NULL");
    if (!backend->times)
        return crv__fail(&plan->context->logger, CRV_ERROR_UNSUPPORTED,
                         "plan: %s has no clock of its own; time crv_plan_run()",
                         backend->name);
    return backend->times(&plan->setup, plan->state, times, count);
}
