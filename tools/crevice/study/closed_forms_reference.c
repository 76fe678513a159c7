/* SPDX-License-Identifier: MIT */
#include "closed_forms_reference.h"

#include <math.h>

#include "closed_forms.h"
#include "fitted_order.h"
#include "plot.h"

/* The strip of `builtin:groove` that is traced: both walls up to R = 1. */
enum { WIDTH = 92, HEIGHT = 4, PX_PER_UNIT = 64 };

enum { MAX_POINTS = 5 };
static const int32_t FEWEST_RAYS = 16; /* four times as many from point to point */

typedef struct integral {
    const char *name;
    reference_definition definition;
    crv_weighting weighting;
    crv_falloff falloff;
    double (*occlusion)(double c);
} integral;

static const integral INTEGRALS[] = {
    {"cosine, none", REFERENCE_HEMISPHERE, CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE,
     closed_form_cosine_none},
    {"cosine, linear", REFERENCE_HEMISPHERE, CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR,
     closed_form_cosine_linear},
    {"uniform, none", REFERENCE_HEMISPHERE, CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE,
     closed_form_uniform_none},
    {"uniform, linear", REFERENCE_HEMISPHERE, CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR,
     closed_form_uniform_linear},
    {"tangent sphere", REFERENCE_TANGENT_SPHERE, CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE,
     closed_form_tangent_sphere}};
enum { INTEGRAL_COUNT = sizeof INTEGRALS / sizeof *INTEGRALS };

/* Fewer for a quick look at small pictures, as the estimates have it. */
static int32_t point_count(const study *s)
{
    return s->main->height < 180 ? MAX_POINTS - 2 : MAX_POINTS;
}

typedef struct traced {
    double rays[MAX_POINTS], rms[MAX_POINTS];
    double claimed[MAX_POINTS]; /* RMS of the standard errors that the reference states */
    double mean;                /* signed error at most rays */
} traced;

static int trace(study *s, const scene *model, const scene_gbuffer *g, const integral *in,
                 int32_t k, traced *out)
{
    int32_t rays = FEWEST_RAYS << (2 * k), count = 0;
    double squares = 0.0, claimed = 0.0, sum = 0.0;
    reference_options o = {.definition = in->definition,
                           .weighting = in->weighting,
                           .falloff = in->falloff,
                           .tau = 3.0f,
                           .u = 0.1f,
                           .radius = 1.0f,
                           .rays = rays};
    reference *r;

    if (reference_create(model, g, &o, &r, &s->r->logger) != 0)
        return EXIT_FAILED;
    reference_advance(r, reference_total(r), s->threads);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        double x = fabs(i % WIDTH + 0.5 - 0.5 * WIDTH) / PX_PER_UNIT, error, known;
        double c = x * sqrt(2.0);
        if (c < 0.1 || c > 1.0)
            continue;
        error = (double)reference_accessibility(r)[i] - (1.0 - in->occlusion(c));
        known = (double)reference_error(r)[i];
        squares += error * error;
        claimed += known * known;
        sum += error;
        count++;
    }
    reference_free(r);
    out->rays[k] = rays;
    out->rms[k] = sqrt(squares / count);
    out->claimed[k] = sqrt(claimed / count);
    out->mean = sum / count;
    return EXIT_DONE;
}

static int trace_all(study *s, traced out[INTEGRAL_COUNT])
{
    scene *model = NULL;
    scene_gbuffer g = {0};
    scene_gbuffer_request request = {
        .width = WIDTH, .height = HEIGHT, .layers = 1, .threads = s->threads};
    int code = EXIT_DONE;

    if (scene_builtin("groove", &model, &s->r->logger) != 0)
        return EXIT_FAILED;
    scene_frame(model, 1.0f, (float)WIDTH / HEIGHT, &request.view);
    request.view.view_height = (float)HEIGHT / PX_PER_UNIT;
    if (scene_render_gbuffer(model, &request, &g, &s->r->logger) != 0)
        code = EXIT_FAILED;
    for (int32_t i = 0; i < INTEGRAL_COUNT && code == EXIT_DONE; i++) {
        study_progress(s, "closed forms: ray tracing, %s", INTEGRALS[i].name);
        for (int32_t k = 0; k < point_count(s) && code == EXIT_DONE; k++)
            code = trace(s, model, &g, &INTEGRALS[i], k, &out[i]);
    }
    scene_gbuffer_free(&g);
    scene_free(model);
    return code;
}

