/* SPDX-License-Identifier: MIT */
/* run.c: estimates: options, times, integrals. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study_cache.h"

/* A first run that takes so long needs no second to be timed. */
#define LONG_RUN_MS 500.0
/* No further run is begun after so much. */
#define ENOUGH_MS 2000.0

enum { REPEATS_MAX = 64 };

static bool reads(const crv_options *o, const char *key)
{
    const crv_option *option = crv_option_find(key);

    return option != NULL && crv_option_applies(option, o->method, o->filter) != 0;
}

crv_options study_options(const study_view *v, const char *method, crv_preset preset)
{
    crv_options o;

    crv_options_init(&o, sizeof o, method);
    crv_options_preset(&o, preset);
    o.radius = v->radius;
    return o;
}

double study_samples(const crv_options *options)
{
    double directions = options->directions, steps = options->steps;

    if (!reads(options, "directions"))
        return options->samples;
    if (strcmp(options->method->name, "hsao") == 0)
        return directions * steps * (1.0 + options->normal_rays);
    if (reads(options, "normal_rays"))
        return directions * steps * options->normal_rays;
    return directions * steps;
}

study_target study_target_of(const crv_options *options)
{
    const char *name = options->method->name;
    study_target t = {.definition = REFERENCE_HEMISPHERE,
                      .weighting = options->method->weighting,
                      .falloff = options->falloff,
                      .tau = options->tau,
                      .u = options->u};

    if (strcmp(name, "vao") == 0)
        t.definition = REFERENCE_TANGENT_SPHERE;
    else if (strcmp(name, "alchemy") == 0)
        t.falloff = CRV_FALLOFF_ALCHEMY;
    else if (strcmp(name, "vo") == 0)
        t.falloff = CRV_FALLOFF_CUBIC;
    else if (strcmp(name, "ssao") == 0)
        t.falloff = CRV_FALLOFF_NONE;
    return t;
}

const char *study_target_name(const study_target *target)
{
    static const char *const names[2][6] = {
        {"uniform, none", "uniform, linear", "uniform, sqrt", "uniform, cubic",
         "uniform, exponential", "uniform, alchemy"},
        {"cosine, none", "cosine, linear", "cosine, sqrt", "cosine, cubic",
         "cosine, exponential", "cosine, alchemy"},
    };

    if (target->definition == REFERENCE_TANGENT_SPHERE)
        return "tangent sphere";
    return names[target->weighting == CRV_WEIGHTING_COSINE][target->falloff];
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static double median(double *values, int32_t count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return count % 2 == 1 ? values[count / 2]
                          : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/* Milliseconds of one run; negative after an error. */
static double timed_run(study *s, crv_plan *plan, crv_gbuffer *gbuffer,
                        const crv_image *result)
{
    double start = report_seconds();

    if (!report_ok(s->r, crv_plan_run(plan, gbuffer, result), "estimation"))
        return -1.0;
    return 1e3 * (report_seconds() - start);
}

static int run_plan(study *s, crv_plan *plan, crv_gbuffer *gbuffer,
                    const crv_image *result, int32_t repeats, double *ms)
{
    double times[REPEATS_MAX], total = timed_run(s, plan, gbuffer, result);
    int32_t count = 0;

    *ms = NAN;
    if (total < 0.0)
        return EXIT_FAILED;
    if (repeats > 0 && total >= LONG_RUN_MS)
        times[count++] = total;
    while (count < repeats && count < REPEATS_MAX && !(count > 0 && total >= ENOUGH_MS)) {
        double time = timed_run(s, plan, gbuffer, result);
        if (time < 0.0)
            return EXIT_FAILED;
        times[count++] = time;
        total += time;
    }
    if (count > 0)
        *ms = median(times, count);
    return EXIT_DONE;
}

static crv_plan *make_plan(study *s, const crv_options *options,
                           const crv_gbuffer_desc *desc)
{
    crv_plan *plan = NULL;

    report_ok(s->r, crv_plan_create(s->context, options, desc, &plan), "plan");
    return plan;
}

int study_run(study *s, study_view *v, const crv_options *options, study_buffers buffers,
              int32_t repeats, study_estimate *out)
{
    size_t count = (size_t)v->width * (size_t)v->height;
    const study_gbuffer_entry *g;
    int result = study_cached_gbuffer(s, v, buffers, &g);
    crv_plan *plan = NULL;
    crv_image image;

    *out = (study_estimate){.ms = NAN, .samples = study_samples(options)};
    if (result != EXIT_DONE || page_failed(s->page))
        return EXIT_FAILED;
    out->accessibility = malloc(count * sizeof *out->accessibility);
    if (out->accessibility == NULL)
        return report_no_memory(s->r);
    image = crv_image_packed(out->accessibility, v->width, v->height, 1);
    plan = make_plan(s, options, &g->cast.desc);
    result = plan != NULL ? run_plan(s, plan, g->uploaded, &image, repeats, &out->ms)
                          : EXIT_FAILED;
    crv_plan_destroy(plan);
    if (result != EXIT_DONE) {
        free(out->accessibility);
        out->accessibility = NULL;
    }
    return result;
}

int study_filter(study *s, study_view *v, const crv_options *options, const float *input,
                 float *output)
{
    size_t size = (size_t)v->width * (size_t)v->height * sizeof *output;
    crv_image image = crv_image_packed(output, v->width, v->height, 1);
    crv_const_image unfiltered = crv_image_const(image);
    const study_gbuffer_entry *g;
    int result = study_cached_gbuffer(s, v, STUDY_ONE_LAYER, &g);
    crv_plan *plan;

    if (result != EXIT_DONE)
        return result;
    plan = make_plan(s, options, &g->cast.desc);
    if (plan == NULL)
        return EXIT_FAILED;
    if (input != output)
        memcpy(output, input, size);
    if (!report_ok(s->r, crv_plan_filter(plan, g->uploaded, &unfiltered, &image),
                   "filter"))
        result = EXIT_FAILED;
    crv_plan_destroy(plan);
    return result;
}

static bool fill(study *s, crv_gbuffer *g, const crv_camera *camera, const float *depth,
                 const float *normals, int32_t width, int32_t height)
{
    crv_const_image d = crv_const_image_packed(depth, width, height, 1);
    crv_const_image n = crv_const_image_packed(normals, width, height, 3);
    crv_status status = crv_gbuffer_set_camera(g, camera);

    if (status == CRV_OK)
        status = crv_gbuffer_set_depth(g, 0, &d, NULL);
    if (status == CRV_OK && normals != NULL)
        status = crv_gbuffer_set_normals(g, &n, CRV_NORMAL_VIEW);
    return report_ok(s->r, status, "G-buffer");
}

int study_run_buffers(study *s, const crv_camera *camera, const float *depth,
                      const float *normals, int32_t width, int32_t height,
                      const crv_options *options, float *accessibility)
{
    crv_image image = crv_image_packed(accessibility, width, height, 1);
    crv_gbuffer_desc desc;
    crv_gbuffer *g = NULL;
    crv_plan *plan = NULL;
    int result = EXIT_FAILED;

    crv_gbuffer_desc_init(&desc, sizeof desc, width, height);
    if (report_ok(s->r, crv_gbuffer_create(s->context, &desc, &g), "G-buffer")
        && fill(s, g, camera, depth, normals, width, height)
        && (plan = make_plan(s, options, &desc)) != NULL
        && report_ok(s->r, crv_plan_run(plan, g, &image), "estimation"))
        result = EXIT_DONE;
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(g);
    return result;
}
