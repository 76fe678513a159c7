/* SPDX-License-Identifier: MIT */
#include "tune_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "estimate.h"

/* Rays of a pass, and the standard error from which more of them tell nothing. */
enum { PASS_RAYS = 8, PASSES_MIN = 2 };
#define ERROR_ENOUGH 0.01

static bool is_surface(const tune_view *v, const float *depth, int32_t x, int32_t y)
{
    const size_t at = (size_t)(y + v->desc.guard_top) * (size_t)v->desc.width
                      + (size_t)(x + v->desc.guard_left);
    return depth[at] > 0.0f && isfinite(depth[at]);
}

/* Odd, so that the grid meets all phases of the noise tile. */
static int32_t grid_step(const tune_view *v, int32_t most)
{
    const double pixels = (double)v->width * (double)v->height;
    int32_t step = 1;
    while (most > 0 && pixels / ((double)step * (double)step) > (double)most)
        step += 2;
    return step;
}

bool tune_view_open(tune_view *v, crv_context *context, crv_gbuffer *gbuffer,
                    const crv_gbuffer_desc *desc, const float *depth, int32_t most)
{
    *v = (tune_view){.context = context, .gbuffer = gbuffer, .desc = *desc};
    v->width = desc->width - desc->guard_left - desc->guard_right;
    v->height = desc->height - desc->guard_top - desc->guard_bottom;
    const int32_t step = grid_step(v, most);
    const size_t room =
        ((size_t)v->width / (size_t)step + 1) * ((size_t)v->height / (size_t)step + 1);
    v->pixel = malloc(room * sizeof *v->pixel);
    v->truth = calloc(room, sizeof *v->truth);
    v->result = malloc((size_t)v->width * (size_t)v->height * sizeof *v->result);
    if (!v->pixel || !v->truth || !v->result)
        return false;
    for (int32_t y = step / 2; y < v->height; y += step)
        for (int32_t x = step / 2; x < v->width; x += step)
            if (is_surface(v, depth, x, y))
                v->pixel[v->count++] = y * v->width + x;
    return true;
}

void tune_view_free(tune_view *v)
{
    crv_plan_destroy(v->plan);
    free(v->result);
    free(v->pixel);
    free(v->truth);
    *v = (tune_view){0};
}

void tune_view_take(tune_view *v, const float *truth)
{
    for (int32_t i = 0; i < v->count; i++)
        v->truth[i] = truth[v->pixel[i]];
}

/* One more pass into mean and spread, the sum of squared deviations from it. */
static void add_pass(tune_view *v, const reference *work, int32_t threads, double *spread)
{
    const int32_t passes = v->rays / PASS_RAYS + 1;
#ifdef _OPENMP
    const int wanted = threads > 0 ? threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 64) num_threads(wanted)
#else
    (void)threads;
#endif
    for (int32_t i = 0; i < v->count; i++) {
        const reference_value value =
            reference_pixel(work, v->pixel[i] % v->width, v->pixel[i] / v->width);
        const double deviation = (double)value.accessibility - (double)v->truth[i];
        v->truth[i] += (float)(deviation / passes);
        spread[i] += deviation * ((double)value.accessibility - (double)v->truth[i]);
    }
    v->rays += PASS_RAYS;
}

static double noise_of(const tune_view *v, const double *spread)
{
    const double passes = v->rays / PASS_RAYS;
    double sum = 0.0;
    for (int32_t i = 0; i < v->count; i++)
        sum += spread[i];
    return v->count > 0 ? sum / (passes * (passes - 1.0) * v->count) : 0.0;
}

/* Of the work: the rays that are wanted, or as many as bring the noise down, or as there
 * is time for. */
static double share_done(const tune_view *v, const tune_trace *t, double start)
{
    if (t->rays > 0)
        return fmin((double)v->rays / t->rays, 1.0);
    const double clear = v->noise > 0.0 ? ERROR_ENOUGH * ERROR_ENOUGH / v->noise : 0.0;
    return fmin(fmax(clear, (report_seconds() - start) / t->seconds), 1.0);
}

static bool is_enough(const tune_view *v, const tune_trace *t, double start)
{
    if (v->rays < PASSES_MIN * PASS_RAYS)
        return false;
    if (t->rays > 0)
        return v->rays >= t->rays;
    return v->noise <= ERROR_ENOUGH * ERROR_ENOUGH || v->rays >= REFERENCE_MAX_RAYS
           || report_seconds() - start > t->seconds;
}

int tune_view_trace(tune_view *v, const tune_trace *t, const crv_logger *log)
{
    reference_options options = t->target;
    reference *work = NULL;
    double *spread = calloc((size_t)v->count + 1, sizeof *spread);
    bool given_up = !spread;
    const double start = report_seconds();
    v->rays = 0;
    memset(v->truth, 0, (size_t)v->count * sizeof *v->truth);
    options.rays = PASS_RAYS;
    options.seed = 1;
    if (spread && reference_create(t->model, t->g, &options, &work, log) != 0)
        given_up = true;
    while (!given_up && !is_enough(v, t, start)) {
        reference_restart(work, (uint32_t)(v->rays / PASS_RAYS) + 1);
        add_pass(v, work, t->threads, spread);
        v->noise = v->rays > PASS_RAYS ? noise_of(v, spread) : 0.0;
        if (t->watch)
            t->watch(t->user, share_done(v, t, start));
        given_up = t->stop && t->stop(t->user);
    }
    reference_free(work);
    free(spread);
    return given_up ? -1 : 0;
}

bool tune_view_is_open(const tune_view *v)
{
    for (int32_t i = 0; i < v->count; i++)
        if (!((double)v->truth[i] > 1.0 - 0.5 / 255.0))
            return false;
    return true;
}

crv_status tune_view_run(tune_view *v, const crv_options *options)
{
    const crv_image result = crv_image_packed(v->result, v->width, v->height, 1);
    const crv_status status =
        estimate_take(v->context, &v->desc, options, &v->plan, &v->options);
    return status == CRV_OK ? crv_plan_run(v->plan, v->gbuffer, &result) : status;
}

crv_status tune_view_measure(tune_view *v, const crv_options *options, tune_error *out)
{
    const crv_status status = tune_view_run(v, options);
    double sum = 0.0, squares = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    const double n = v->count;
    *out = (tune_error){NAN, NAN, NAN, NAN};
    if (status != CRV_OK || v->count == 0)
        return status;
    for (int32_t i = 0; i < v->count; i++) {
        const double x = (double)v->result[v->pixel[i]], y = (double)v->truth[i];
        sum += x - y;
        squares += (x - y) * (x - y);
        a += x;
        b += y;
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    const double variance = (aa - a * a / n) * (bb - b * b / n);
    out->mean_square = squares / n;
    out->rmse = sqrt(fmax(squares / n - v->noise, 0.0));
    out->bias = sum / n;
    if (variance > 0.0)
        out->correlation = (ab - a * b / n) / sqrt(variance);
    return status;
}
