/* SPDX-License-Identifier: MIT */
/*
 * section_structure.c: kernels that may move samples a little, or round their places
 * otherwise, beside those that sample exactly where the plain code does (--exact): the
 * error of both against the ray-traced reference, and their time.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/clock.h"
#include "common/device.h"
#include "sections.h"

/* How much larger the error may be for the fast structure to be the default. */
#define MAY_EXCEED 1.01

static const char *const METHODS[] = {"hbao",        "alchemy", "vo",
                                      "containment", "hsao",    "raymarch"};
enum { METHOD_COUNT = sizeof METHODS / sizeof METHODS[0] };

enum { FAST, EXACT, STRUCTURE_COUNT };
static const char *const STRUCTURES[] = {"fast", "exact"};

/* Runs that a time is the median of. */
enum { REPEATS = 5 };
#define SECONDS 0.5

typedef struct estimate {
    double rmse, ms;
} estimate;

/* [filtered][structure] */
typedef struct comparison {
    estimate e[2][STRUCTURE_COUNT];
    double apart[2]; /* RMSE of the two pictures against each other */
    float *picture[2][STRUCTURE_COUNT];
} comparison;

typedef struct run_data {
    crv_plan *plan;
    crv_gbuffer *gbuffer;
    crv_image image;
} run_data;

static bool run_once(void *data)
{
    run_data *d = data;

    return crv_plan_run(d->plan, d->gbuffer, &d->image) == CRV_OK;
}

static int run_filtered(study *s, study_view *v, const crv_options *options,
                        bool filtered, crv_context *context, run_data *d,
                        const float *truth, estimate *out, float **picture)
{
    const bench_clock clock = {.counter = -1, .repeats = REPEATS, .seconds = SECONDS};
    size_t count = (size_t)v->width * (size_t)v->height;
    crv_options o = *options;
    const scene_gbuffer *g;
    bench_time time;
    metrics m;
    int result = study_gbuffer(s, v, STUDY_ONE_LAYER, &g);

    *picture = malloc(count * sizeof **picture);
    if (result == EXIT_DONE && *picture == NULL)
        result = report_no_memory(s->r);
    if (result != EXIT_DONE)
        return result;
    if (!filtered)
        o.filter = NULL;
    d->image = crv_image_packed(*picture, v->width, v->height, 1);
    if (!report_ok(s->r, crv_plan_create(context, &o, &g->desc, &d->plan), "plan"))
        return EXIT_FAILED;
    if (bench_time_runs(&clock, run_once, d, &time))
        result = study_compare(s, v, *picture, truth, &m);
    else
        result = EXIT_FAILED; /* the library has told why */
    crv_plan_destroy(d->plan);
    d->plan = NULL;
    if (result == EXIT_DONE)
        *out = (estimate){m.rmse, time.ms};
    return result;
}

/* A G-buffer belongs to its context, so each structure has its own of both. */
static int run_structure(study *s, study_view *v, const crv_options *options,
                         int structure, const float *truth, comparison *out)
{
    common_settings common = *s->common;
    crv_context *context = NULL;
    run_data d = {0};
    const scene_gbuffer *g;
    int result = study_gbuffer(s, v, STUDY_ONE_LAYER, &g);

    common.exact = structure == EXACT;
    if (result == EXIT_DONE)
        result = device_context(&common, &s->quiet_logger, s->r, &context);
    if (result == EXIT_DONE
        && !report_ok(s->r, scene_gbuffer_upload(g, context, &d.gbuffer), "G-buffer"))
        result = EXIT_FAILED;
    for (int filtered = 0; filtered < 2 && result == EXIT_DONE; filtered++)
        result = run_filtered(s, v, options, filtered != 0, context, &d, truth,
                              &out->e[filtered][structure],
                              &out->picture[filtered][structure]);
    crv_gbuffer_destroy(d.gbuffer);
    crv_context_destroy(context);
    return result;
}

static void show(study *s, const study_view *v, const char *method, const comparison *c)
{
    for (int k = 0; k < STRUCTURE_COUNT; k++) {
        char name[96], caption[128];

        snprintf(name, sizeof name, "structure-%s-%s", method, STRUCTURES[k]);
        snprintf(caption, sizeof caption, "%s, %s, no filter, %s: RMSE %.4f, %.2f ms",
                 v->name, method, STRUCTURES[k], c->e[0][k].rmse, c->e[0][k].ms);
        page_picture(s->page, name, c->picture[0][k], v->width, v->height, caption);
    }
}

static int measure(study *s, study_view *v, const char *method, comparison *out)
{
    crv_options options = study_options(v, method, CRV_PRESET_MEDIUM);
    study_target target = study_target_of(&options);
    const float *truth;
    int result;

    study_progress(s, "structures: %s, %s", v->name, method);
    result = study_reference(s, v, &target, REFERENCE_FULL, STUDY_ONE_LAYER, &truth);
    for (int k = 0; k < STRUCTURE_COUNT && result == EXIT_DONE; k++)
        result = run_structure(s, v, &options, k, truth, out);
    for (int filtered = 0; filtered < 2 && result == EXIT_DONE; filtered++) {
        metrics m;
        result = study_compare(s, v, out->picture[filtered][FAST],
                               out->picture[filtered][EXACT], &m);
        if (result == EXIT_DONE)
            out->apart[filtered] = m.rmse;
    }
    if (result == EXIT_DONE && v == s->main)
        show(s, v, method, out);
    for (int i = 0; i < 2 * STRUCTURE_COUNT; i++) {
        free(out->picture[i / 2][i % 2]);
        out->picture[i / 2][i % 2] = NULL;
    }
    return result;
}

