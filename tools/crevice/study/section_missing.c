/* SPDX-License-Identifier: MIT */
/*
 * section_missing.c: what keeps each estimate from the truth. Between the ray-traced
 * truth and the picture stand, in this order, the data that the buffers do not hold, the
 * estimator with all the samples that it could want, the samples that it has, and the
 * filter; each step is measured by itself.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plot.h"
#include "sections.h"

/* The error that gets the darkest colours. */
#define ERROR_SCALE 0.25

/* The best raw RMSE of widely used GPU implementations (32 to 54 samples, denoised) on
 * these views at 1280x720, measured before this project began; not measured here. */
typedef struct peer {
    const char *view;
    double cosine_none, uniform_linear;
} peer;

static const peer PEERS[] = {{"sponza", 0.137, 0.130},
                             {"dragon", 0.077, 0.054},
                             {"engine", 0.099, 0.094},
                             {"machine", 0.071, 0.072}};

enum { PEER_WIDTH = 1280, PEER_HEIGHT = 720 };

/* What is measured, and with what its method is taken to have converged: more of what
 * its error hangs on, without a filter. */
typedef struct subject {
    const char *method;
    crv_falloff falloff;
    const char *converged; /* "key=value key=value" */
} subject;

static const subject SUBJECTS[] = {
    {"hsao", CRV_FALLOFF_NONE, "directions=16 steps=32 normal_rays=2"},
    {"raymarch", CRV_FALLOFF_NONE, "directions=16 steps=32 normal_rays=3"},
    {"containment", CRV_FALLOFF_NONE, "samples=96 steps=24"},
    {"hbao", CRV_FALLOFF_LINEAR, "directions=24 steps=48"}};

enum { SUBJECT_COUNT = sizeof SUBJECTS / sizeof SUBJECTS[0] };

static const study_buffers TWO_LAYERS = {2, CRV_LAYERS_SURFACES};

typedef struct parts {
    double one, two;      /* RMSE of the filtered picture against the whole scene */
    double peer;          /* NAN: none */
    double missing;       /* truth of the buffers against truth of the whole scene */
    double estimator;     /* converged against truth of the buffers */
    double converged;     /* converged against truth of the whole scene */
    double sampling;      /* picture against converged, unfiltered */
    double sampling_left; /* the same when both are filtered */
    double blur;          /* converged, filtered against unfiltered */
} parts;

static double peer_of(const study_view *v, const subject *what)
{
    if (v->width == PEER_WIDTH && v->height == PEER_HEIGHT)
        for (size_t i = 0; i < sizeof PEERS / sizeof PEERS[0]; i++)
            if (strcmp(PEERS[i].view, v->name) == 0)
                return what->falloff == CRV_FALLOFF_NONE ? PEERS[i].cosine_none
                                                         : PEERS[i].uniform_linear;
    return NAN;
}

/* Taking an estimate apart costs several references: the main view and those that others
 * were measured on. */
static bool is_taken_apart(const study *s, const study_view *v, const subject *what)
{
    return v == s->main || isfinite(peer_of(v, what));
}

static crv_options high_of(const study_view *v, const subject *what)
{
    crv_options o = study_options(v, what->method, CRV_PRESET_HIGH);

    o.falloff = what->falloff;
    return o;
}

static int set_all(study *s, crv_options *o, const char *text)
{
    char key[32], value[32];
    int length = 0;

    for (; sscanf(text, " %31[^=]=%31s%n", key, value, &length) == 2; text += length)
        if (!report_ok(s->r, crv_options_set(o, key, value, &s->r->logger), key))
            return EXIT_FAILED;
    return EXIT_DONE;
}

static int rmse(study *s, const study_view *v, const float *a, const float *b,
                double *out)
{
    metrics m;
    int result = study_compare(s, v, a, b, &m);

    *out = m.rmse;
    return result;
}

/* The picture of these options; free() it. */
static int picture_of(study *s, study_view *v, const crv_options *options,
                      study_buffers buffers, float **out)
{
    study_estimate e = {0};
    int result = study_run(s, v, options, buffers, 0, &e);

    *out = e.accessibility;
    return result;
}

