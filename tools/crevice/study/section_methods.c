/* SPDX-License-Identifier: MIT */
/* section_methods.c: every method at every preset, each against the integral that it
 * estimates. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "common/flip.h"
#include "plot.h"
#include "sections.h"

enum { METHODS_MAX = PLOT_MAX_SERIES, REPEATS = 3 };

/* The error that gets the darkest colours. */
#define ERROR_SCALE 0.25

typedef struct record {
    bool measured;
    study_target target;
    metrics m;
    metrics_fit fit;
    double flip, ms, samples;
    float *accessibility; /* owned */
    const float *truth;   /* the view's */
} record;

typedef struct table {
    study_view *view;
    int32_t methods;
    record records[METHODS_MAX][CRV_PRESET_COUNT];
} table;

static void free_records(table *t)
{
    for (int32_t m = 0; m < t->methods; m++)
        for (int p = 0; p < CRV_PRESET_COUNT; p++)
            free(t->records[m][p].accessibility);
    free(t);
}

/* The other views are there to see whether the main one is a special case: two presets
 * do. */
static bool is_wanted(const study *s, const study_view *v, int preset)
{
    return v == s->main || preset == CRV_PRESET_MEDIUM || preset == CRV_PRESET_HIGH;
}

static int estimate(study *s, study_view *v, const crv_options *options, record *out)
{
    study_estimate e;
    int result;

    out->target = study_target_of(options);
    result =
        study_reference(s, v, &out->target, REFERENCE_FULL, STUDY_ONE_LAYER, &out->truth);
    if (result == EXIT_DONE)
        result =
            study_run(s, v, options, STUDY_ONE_LAYER, v == s->main ? REPEATS : 1, &e);
    if (result != EXIT_DONE)
        return result;
    out->accessibility = e.accessibility;
    out->ms = e.ms;
    out->samples = e.samples;
    return EXIT_DONE;
}

/* False where memory ran out. */
static bool judge(const study_view *v, record *out)
{
    const float *a = out->accessibility, *b = out->truth;

    return metrics_compare(a, b, v->mask, v->width, v->height, &out->m)
           && metrics_fit_curves(a, b, v->mask, v->width, v->height, &out->fit)
           && flip_compare(a, b, v->mask, v->width, v->height,
                           strtod(FLIP_PPD_TEXT, NULL), &out->flip);
}

/* The metrics take as long as the estimates do, and one thread each. */
static int judge_all(study *s, record *records, const study_view *v)
{
    int failures = 0;

#ifdef _OPENMP
    int threads = s->threads > 0 ? s->threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic) num_threads(threads) reduction(+ : failures)
#endif
    for (int p = 0; p < CRV_PRESET_COUNT; p++) {
        if (records[p].accessibility == NULL)
            continue;
        records[p].measured = judge(v, &records[p]);
        failures += !records[p].measured;
    }
    return failures == 0 ? EXIT_DONE : report_no_memory(s->r);
}

static int measure_all(study *s, table *t)
{
    for (int32_t m = 0; m < t->methods; m++) {
        const char *name = crv_method_at(m)->name;
        int result = EXIT_DONE;

        study_progress(s, "methods: %s, %s", t->view->name, name);
        for (int p = 0; p < CRV_PRESET_COUNT && result == EXIT_DONE; p++) {
            crv_options options = study_options(t->view, name, (crv_preset)p);

            if (is_wanted(s, t->view, p))
                result = estimate(s, t->view, &options, &t->records[m][p]);
        }
        if (result == EXIT_DONE)
            result = judge_all(s, t->records[m], t->view);
        if (result != EXIT_DONE)
            return result;
    }
    return EXIT_DONE;
}

static void add_results(const table *t, cJSON *list)
{
    for (int32_t m = 0; m < t->methods; m++) {
        for (int p = 0; p < CRV_PRESET_COUNT; p++) {
            const record *r = &t->records[m][p];
            cJSON *item;

            if (!r->measured)
                continue;
            item = cJSON_CreateObject();
            cJSON_AddStringToObject(item, "view", t->view->name);
            cJSON_AddStringToObject(item, "method", crv_method_at(m)->name);
            cJSON_AddStringToObject(item, "preset", crv_preset_name((crv_preset)p));
            cJSON_AddStringToObject(item, "target", study_target_name(&r->target));
            study_add_number(item, "samples", r->samples);
            study_add_number(item, "ms", r->ms);
            study_add_number(item, "rmse", r->m.rmse);
            study_add_number(item, "mae", r->m.mae);
            study_add_number(item, "bias", r->m.bias);
            study_add_number(item, "error_q01", r->m.error_q01);
            study_add_number(item, "error_q99", r->m.error_q99);
            study_add_number(item, "ssim", r->m.ssim);
            study_add_number(item, "flip", r->flip);
            study_add_number(item, "fit_power", r->fit.power.power);
            study_add_number(item, "fit_power_rmse", r->fit.power.rmse);
            study_add_number(item, "fit_intensity", r->fit.intensity.intensity);
            study_add_number(item, "fit_intensity_rmse", r->fit.intensity.rmse);
            cJSON_AddItemToArray(list, item);
        }
    }
}

