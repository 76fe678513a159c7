/* SPDX-License-Identifier: MIT */
/* claims_hsao_sets.c: Figure 11 of Dimitrov, Bavoil, Sainz 2008: sets from performance to
 * quality, and the blur. */
#include <stdio.h>
#include <stdlib.h>

#include "claims_horizon.h"

enum { SETS = 4, DRAWS = 12 };

/* Figure 11. */
typedef struct set {
    const char *name;
    int32_t directions, steps, normal_rays;
} set;

static const set FIGURE_11[SETS] = {
    {"a", 6, 9, 0}, {"b", 8, 18, 0}, {"c", 8, 18, 1}, {"d", 18, 25, 2}};

static int measure_set(const horizon_study *h, const set *what, metrics *raw,
                       metrics *blurred, float **picture)
{
    crv_options o = h->paper;
    int result;

    o.directions = what->directions;
    o.steps = what->steps;
    o.normal_rays = what->normal_rays;
    result = horizon_run(h, &o, STUDY_ONE_LAYER, raw, NULL);
    o.filter = crv_filter_find("gauss5");
    if (result == EXIT_DONE)
        result = horizon_run(h, &o, STUDY_ONE_LAYER, blurred, picture);
    return result;
}

static int measure_sets(const horizon_study *h, metrics raw[SETS], metrics blurred[SETS])
{
    int result = EXIT_DONE;

    page_grid_begin(h->s->page);
    for (int i = 0; result == EXIT_DONE && i < SETS; i++) {
        const set *f = &FIGURE_11[i];
        float *picture = NULL;
        char name[32], caption[128];

        study_progress(h->s, "claims, 2008a: Figure 11(%s)", f->name);
        result = measure_set(h, f, &raw[i], &blurred[i], &picture);
        snprintf(name, sizeof name, "hsao-figure-11%s", f->name);
        snprintf(caption, sizeof caption, "(%s) Nd %d, Ns %d, Nn %d, gauss5: RMSE %.4f",
                 f->name, f->directions, f->steps, f->normal_rays, blurred[i].rmse);
        if (result == EXIT_DONE)
            result = horizon_show(h, name, picture, caption);
        free(picture);
    }
    if (result == EXIT_DONE)
        result = horizon_show(h, "hsao-figure-11e", h->truth, "(e) ray traced");
    page_grid_end(h->s->page);
    return result;
}

static void write_sets(const horizon_study *h, const metrics raw[SETS],
                       const metrics blurred[SETS])
{
    static const char *const HEADERS[] = {"set",  "Nd",           "Ns",
                                          "Nn",   "look-ups",     "RMSE",
                                          "bias", "RMSE, gauss5", "SSIM, gauss5"};
    page *p = h->s->page;

    page_table_begin(p, "The sets of Figure 11 against ray tracing, linear falloff.",
                     HEADERS, 9);
    for (int i = 0; i < SETS; i++) {
        const set *f = &FIGURE_11[i];

        page_cell(p, "(%s)", f->name);
        page_cell(p, "%d", f->directions);
        page_cell(p, "%d", f->steps);
        page_cell(p, "%d", f->normal_rays);
        page_cell(p, "%d", f->directions * f->steps * (1 + f->normal_rays));
        page_cell(p, "%.4f", raw[i].rmse);
        page_cell(p, "%+.4f", raw[i].bias);
        page_cell(p, "%.4f", blurred[i].rmse);
        page_cell(p, "%.3f", blurred[i].ssim);
    }
    page_table_end(p);
}

static void claim_sets(const horizon_study *h, const metrics blurred[SETS])
{
    char text[320];
    double normal = blurred[2].rmse / blurred[1].rmse;
    double all = blurred[3].rmse / blurred[0].rmse;

    snprintf(
        text, sizeof text,
        "A normal ray takes the RMSE from %.4f (b) to %.4f (c); from performance (a) "
        "to quality (d) it goes from %.4f to %.4f.",
        blurred[1].rmse, blurred[2].rmse, blurred[0].rmse, blurred[3].rmse);
    measure_claim(
        h->s,
        (page_claim){.paper = "2008a, Figure 11",
                     .statement = "Normal occlusion improves the occlusion of near "
                                  "things, and the set for quality is nearer to ray "
                                  "tracing than the one for performance.",
                     /* 3 %: what another seed may change. */
                     .verdict = normal < 0.97 && all < 0.97   ? PAGE_HOLDS
                                : normal < 0.97 || all < 0.97 ? PAGE_PARTLY
                                                              : PAGE_FAILS,
                     .measured = text,
                     .reason = "What the depth buffer does not hold outweighs what the "
                               "further samples find."});
}