/* The steps between `truth` and `picture`, which is filtered and of one layer. */
static int take_apart(study *s, study_view *v, const subject *what, const float *truth,
                      const float *picture, parts *out)
{
    crv_options options = high_of(v, what), plain = options, much = options;
    study_target target = study_target_of(&options);
    size_t count = (size_t)v->width * (size_t)v->height;
    float *unfiltered = NULL, *converged = NULL,
          *filtered = malloc(count * sizeof(float));
    const float *visible;
    int result;

    if (filtered == NULL)
        return report_no_memory(s->r);
    plain.filter = much.filter = NULL;
    result = set_all(s, &much, what->converged);
    if (result == EXIT_DONE)
        result =
            study_reference(s, v, &target, REFERENCE_VISIBLE, STUDY_ONE_LAYER, &visible);
    if (result == EXIT_DONE)
        result = picture_of(s, v, &plain, STUDY_ONE_LAYER, &unfiltered);
    if (result == EXIT_DONE)
        result = picture_of(s, v, &much, STUDY_ONE_LAYER, &converged);
    if (result == EXIT_DONE)
        result = study_filter(s, v, &options, converged, filtered);
    if (result == EXIT_DONE)
        result = rmse(s, v, visible, truth, &out->missing);
    if (result == EXIT_DONE)
        result = rmse(s, v, converged, visible, &out->estimator);
    if (result == EXIT_DONE)
        result = rmse(s, v, converged, truth, &out->converged);
    if (result == EXIT_DONE)
        result = rmse(s, v, unfiltered, converged, &out->sampling);
    if (result == EXIT_DONE)
        result = rmse(s, v, picture, filtered, &out->sampling_left);
    if (result == EXIT_DONE)
        result = rmse(s, v, filtered, converged, &out->blur);
    free(unfiltered);
    free(converged);
    free(filtered);
    return result;
}

static void show(study *s, const study_view *v, const subject *what, const char *layers,
                 const float *picture, const float *truth, double error)
{
    char name[128], caption[128];

    snprintf(name, sizeof name, "missing-%s-%s-%s", v->name, what->method, layers);
    snprintf(caption, sizeof caption, "%s, %s, %s %s: error, RMSE %.4f", v->name,
             what->method, layers, strcmp(layers, "1") == 0 ? "layer" : "layers", error);
    page_error_map(s->page, name, picture, truth, v->mask, v->width, v->height,
                   ERROR_SCALE, caption);
}

static int measure(study *s, study_view *v, const subject *what, parts *out)
{
    crv_options options = high_of(v, what);
    study_target target = study_target_of(&options);
    float *one = NULL, *two = NULL;
    const float *truth;
    int result;

    *out = (parts){.peer = peer_of(v, what),
                   .missing = NAN,
                   .estimator = NAN,
                   .converged = NAN,
                   .sampling = NAN,
                   .sampling_left = NAN,
                   .blur = NAN};
    study_progress(s, "errors: %s, %s", v->name, what->method);
    result = study_reference(s, v, &target, REFERENCE_FULL, STUDY_ONE_LAYER, &truth);
    if (result == EXIT_DONE)
        result = picture_of(s, v, &options, STUDY_ONE_LAYER, &one);
    if (result == EXIT_DONE)
        result = picture_of(s, v, &options, TWO_LAYERS, &two);
    if (result == EXIT_DONE)
        result = rmse(s, v, one, truth, &out->one);
    if (result == EXIT_DONE)
        result = rmse(s, v, two, truth, &out->two);
    if (result == EXIT_DONE && is_taken_apart(s, v, what)) {
        result = take_apart(s, v, what, truth, one, out);
        show(s, v, what, "1", one, truth, out->one);
        show(s, v, what, "2", two, truth, out->two);
    }
    free(one);
    free(two);
    return result;
}

static void write_number(page *p, double value)
{
    if (isfinite(value))
        page_cell(p, "%.4f", value);
    else
        page_cell(p, "-");
}

static void write_totals(study *s, const parts *all)
{
    static const char *const headers[] = {
        "View",       "Method",  "Integral",           "One layer",
        "Two layers", "To beat", "One layer below it", "Half of it"};
    page *p = s->page;

    page_table_begin(p,
                     "RMSE at `high` with the default filter, against ray tracing of the "
                     "whole scene, over all pixels with a surface.",
                     headers, sizeof headers / sizeof headers[0]);
    for (int32_t i = 0; i < s->view_count; i++) {
        for (int k = 0; k < SUBJECT_COUNT; k++) {
            const parts *q = &all[i * SUBJECT_COUNT + k];
            crv_options options = high_of(&s->views[i], &SUBJECTS[k]);
            study_target target = study_target_of(&options);
            bool known = isfinite(q->peer);

            page_cell(p, "%s", s->views[i].name);
            page_cell(p, "%s", SUBJECTS[k].method);
            page_cell(p, "%s", study_target_name(&target));
            write_number(p, q->one);
            write_number(p, q->two);
            write_number(p, q->peer);
            page_cell(p, "%s", !known ? "-" : q->one < q->peer ? "yes" : "no");
            page_cell(p, "%s",
                      !known                   ? "-"
                      : q->one < 0.5 * q->peer ? "reached"
                      : q->two < 0.5 * q->peer ? "with two layers"
                                               : "not reached");
        }
    }
    page_table_end(p);
}