static double best_rmse(const table *t, int preset)
{
    double best = INFINITY;

    for (int32_t m = 0; m < t->methods; m++)
        if (t->records[m][preset].measured)
            best = fmin(best, t->records[m][preset].m.rmse);
    return best;
}

static void write_table(study *s, const table *t)
{
    static const char *const headers[] = {
        "Method", "Preset", "Integral", "Samples", "Time, ms",   "RMSE",
        "MAE",    "Bias",   "SSIM",     "FLIP",    "Best power", "Best intensity"};
    page *p = s->page;

    page_table_begin(
        p,
        "Errors against each method's own integral; in bold the lowest RMSE "
        "of each preset. Bias: mean of estimate minus truth. Best power and "
        "best intensity: the RMSE that is left when the result's strength is "
        "adjusted by that alone, and in brackets its value.",
        headers, sizeof headers / sizeof headers[0]);
    for (int32_t m = 0; m < t->methods; m++) {
        for (int k = 0; k < CRV_PRESET_COUNT; k++) {
            const record *r = &t->records[m][k];

            if (!r->measured)
                continue;
            page_cell(p, "%s", crv_method_at(m)->name);
            page_cell(p, "%s", crv_preset_name((crv_preset)k));
            page_cell(p, "%s", study_target_name(&r->target));
            page_cell(p, "%.0f", r->samples);
            page_cell(p, "%.1f", r->ms);
            if (r->m.rmse <= best_rmse(t, k))
                page_cell_strong(p, "%.4f", r->m.rmse);
            else
                page_cell(p, "%.4f", r->m.rmse);
            page_cell(p, "%.4f", r->m.mae);
            page_cell(p, "%+.4f", r->m.bias);
            page_cell(p, isfinite(r->m.ssim) ? "%.4f" : "-", r->m.ssim);
            page_cell(p, "%.4f", r->flip);
            page_cell(p, "%.4f (%.2f)", r->fit.power.rmse, r->fit.power.power);
            page_cell(p, "%.4f (%.2f)", r->fit.intensity.rmse,
                      r->fit.intensity.intensity);
        }
    }
    page_table_end(p);
}

static void write_plot(study *s, const table *t)
{
    double x[METHODS_MAX][CRV_PRESET_COUNT], y[METHODS_MAX][CRV_PRESET_COUNT];
    const char *labels[METHODS_MAX][CRV_PRESET_COUNT];
    plot_series series[METHODS_MAX];
    char caption[512];

    for (int32_t m = 0; m < t->methods; m++) {
        int32_t count = 0;

        /* The paper's numbers are no step of the ladder from low to ultra; beside it they
         * would only tangle the line. */
        for (int p = 0; p < CRV_PRESET_PAPER; p++) {
            if (!t->records[m][p].measured)
                continue;
            x[m][count] = t->records[m][p].ms;
            y[m][count] = t->records[m][p].m.rmse;
            labels[m][count++] = crv_preset_name((crv_preset)p);
        }
        series[m] = (plot_series){.name = crv_method_at(m)->name,
                                  .x = x[m],
                                  .y = y[m],
                                  .labels = labels[m],
                                  .count = count,
                                  .is_line = true};
    }
    snprintf(caption, sizeof caption,
             "%s: error over time, from `%s` to `%s`, each method against its own "
             "integral: lower left is better, but equal heights are equal errors of "
             "different integrals. Default filter of each preset, one layer.",
             t->view->name, t->view == s->main ? "low" : "medium",
             t->view == s->main ? "ultra" : "high");
    page_plot(s->page, &(plot){.caption = caption,
                               .x_title = "time of a picture, ms",
                               .y_title = "RMSE",
                               .log_x = true,
                               .log_y = true,
                               .series = series,
                               .series_count = t->methods,
                               .pareto = true});
}

