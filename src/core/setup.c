/* SPDX-License-Identifier: MIT */
#include "core/setup.h"

#include "core/gbuffer.h"
#include "core/noise.h"
#include "core/options.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static const crv__map *needed_map(const crv__method *method, const crv_options *options)
{
    return method->map ? method->map(options) : NULL;
}

static bool wants_bent(const crv_options *options)
{
    return options->bent_normal && options->method->bent_normal;
}

crv__setup crv__setup_make(const crv_context *context, const crv_options *options,
                           const crv_gbuffer_desc *desc)
{
    const crv__method *method = crv__method_of(options->method);
    return (crv__setup){.context = context,
                        .method = method,
                        .filter =
                            options->filter ? crv__filter_of(options->filter) : NULL,
                        .map = needed_map(method, options),
                        .has_bent = wants_bent(options),
                        .options = *options,
                        .desc = *desc};
}

crv_status crv__setup_take(const crv_context *context, const crv_options *options,
                           const crv_gbuffer_desc *desc, crv__setup *setup)
{
    crv_options full_options;
    crv_gbuffer_desc full_desc;
    crv_status status = crv__options_take(&context->logger, options, &full_options);
    if (status == CRV_OK)
        status = crv__gbuffer_desc_take(&context->logger, desc, &full_desc);
    if (status == CRV_OK)
        *setup = crv__setup_make(context, &full_options, &full_desc);
    return status;
}

/* ---- params ---- */

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
    p->weighting = (int32_t)o->weighting;
    p->border = (int32_t)o->border;
    p->thickness_rule = (int32_t)o->thickness_rule;
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

/* ---- patterns ---- */

static size_t noise_count(const crv_options *options)
{
    return (size_t)options->noise_size * (size_t)options->noise_size;
}

static size_t point_count(const crv__method *method, const crv_options *options)
{
    return method->pattern_fill ? (size_t)options->samples : 0;
}

crv_status crv__setup_patterns(crv__setup *s)
{
    const crv_allocator *allocator = &s->context->allocator;
    s->noise_count = noise_count(&s->options);
    s->direction_count = (size_t)s->options.directions;
    s->point_count = point_count(s->method, &s->options);
    s->directions = crv__allocate(allocator, s->direction_count, 2 * sizeof(float));
    s->noise = crv__allocate(allocator, s->noise_count, sizeof *s->noise);
    s->noise_scratch = crv__allocate(allocator, s->noise_count, sizeof(uint32_t));
    if (s->point_count > 0)
        s->pattern = crv__allocate(allocator, s->point_count, 4 * sizeof(float));
    if (!s->directions || !s->noise || !s->noise_scratch
        || (s->point_count > 0 && !s->pattern))
        return CRV_ERROR_OUT_OF_MEMORY;
    crv__setup_fill(s);
    return CRV_OK;
}

void crv__setup_release(crv__setup *s)
{
    const crv_allocator *allocator = &s->context->allocator;
    crv__release(allocator, s->noise_scratch, s->noise_count, sizeof(uint32_t));
    crv__release(allocator, s->noise, s->noise_count, sizeof *s->noise);
    crv__release(allocator, s->directions, s->direction_count, 2 * sizeof(float));
    crv__release(allocator, s->pattern, s->point_count, 4 * sizeof(float));
}

void crv__setup_fill(const crv__setup *s)
{
    const int32_t count = s->options.directions;
    for (int32_t k = 0; k < count; k++) {
        s->directions[2 * k] = (float)cos(2 * PI * k / count);
        s->directions[2 * k + 1] = (float)sin(2 * PI * k / count);
    }
    if (s->pattern)
        s->method->pattern_fill(&s->options, s->pattern);
    const crv_options *o = &s->options;
    const double sector_rad = s->pattern ? 2 * PI : 2 * PI / count;
    crv__noise_fill(s->noise, o->noise_size, sector_rad, o->seed, s->noise_scratch);
    crv__noise_advance(s->noise, o->noise_size, sector_rad, (uint32_t)o->noise_index,
                       s->noise);
}

const crv__map *crv__setup_map(const crv__setup *s)
{
    return needed_map(s->method, &s->options);
}

bool crv__setup_bent(const crv__setup *s)
{
    return wants_bent(&s->options);
}

/* ---- sizes ---- */

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

crv__rectangle crv__setup_rectangle(const crv__setup *setup)
{
    const crv_gbuffer_desc *d = &setup->desc;
    const int32_t radius_px = setup->filter ? setup->filter->radius_px : 0;
    const int32_t x0 = d->guard_left - least(d->guard_left, radius_px);
    const int32_t y0 = d->guard_top - least(d->guard_top, radius_px);
    const int32_t x1 = d->width - d->guard_right + least(d->guard_right, radius_px);
    const int32_t y1 = d->height - d->guard_bottom + least(d->guard_bottom, radius_px);
    return (crv__rectangle){x0, y0, x1 - x0, y1 - y0};
}

static bool same_rectangle(const crv__setup *a, const crv__setup *b)
{
    const crv__rectangle r = crv__setup_rectangle(a), q = crv__setup_rectangle(b);
    return r.x == q.x && r.y == q.y && r.width == q.width && r.height == q.height;
}

const char *crv__setup_obstacle(const crv__setup *s, const crv_options *options)
{
    const crv__setup next = crv__setup_make(s->context, options, &s->desc);
    if (next.method != s->method)
        return "method";
    if (!next.filter != !s->filter || !same_rectangle(&next, s))
        return "filter";
    if (noise_count(options) != s->noise_count)
        return "noise_size";
    if ((size_t)options->directions > s->direction_count)
        return "directions";
    if (next.map && next.map != s->map)
        return next.map->option;
    if (next.has_bent && !s->has_bent)
        return "bent_normal";
    return point_count(s->method, options) > s->point_count ? "samples" : NULL;
}

bool crv__setup_revise(crv__setup *s, const crv_options *options)
{
    const crv__setup next = crv__setup_make(s->context, options, &s->desc);
    if (crv__setup_obstacle(s, options))
        return false;
    s->filter = next.filter;
    s->options = *options;
    return true;
}