/* A picture without any error has nothing to exceed. */
static double ratio(const estimate e[STRUCTURE_COUNT])
{
    return e[EXACT].rmse > 0.0  ? e[FAST].rmse / e[EXACT].rmse
           : e[FAST].rmse > 0.0 ? INFINITY
                                : 1.0;
}

static bool holds(const estimate e[STRUCTURE_COUNT])
{
    return ratio(e) <= MAY_EXCEED;
}

static void add_result(cJSON *list, const study_view *v, const char *method,
                       bool filtered, const comparison *c)
{
    const estimate *e = c->e[filtered];
    cJSON *row = cJSON_CreateObject();

    cJSON_AddStringToObject(row, "view", v->name);
    cJSON_AddStringToObject(row, "method", method);
    cJSON_AddBoolToObject(row, "filtered", filtered);
    study_add_number(row, "rmse_fast", e[FAST].rmse);
    study_add_number(row, "rmse_exact", e[EXACT].rmse);
    study_add_number(row, "ratio", ratio(e));
    study_add_number(row, "rmse_fast_to_exact", c->apart[filtered]);
    study_add_number(row, "ms_fast", e[FAST].ms);
    study_add_number(row, "ms_exact", e[EXACT].ms);
    cJSON_AddBoolToObject(row, "holds", holds(e));
    cJSON_AddItemToArray(list, row);
}

static void write_row(page *p, const study_view *v, const char *method, bool filtered,
                      const comparison *c)
{
    const estimate *e = c->e[filtered];

    page_cell(p, "%s", v->name);
    page_cell(p, "%s", method);
    page_cell(p, "%s", filtered ? "yes" : "no");
    page_cell(p, "%.4f", e[FAST].rmse);
    page_cell(p, "%.4f", e[EXACT].rmse);
    page_cell(p, "%+.2f %%", 100.0 * (ratio(e) - 1.0));
    page_cell(p, "%.4f", c->apart[filtered]);
    page_cell(p, "%.2f", e[FAST].ms);
    page_cell(p, "%.2f", e[EXACT].ms);
    if (holds(e))
        page_cell(p, "yes");
    else
        page_cell_strong(p, "no");
}

static void write_verdict(study *s, int32_t good, int32_t all, double worst)
{
    page_text(s->page,
              "Verdict: the error of the fast structure is above that of the exact one "
              "by no more than %.0f %% in %d of %d cases; at worst it is %+.2f %%.",
              100.0 * (MAY_EXCEED - 1.0), good, all, 100.0 * (worst - 1.0));
    cJSON_AddBoolToObject(s->results, "structures_hold", good == all);
}

static void write_all(study *s, const comparison *all)
{
    static const char *const headers[] = {"View",       "Method",     "Filter",
                                          "RMSE fast",  "RMSE exact", "Fast over exact",
                                          "Both apart", "Fast, ms",   "Exact, ms",
                                          "Within 1 %"};
    cJSON *list = cJSON_AddArrayToObject(s->results, "structures");
    int32_t good = 0, count = 0;
    double worst = 0.0;

    page_table_begin(s->page, "Preset `medium`, with its filter and without.", headers,
                     sizeof headers / sizeof headers[0]);
    for (int32_t i = 0; i < s->view_count; i++) {
        for (int m = 0; m < METHOD_COUNT; m++) {
            for (int filtered = 0; filtered < 2; filtered++) {
                const comparison *c = &all[i * METHOD_COUNT + m];
                write_row(s->page, &s->views[i], METHODS[m], filtered != 0, c);
                add_result(list, &s->views[i], METHODS[m], filtered != 0, c);
                good += holds(c->e[filtered]);
                worst = fmax(worst, ratio(c->e[filtered]));
                count++;
            }
        }
    }
    page_table_end(s->page);
    write_verdict(s, good, count, worst);
}

int study_structure(study *s)
{
    comparison *all;
    int result = EXIT_DONE;

    page_heading(s->page, 2, "structure", "Fast and exact sampling");
    if (!device_is_cpu(s->common)) {
        page_text(s->page, "The device `%s` has one structure only.", s->common->device);
        return EXIT_DONE;
    }
    all = calloc((size_t)s->view_count * METHOD_COUNT, sizeof *all);
    if (all == NULL)
        return report_no_memory(s->r);
    page_text(s->page,
              "By default kernels may move samples by a part of a pixel's footprint, so "
              "that neighbours read side by side; `--exact` samples where the plain code "
              "does. Whether a sample counts is decided by its true distance in both, so "
              "they estimate the same integral. RMSE is against ray tracing of the whole "
              "scene. Instruction set: `%s`; the plain code has one structure only.",
              crv_isa_name(crv_context_isa(s->context)));
    page_pairs_begin(s->page);
    for (int32_t i = 0; i < s->view_count; i++)
        for (int m = 0; m < METHOD_COUNT && result == EXIT_DONE; m++)
            result = measure(s, &s->views[i], METHODS[m], &all[i * METHOD_COUNT + m]);
    page_grid_end(s->page);
    if (result == EXIT_DONE)
        write_all(s, all);
    free(all);
    return result;
}