static void plot_traced(study *s, const traced all[INTEGRAL_COUNT])
{
    plot_series series[INTEGRAL_COUNT + 2];
    double ends[2] = {all[0].rays[0], all[0].rays[point_count(s) - 1]}, guides[2][2];
    double start = 0.0;

    for (int32_t i = 0; i < INTEGRAL_COUNT; i++) {
        series[i] = (plot_series){.name = INTEGRALS[i].name,
                                  .x = all[i].rays,
                                  .y = all[i].rms,

                                  .count = point_count(s),
                                  .is_line = true};
        start = fmax(start, all[i].rms[0]);
    }
    for (int32_t k = 0; k < 2; k++) {
        guides[k][0] = start;
        guides[k][1] = start * pow(ends[1] / ends[0], k == 0 ? -0.5 : -1.0);
        series[INTEGRAL_COUNT + k] = (plot_series){.name = k == 0 ? "1/sqrt(n)" : "1/n",
                                                   .x = ends,
                                                   .y = guides[k],
                                                   .count = 2,
                                                   .is_line = true,
                                                   .is_guide = true};
    }
    page_plot(s->page, &(plot){.caption = "Ray-traced reference on `builtin:groove`: RMS "
                                          "error over the rays of each pixel.",
                               .x_title = "rays for each pixel",
                               .y_title = "RMS error of accessibility",
                               .log_x = true,
                               .log_y = true,
                               .series = series,
                               .series_count = INTEGRAL_COUNT + 2});
}

static void write_traced(study *s, const traced all[INTEGRAL_COUNT], cJSON *array)
{
    static const char *const headers[] = {
        "closed form",      "order",           "rays", "RMS error there",
        "its own estimate", "mean error there"};

    int32_t points = point_count(s);

    page_table_begin(s->page,
                     "Ray-traced reference: measured order, and how near it comes to the "
                     "closed forms",
                     headers, 6);
    for (int32_t i = 0; i < INTEGRAL_COUNT; i++) {
        const traced *t = &all[i];
        double order = fitted_order(t->rays, t->rms, points);
        cJSON *item = cJSON_CreateObject();
        page_cell(s->page, "%s", INTEGRALS[i].name);
        page_cell(s->page, "%.2f", order);
        page_cell(s->page, "%.0f", t->rays[points - 1]);
        page_cell(s->page, "%.1e", t->rms[points - 1]);
        page_cell(s->page, "%.1e", t->claimed[points - 1]);
        page_cell(s->page, "%+.1e", t->mean);
        cJSON_AddItemToArray(array, item);
        cJSON_AddStringToObject(item, "closed_form", INTEGRALS[i].name);
        cJSON_AddItemToObject(item, "rays", cJSON_CreateDoubleArray(t->rays, points));
        cJSON_AddItemToObject(item, "rmse", cJSON_CreateDoubleArray(t->rms, points));
        cJSON_AddItemToObject(item, "standard_error",
                              cJSON_CreateDoubleArray(t->claimed, points));
        cJSON_AddNumberToObject(item, "order", order);
    }
    page_table_end(s->page);
}

int closed_forms_reference(study *s, cJSON *json)
{
    traced all[INTEGRAL_COUNT];
    cJSON *array = cJSON_AddArrayToObject(json, "reference");
    int code = trace_all(s, all);

    if (code != EXIT_DONE)
        return code;
    page_heading(s->page, 3, "closed-forms-reference", "The reference itself");
    page_text(
        s->page,
        "The same groove, ray traced as the references of this page are. Its samples "
        "are low-discrepancy: independent ones would have order 0.5, and a smooth "
        "integrand allows more. The standard error that the reference states of "
        "itself stands beside the true one.");
    plot_traced(s, all);
    write_traced(s, all, array);
    return EXIT_DONE;
}