static void write_parts(study *s, const parts *all)
{
    static const char *const headers[] = {"View",
                                          "Method",
                                          "Total",
                                          "Converged, no filter",
                                          "Missing data",
                                          "Estimator",
                                          "Sampling",
                                          "Sampling left by the filter",
                                          "Blur of the filter"};
    page *p = s->page;

    page_table_begin(p, "What the error is made of, one layer, RMS of each step.",
                     headers, sizeof headers / sizeof headers[0]);
    for (int32_t i = 0; i < s->view_count; i++) {
        for (int k = 0; k < SUBJECT_COUNT; k++) {
            const parts *q = &all[i * SUBJECT_COUNT + k];

            if (!isfinite(q->missing))
                continue;
            page_cell(p, "%s", s->views[i].name);
            page_cell(p, "%s", SUBJECTS[k].method);
            write_number(p, q->one);
            write_number(p, q->converged);
            write_number(p, q->missing);
            write_number(p, q->estimator);
            write_number(p, q->sampling);
            write_number(p, q->sampling_left);
            write_number(p, q->blur);
        }
    }
    page_table_end(p);
}

static void add_results(study *s, const parts *all)
{
    cJSON *list = cJSON_AddArrayToObject(s->results, "missing");

    for (int32_t i = 0; i < s->view_count; i++) {
        for (int k = 0; k < SUBJECT_COUNT; k++) {
            const parts *q = &all[i * SUBJECT_COUNT + k];
            cJSON *row = cJSON_CreateObject();

            cJSON_AddStringToObject(row, "view", s->views[i].name);
            cJSON_AddStringToObject(row, "method", SUBJECTS[k].method);
            study_add_number(row, "rmse_one_layer", q->one);
            study_add_number(row, "rmse_two_layers", q->two);
            study_add_number(row, "to_beat", q->peer);
            study_add_number(row, "converged", q->converged);
            study_add_number(row, "missing_data", q->missing);
            study_add_number(row, "estimator", q->estimator);
            study_add_number(row, "sampling", q->sampling);
            study_add_number(row, "sampling_filtered", q->sampling_left);
            study_add_number(row, "blur", q->blur);
            cJSON_AddItemToArray(list, row);
        }
    }
}

static void write_introduction(study *s)
{
    page_heading(s->page, 2, "missing", "What the errors are made of");
    page_text(
        s->page,
        "`hsao`, `raymarch` and `containment` without falloff (cosine weighting) and "
        "`hbao` with linear falloff (uniform weighting), each at `high` with the "
        "default filter, against ray tracing of the whole scene. Two layers: the "
        "next surface behind the first as well (`--layers 2`).");
    page_text(
        s->page,
        "To beat: the best raw RMSE of widely used GPU implementations, of 32 to 54 "
        "samples and denoised, on these views at %dx%d. These numbers were given "
        "to this project and are not measured here; views and sizes that they do "
        "not speak of have none.",
        PEER_WIDTH, PEER_HEIGHT);
}

static void write_explanation(study *s)
{
    page_text(
        s->page,
        "Missing data: ray tracing of what the buffer holds, silhouettes closed "
        "%.2g radii behind (`crevice reference --kind visible`), against ray "
        "tracing of the whole scene. It is an assumption about what is hidden, like "
        "any, and not a bound: where thin things stand before open space it is too "
        "dark, and an estimator that assumes less may be nearer to the truth. "
        "Estimator: the method with many more samples and no filter, against that. "
        "Sampling: the picture before the filter against the converged one; then "
        "what the filter leaves of it; then what the filter does to a picture that "
        "needs none. Errors of the steps may cancel, so that they do not add up to "
        "the total.",
        (double)STUDY_THICKNESS);
}

int study_missing(study *s)
{
    parts *all = calloc((size_t)s->view_count * SUBJECT_COUNT, sizeof *all);
    int result = EXIT_DONE;

    if (all == NULL)
        return report_no_memory(s->r);
    write_introduction(s);
    page_pairs_begin(s->page);
    for (int32_t i = 0; i < s->view_count; i++)
        for (int k = 0; k < SUBJECT_COUNT && result == EXIT_DONE; k++)
            result = measure(s, &s->views[i], &SUBJECTS[k], &all[i * SUBJECT_COUNT + k]);
    page_grid_end(s->page);
    if (result == EXIT_DONE) {
        write_totals(s, all);
        write_explanation(s);
        write_parts(s, all);
        add_results(s, all);
    }
    free(all);
    return result;
}