static void write_truths(study *s, const table *t)
{
    const float *written[METHODS_MAX * CRV_PRESET_COUNT];
    int32_t count = 0;

    page_grid_begin(s->page);
    for (int32_t m = 0; m < t->methods; m++) {
        for (int p = 0; p < CRV_PRESET_COUNT; p++) {
            const record *r = &t->records[m][p];
            char name[128], caption[128];
            bool is_new = r->measured;

            for (int32_t i = 0; i < count && is_new; i++)
                is_new = written[i] != r->truth;
            if (!is_new)
                continue;
            written[count++] = r->truth;
            snprintf(name, sizeof name, "%s-truth-%s", t->view->name,
                     study_target_name(&r->target));
            snprintf(caption, sizeof caption, "Ray-traced: %s",
                     study_target_name(&r->target));
            page_picture(s->page, name, r->truth, t->view->width, t->view->height,
                         caption);
        }
    }
    page_grid_end(s->page);
}

static void write_pair(study *s, const table *t, int32_t m, int preset)
{
    const record *r = &t->records[m][preset];
    const study_view *v = t->view;
    const char *method = crv_method_at(m)->name;
    const char *preset_name = crv_preset_name((crv_preset)preset);
    char name[160], caption[256];

    snprintf(name, sizeof name, "%s-%s-%s", v->name, method, preset_name);
    snprintf(caption, sizeof caption, "%s %s: %.0f samples, %.0f ms", method, preset_name,
             r->samples, r->ms);
    page_picture(s->page, name, r->accessibility, v->width, v->height, caption);
    snprintf(name, sizeof name, "%s-%s-%s-error", v->name, method, preset_name);
    snprintf(caption, sizeof caption, "%s %s: error against %s, RMSE %.4f", method,
             preset_name, study_target_name(&r->target), r->m.rmse);
    page_error_map(s->page, name, r->accessibility, r->truth, v->mask, v->width,
                   v->height, ERROR_SCALE, caption);
}

static void write_wall(study *s, const table *t, int preset)
{
    page_pairs_begin(s->page);
    for (int32_t m = 0; m < t->methods; m++)
        if (t->records[m][preset].measured)
            write_pair(s, t, m, preset);
    page_grid_end(s->page);
}

static void write_pictures(study *s, const table *t)
{
    char summary[128];

    page_details_begin(s->page, "Pictures: what is aimed at");
    write_truths(s, t);
    page_details_end(s->page);
    for (int p = 0; p < CRV_PRESET_COUNT; p++) {
        /* One wall of the main view is in plain sight. */
        bool is_open = t->view == s->main && p == CRV_PRESET_HIGH;

        if (!is_wanted(s, t->view, p))
            continue;
        snprintf(summary, sizeof summary, "Pictures: %s", crv_preset_name((crv_preset)p));
        if (is_open)
            page_text(s->page, "All methods at `high`:");
        else
            page_details_begin(s->page, summary);
        write_wall(s, t, p);
        if (!is_open)
            page_details_end(s->page);
    }
}

static int study_view_methods(study *s, study_view *v, cJSON *list)
{
    char id[96];
    table *t = calloc(1, sizeof *t);
    int result;

    if (t == NULL)
        return report_no_memory(s->r);
    t->view = v;
    t->methods = crv_method_count() < METHODS_MAX ? crv_method_count() : METHODS_MAX;
    result = measure_all(s, t);
    if (result == EXIT_DONE) {
        snprintf(id, sizeof id, "methods-%s", v->name);
        page_heading(s->page, 3, id, v->name);
        write_plot(s, t);
        write_table(s, t);
        write_pictures(s, t);
        add_results(t, list);
    }
    free_records(t);
    return result;
}

int study_methods(study *s)
{
    cJSON *list = cJSON_AddArrayToObject(s->results, "methods");
    int result = EXIT_DONE;

    page_heading(s->page, 2, "methods", "Methods and presets");
    page_text(s->page,
              "Every method estimates an integral of its own, by its weighting of the "
              "hemisphere and its falloff, and is held to that: a low error means that "
              "the method computes what it says, not that it looks like the others. `vo` "
              "and `ssao` have no integral of this kind; they are held to the nearest, "
              "uniform weighting with cubic and with no falloff.");
    page_text(s->page,
              "Time is that of a whole picture, filter included, on the CPU; on the main "
              "view the median of %d runs, or of fewer where they are long. Samples are "
              "look-ups in the buffers for each pixel, at most. "
              "In the error maps white is right, blue too dark, orange too bright; the "
              "darkest colours stand for %.2f and more. On views other than %s the "
              "presets `low`, `ultra` and `paper` are left out to save time.",
              REPEATS, ERROR_SCALE, s->main->name);
    for (int32_t i = 0; i < s->view_count && result == EXIT_DONE; i++)
        if (&s->views[i] == s->main)
            result = study_view_methods(s, &s->views[i], list);
    for (int32_t i = 0; i < s->view_count && result == EXIT_DONE; i++)
        if (&s->views[i] != s->main)
            result = study_view_methods(s, &s->views[i], list);
    return result;
}
