/* SPDX-License-Identifier: MIT */
/*
 * Compositing with a multisampled frame: Morgan McGuire, Brian Osman, Michael Bukowski,
 * Padraic Hennessy: The Alchemy Screen-Space Ambient Obscurance Algorithm, HPG 2011,
 * section 2, final compositing.
 */
#include "core/gbuffer.h"

#include <math.h>

typedef struct gather_job {
    const crv_gbuffer *gbuffer;
    const crv_const_image *accessibility, *sample_depth;
    const crv_image *result;
    crv__depth_map map;
    float depth_range;
} gather_job;

/* The surfaces in a pixel's cross neighbourhood, itself first. */
typedef struct cross {
    float depth[5], accessibility[5];
    int32_t count;
} cross;

static cross cross_at(const gather_job *job, int32_t x, int32_t y)
{
    static const int32_t OFFSETS[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    const crv_const_image *image = job->accessibility;
    const crv_gbuffer_desc *desc = &job->gbuffer->desc;
    cross c = {.count = 0};
    for (int32_t i = 0; i < 5; i++) {
        const int32_t u = x + OFFSETS[i][0], v = y + OFFSETS[i][1];
        if (u < 0 || v < 0 || u >= image->width || v >= image->height)
            continue;
        const float d = *crv__plane_at(&job->gbuffer->depth[0], u + desc->guard_left,
                                       v + desc->guard_top);
        if (!(d < INFINITY))
            continue;
        const float a = *crv_const_image_at(image, u, v, 0);
        c.depth[c.count] = d;
        c.accessibility[c.count++] = isfinite(a) ? fminf(fmaxf(a, 0), 1) : 1;
    }
    return c;
}

/* Proximity falls linearly to 0 at the range, as in the filters. */
static float gather(const cross *c, float depth, float range)
{
    float sum = 0, weights = 0, least = INFINITY, nearest = 1;
    for (int32_t i = 0; i < c->count; i++) {
        const float deviation = fabsf(c->depth[i] - depth);
        const float weight = 1 - deviation / range;
        if (weight > 0) {
            sum += weight * c->accessibility[i];
            weights += weight;
        }
        if (deviation < least) {
            least = deviation;
            nearest = c->accessibility[i];
        }
    }
    return weights > 0 ? fminf(sum / weights, 1) : nearest;
}

static void gather_row(void *data, uint32_t row)
{
    const gather_job *job = data;
    const crv_gbuffer_desc *desc = &job->gbuffer->desc;
    const int32_t y = (int32_t)row;
    for (int32_t x = 0; x < job->result->width; x++) {
        const cross c = cross_at(job, x, y);
        for (int32_t s = 0; s < job->result->channels; s++) {
            const float d =
                crv__depth_map_apply(&job->map, x + desc->guard_left, y + desc->guard_top,
                                     *crv_const_image_at(job->sample_depth, x, y, s));
            *crv_image_at(job->result, x, y, s) =
                d < INFINITY ? gather(&c, d, job->depth_range) : 1;
        }
    }
}

static crv_status check(const crv_gbuffer *g, const crv_const_image *accessibility,
                        const crv_const_image *sample_depth, float depth_range,
                        const crv_image *result)
{
    const crv_logger *logger = &g->context->logger;
    const int32_t width = g->desc.width - g->desc.guard_left - g->desc.guard_right;
    const int32_t height = g->desc.height - g->desc.guard_top - g->desc.guard_bottom;
    if (!g->has_camera || !(g->has_depth & 1))
        return crv__fail(logger, CRV_ERROR_NOT_READY,
                         "multisample: the G-buffer lacks %s; set it first",
                         g->has_camera ? "depth layer 0" : "its camera");
    if (!(depth_range > 0) || !isfinite(depth_range))
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "multisample: depth range %g; it must be positive and finite",
                         (double)depth_range);
    const int32_t samples = sample_depth ? sample_depth->channels : 2;
    if (samples < 2 || samples > CRV_MAX_SUBSAMPLES)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "sample depth: %d channels; one for each sample, 2 to %d",
                         samples, CRV_MAX_SUBSAMPLES);
    crv_status status =
        crv__input_check(logger, "accessibility", accessibility, width, height, 1);
    if (status == CRV_OK)
        status = crv__input_check(logger, "sample depth", sample_depth, width, height,
                                  samples);
    if (status == CRV_OK)
        status = crv__output_check(logger, "result", result, width, height, samples);
    if (status == CRV_OK && result->data == accessibility->data)
        status = crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                           "result: is the accessibility image too; give it its own");
    return status;
}

crv_status crv_multisample_gather(crv_gbuffer *gbuffer,
                                  const crv_const_image *accessibility,
                                  const crv_const_image *sample_depth,
                                  const crv_depth_format *format, float depth_range,
                                  const crv_image *result)
{
    if (!gbuffer)
        return CRV_ERROR_INVALID_ARGUMENT;
    gather_job job = {.gbuffer = gbuffer,
                      .accessibility = accessibility,
                      .sample_depth = sample_depth,
                      .result = result,
                      .depth_range = depth_range};
    crv_status status = check(gbuffer, accessibility, sample_depth, depth_range, result);
    if (status == CRV_OK)
        status = crv__depth_map_init(&job.map, &gbuffer->context->logger,
                                     &gbuffer->camera, format);
    if (status)
        return status;
    crv__run_parallel(gbuffer->context, (uint32_t)result->height, gather_row, &job);
    return CRV_OK;
}
