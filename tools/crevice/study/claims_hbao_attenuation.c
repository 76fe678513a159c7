/* SPDX-License-Identifier: MIT */
/* claims_hbao_attenuation.c: equation 3 of Bavoil, Sainz, Dimitrov 2008 takes one weight
 * for a whole slice, that of its horizon point. */
#include <stdio.h>
#include <stdlib.h>

#include "claims_hbao.h"

enum { PAPER_SET, MANY, SETS };
enum { SLAB, LITERAL, KINDS };

typedef struct attenuation {
    metrics m[SETS][KINDS];
    double mean_truth;
} attenuation;

static const char *const WORDS[KINDS] = {"slab", "horizon"};

static crv_options options_of(const horizon_study *h, int set, int kind)
{
    crv_options o = h->paper;

    o.attenuation = kind == SLAB ? CRV_ATTENUATION_SLAB : CRV_ATTENUATION_HORIZON;
    if (set == MANY) {
        o.directions = 24;
        o.steps = 24;
    }
    return o;
}

static int measure_one(const horizon_study *h, int set, int kind, attenuation *out)
{
    crv_options o = options_of(h, set, kind);
    float *picture = NULL;
    char name[48], caption[128];
    int result = horizon_run(h, &o, STUDY_ONE_LAYER, &out->m[set][kind], &picture);

    if (result == EXIT_DONE && set == MANY) {
        snprintf(name, sizeof name, "hbao-attenuation-%s", WORDS[kind]);
        snprintf(caption, sizeof caption, "attenuation=%s: RMSE %.4f", WORDS[kind],
                 out->m[set][kind].rmse);
        result = horizon_show(h, name, picture, caption);
        snprintf(name, sizeof name, "hbao-attenuation-%s-error", WORDS[kind]);
        snprintf(caption, sizeof caption, "attenuation=%s: error", WORDS[kind]);
        if (result == EXIT_DONE)
            result = horizon_show_error(h, name, picture, h->truth, caption);
    }
    free(picture);
    return result;
}

static int measure_all(const horizon_study *h, attenuation *out)
{
    int result = EXIT_DONE;

    study_progress(h->s, "claims, 2008b: attenuation");
    page_grid_begin(h->s->page);
    for (int set = 0; set < SETS; set++) {
        for (int kind = 0; result == EXIT_DONE && kind < KINDS; kind++)
            result = measure_one(h, set, kind, out);
    }
    if (result == EXIT_DONE)
        result = horizon_show(h, "hbao-attenuation-truth", h->truth, "ray traced");
    page_grid_end(h->s->page);
    out->mean_truth = out->m[0][0].mean_b;
    return result;
}

static void write_table(const horizon_study *h, const attenuation *a)
{
    static const char *const HEADERS[] = {"attenuation", "Nd",         "Ns",  "RMSE",
                                          "mean",        "mean error", "SSIM"};
    page *p = h->s->page;
    char caption[160];

    snprintf(caption, sizeof caption,
             "Both readings of eq. 3, unfiltered, against ray tracing with uniform "
             "weighting and linear falloff, whose mean is %.4f.",
             a->mean_truth);
    page_table_begin(p, caption, HEADERS, 7);
    for (int set = 0; set < SETS; set++) {
        for (int kind = 0; kind < KINDS; kind++) {
            const metrics *m = &a->m[set][kind];
            crv_options o = options_of(h, set, kind);

            page_cell(p, "%s", WORDS[kind]);
            page_cell(p, "%d", o.directions);
            page_cell(p, "%d", o.steps);
            page_cell(p, "%.4f", m->rmse);
            page_cell(p, "%.4f", m->mean_a);
            page_cell(p, "%+.4f", m->bias);
            page_cell(p, "%.3f", m->ssim);
        }
    }
    page_table_end(p);
}

static int keep(const horizon_study *h, const attenuation *a)
{
    cJSON *all = measure_object(h->s, h->json, "attenuation");

    for (int kind = 0; all != NULL && kind < KINDS; kind++) {
        cJSON *one = measure_object(h->s, all, WORDS[kind]);

        if (one == NULL || !horizon_number(h, one, "rmse_8x8", a->m[PAPER_SET][kind].rmse)
            || !horizon_number(h, one, "bias_8x8", a->m[PAPER_SET][kind].bias)
            || !horizon_number(h, one, "rmse_24x24", a->m[MANY][kind].rmse)
            || !horizon_number(h, one, "bias_24x24", a->m[MANY][kind].bias))
            return EXIT_FAILED;
    }
    return all != NULL ? EXIT_DONE : EXIT_FAILED;
}

static void claim(const horizon_study *h, const attenuation *a)
{
    const metrics *m = a->m[MANY];
    double lost = (m[LITERAL].mean_a - m[SLAB].mean_a) / (1 - m[SLAB].mean_a);
    char text[480];

    snprintf(
        text, sizeof text,
        "With 24 directions of 24 steps the literal reading has an RMSE of %.4f to "
        "the integral of eq. 1 and a mean error of %+.4f; weighing each occluder for "
        "the elevations that it is first to block (`attenuation=slab`, the default): "
        "%.4f and %+.4f. The literal reading has %.0f %% less occlusion.",
        m[LITERAL].rmse, m[LITERAL].bias, m[SLAB].rmse, m[SLAB].bias, 100 * lost);
    measure_claim(
        h->s,
        (page_claim){
            .paper = "2008b, eq. 3",
            .statement =
                "With linear attenuation the integral of eq. 2 is (sin h - sin t) "
                "W with W at the horizon point.",
            /* 10 %: both share the depth buffer's own error, which hides part of the
             * difference; an error map shows this much. */
            .verdict = m[LITERAL].rmse < 1.02 * m[SLAB].rmse  ? PAGE_HOLDS
                       : m[LITERAL].rmse < 1.1 * m[SLAB].rmse ? PAGE_PARTLY
                                                              : PAGE_FAILS,
            .measured = text,
            .reason =
                "Along a wall the horizon rises to the wall's end or to the radius, "
                "where W is 0, and takes the weight of everything below with it: "
                "corners turn bright."});
}

int hbao_attenuation(const horizon_study *h)
{
    attenuation a = {0};
    int result;

    page_heading(h->s->page, 3, "hbao-attenuation", "Attenuation");
    result = measure_all(h, &a);
    if (result == EXIT_DONE)
        result = keep(h, &a);
    if (result != EXIT_DONE)
        return result;
    write_table(h, &a);
    claim(h, &a);
    return EXIT_DONE;
}