/* What the blur does with set (c). */
typedef struct blur {
    double noise, blurred_noise; /* RMS distance from the mean over draws; both blurred */
    double detail;               /* what the blur changes where there is no noise */
} blur;

static int distance(const horizon_study *h, const float *a, const float *b, double *rmse)
{
    metrics m = {0};
    int result = study_compare(h->s, h->v, a, b, &m);

    *rmse = m.rmse;
    return result;
}

static int measure_blur(const horizon_study *h, blur *out)
{
    size_t pixels = (size_t)h->v->width * (size_t)h->v->height;
    float *mean = malloc(3 * pixels * sizeof *mean), *picture = NULL;
    float *blurred_mean, *blurred;
    crv_options o = h->paper, filter;
    int result;

    if (mean == NULL)
        return report_no_memory(h->s->r);
    blurred_mean = mean + pixels;
    blurred = blurred_mean + pixels;
    o.directions = FIGURE_11[2].directions;
    o.steps = FIGURE_11[2].steps;
    o.normal_rays = FIGURE_11[2].normal_rays;
    filter = o;
    filter.filter = crv_filter_find("gauss5");
    study_progress(h->s, "claims, 2008a: blur");
    result = horizon_mean(h, &o, DRAWS, mean);
    if (result == EXIT_DONE)
        result = horizon_run(h, &o, STUDY_ONE_LAYER, NULL, &picture);
    if (result == EXIT_DONE)
        result = study_filter(h->s, h->v, &filter, mean, blurred_mean);
    if (result == EXIT_DONE)
        result = study_filter(h->s, h->v, &filter, picture, blurred);
    if (result == EXIT_DONE)
        result = distance(h, picture, mean, &out->noise);
    if (result == EXIT_DONE)
        result = distance(h, blurred, blurred_mean, &out->blurred_noise);
    if (result == EXIT_DONE)
        result = distance(h, blurred_mean, mean, &out->detail);
    free(picture);
    free(mean);
    return result;
}

static void claim_blur(const horizon_study *h, const blur *b, const metrics raw[SETS],
                       const metrics blurred[SETS])
{
    char text[400];
    /* A third less noise can be seen; 3 % of error as above. */
    bool quieter = b->blurred_noise < 0.67 * b->noise;
    bool better = blurred[2].rmse < 0.97 * raw[2].rmse;

    snprintf(
        text, sizeof text,
        "Set (c): noise of %.4f without and %.4f with `gauss5`, RMS distance from the "
        "mean over %d draws. The blur changes the picture without noise by %.4f. "
        "RMSE to ray tracing: %.4f without, %.4f with it.",
        b->noise, b->blurred_noise, (int)DRAWS, b->detail, raw[2].rmse, blurred[2].rmse);
    measure_claim(
        h->s, (page_claim){
                  .paper = "2008a, section 4.1.3",
                  .statement = "A 5x5 Gaussian weighted by depth reduces the noise and "
                               "preserves what is sharp.",
                  .verdict = quieter && better   ? PAGE_HOLDS
                             : quieter || better ? PAGE_PARTLY
                                                 : PAGE_FAILS,
                  .measured = text,
                  .reason = "The blur also spreads contact shadows a few pixels wide, "
                            "where depth does not tell the surfaces apart: in creases. "
                            "That takes back what less noise gains."});
}

int hsao_sets(const horizon_study *h)
{
    metrics raw[SETS] = {0}, blurred[SETS] = {0};
    double values[3][SETS];
    blur b = {0};
    cJSON *all = measure_object(h->s, h->json, "figure_11");
    int result;

    if (all == NULL)
        return EXIT_FAILED;
    page_heading(h->s->page, 3, "hsao-sets", "From performance to quality");
    result = measure_sets(h, raw, blurred);
    if (result != EXIT_DONE)
        return result;
    for (int i = 0; i < SETS; i++) {
        values[0][i] = raw[i].rmse;
        values[1][i] = blurred[i].rmse;
        values[2][i] = raw[i].bias;
    }
    if (!measure_array(h->s, all, "rmse", values[0], SETS)
        || !measure_array(h->s, all, "rmse_gauss5", values[1], SETS)
        || !measure_array(h->s, all, "bias", values[2], SETS))
        return EXIT_FAILED;
    write_sets(h, raw, blurred);
    claim_sets(h, blurred);
    result = measure_blur(h, &b);
    if (result != EXIT_DONE || !horizon_number(h, all, "noise", b.noise)
        || !horizon_number(h, all, "noise_gauss5", b.blurred_noise)
        || !horizon_number(h, all, "detail_gauss5", b.detail))
        return EXIT_FAILED;
    claim_blur(h, &b, raw, blurred);
    return EXIT_DONE;
}
