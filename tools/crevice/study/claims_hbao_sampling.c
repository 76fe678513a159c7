/* SPDX-License-Identifier: MIT */
/* claims_hbao_sampling.c: section 3 of Bavoil, Sainz, Dimitrov 2008: directions and
 * steps, random rotation and jitter, the tangent, and further layers. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "claims_hbao.h"

enum { VALUES = 6, ANGLES = 6, EIGHT = 2, DRAWS = 24 };

static const double COUNT[VALUES] = {2, 4, 8, 12, 16, 24};

typedef struct sampling {
    double directions[VALUES], steps[VALUES]; /* RMS distance from the limit */
    double directions_truth[VALUES], steps_truth[VALUES]; /* RMSE to ray tracing */
} sampling;

/* Directions are followed to the limit of many directions, steps to that of many steps,
 * the other number staying 8: the two do not hide each other. */
static int measure_line(const horizon_study *h, bool steps, double own[VALUES],
                        double truth[VALUES])
{
    crv_options o = h->paper;
    int32_t *number = steps ? &o.steps : &o.directions;
    float *limit = NULL;
    int result;

    *number = 64;
    result = horizon_run(h, &o, STUDY_ONE_LAYER, NULL, &limit);
    for (int i = 0; result == EXIT_DONE && i < VALUES; i++) {
        float *picture = NULL;
        metrics m = {0};

        *number = (int32_t)COUNT[i];
        result = horizon_run(h, &o, STUDY_ONE_LAYER, &m, &picture);
        truth[i] = m.rmse;
        if (result == EXIT_DONE)
            result = study_compare(h->s, h->v, picture, limit, &m);
        own[i] = m.rmse;
        free(picture);
    }
    free(limit);
    return result;
}

static void draw_sampling(const horizon_study *h, const sampling *v)
{
    plot_series series[4] = {
        {.name = "Nd, distance from many directions", .y = v->directions},
        {.name = "Ns, distance from many steps", .y = v->steps},
        {.name = "Nd, RMSE to ray tracing", .y = v->directions_truth},
        {.name = "Ns, RMSE to ray tracing", .y = v->steps_truth}};
    plot p = {.caption =
                  "Directions varied at 8 steps, and steps at 8 directions, "
                  "unfiltered: RMS distance from the same with 64, and RMSE to ray "
                  "tracing.",
              .x_title = "Nd or Ns",
              .y_title = "RMS distance, RMSE",
              .log_x = true,
              .log_y = true,
              .series = series,
              .series_count = 4};

    for (int k = 0; k < 4; k++) {
        series[k].x = COUNT;
        series[k].count = VALUES;
        series[k].is_line = true;
    }
    page_plot(h->s->page, &p);
}

static void claim_sampling(const horizon_study *h, const sampling *v)
{
    char text[480];
    double directions = v->directions_truth[EIGHT] / v->directions_truth[VALUES - 1];
    double steps = v->steps_truth[EIGHT] / v->steps_truth[VALUES - 1];

    snprintf(text, sizeof text,
             "8 directions are %.4f from many, 8 steps %.4f from many. RMSE to ray "
             "tracing: %.4f at 8x8, %.4f with 24 directions, %.4f with 24 steps.",
             v->directions[EIGHT], v->steps[EIGHT], v->directions_truth[EIGHT],
             v->directions_truth[VALUES - 1], v->steps_truth[VALUES - 1]);
    measure_claim(
        h->s, (page_claim){
                  .paper = "2008b, Figure 1",
                  .statement = "8 directions of 8 steps are enough for a good picture.",
                  /* Enough: three times as many gain a tenth at most. */
                  .verdict = directions < 1.1 && steps < 1.1   ? PAGE_HOLDS
                             : directions < 1.1 || steps < 1.1 ? PAGE_PARTLY
                                                               : PAGE_FAILS,
                  .measured = text,
                  .reason = steps >= 1.1
                                ? "Steps are the bottleneck: 8 over the radius pass over "
                                  "what is thinner than a step, and over the near part "
                                  "of every crease."
                                : "Unfiltered, 8 directions still leave visible noise; "
                                  "the filter removes most of it."});
}

int hbao_sampling(const horizon_study *h)
{
    sampling v;
    cJSON *all = measure_object(h->s, h->json, "sampling");
    int result = all != NULL ? EXIT_DONE : EXIT_FAILED;

    study_progress(h->s, "claims, 2008b: directions and steps");
    if (result == EXIT_DONE)
        result = measure_line(h, false, v.directions, v.directions_truth);
    if (result == EXIT_DONE)
        result = measure_line(h, true, v.steps, v.steps_truth);
    if (result != EXIT_DONE)
        return result;
    if (!measure_array(h->s, all, "count", COUNT, VALUES)
        || !measure_array(h->s, all, "directions_own", v.directions, VALUES)
        || !measure_array(h->s, all, "steps_own", v.steps, VALUES)
        || !measure_array(h->s, all, "directions_rmse", v.directions_truth, VALUES)
        || !measure_array(h->s, all, "steps_rmse", v.steps_truth, VALUES))
        return EXIT_FAILED;
    page_heading(h->s->page, 3, "hbao-sampling", "Directions and steps");
    draw_sampling(h, &v);
    claim_sampling(h, &v);
    return EXIT_DONE;
}

/* RMS distances from the mean over many draws of the noise, which has neither noise nor
 * banding, but misses what 8 directions of 8 steps miss: unfiltered, and with both
 * pictures filtered, so that what the filter does to real detail does not count. First
 * with one rotation and jitter for all pixels, then with a 4x4 tile. */
typedef struct jitter {
    double raw[2], filtered[2];
    double detail; /* what the filter changes where there is no noise */
} jitter;

static int measure_jitter(const horizon_study *h, const float *const limits[2], int k,
                          jitter *out)
{
    static const char *const NAMES[] = {"the same for all pixels", "4x4 tile"};
    crv_options o = h->paper;
    int result = EXIT_DONE;

    o.noise_size = k == 0 ? 1 : 4;
    for (int filtered = 0; result == EXIT_DONE && filtered < 2; filtered++) {
        float *picture = NULL;
        char name[32], caption[128];
        metrics m = {0};

        o.filter = filtered ? crv_filter_find("bilateral13") : NULL;
        result = horizon_run(h, &o, STUDY_ONE_LAYER, NULL, &picture);
        if (result == EXIT_DONE)
            result = study_compare(h->s, h->v, picture, limits[filtered], &m);
        *(filtered ? &out->filtered[k] : &out->raw[k]) = m.rmse;
        snprintf(name, sizeof name, "hbao-jitter-%d-%d", k, filtered);
        snprintf(caption, sizeof caption, "%s, %s: %.4f from the mean", NAMES[k],
                 filtered ? "bilateral13" : "unfiltered", m.rmse);
        if (result == EXIT_DONE)
            result = horizon_show(h, name, picture, caption);
        free(picture);
    }
    return result;
}

static void claim_jitter(const horizon_study *h, const jitter *j)
{
    char text[640];
    double banded = j->filtered[0] / j->raw[0], noisy = j->filtered[1] / j->raw[1];
    /* A tenth: less cannot be told apart in pictures side by side. */
    bool works = noisy < 0.9 * banded, best = j->filtered[1] < 0.9 * j->filtered[0];

    snprintf(text, sizeof text,
             "RMS distance from the mean over %d draws of the noise: %.4f with the same "
             "rotation and jitter at all pixels, %.4f with a 4x4 tile. With both "
             "pictures filtered by "
             "`bilateral13`, the distances are %.4f and %.4f. The filter itself changes "
             "the picture without noise by %.4f.",
             (int)DRAWS, j->raw[0], j->raw[1], j->filtered[0], j->filtered[1], j->detail);
    measure_claim(
        h->s, (page_claim){
                  .paper = "2008b, section 3",
                  .statement = "Random rotation and jitter for each pixel trade banding "
                               "for noise, which a filter can remove.",
                  .verdict = works && best   ? PAGE_HOLDS
                             : works || best ? PAGE_PARTLY
                                             : PAGE_FAILS,
                  .measured = text,
                  .reason = "Banding that is finer than the filter is removed by it as "
                            "well, and 8 directions of 8 steps at this radius in "
                            "pixels leave few wide bands."});
}

static int measure_jitters(const horizon_study *h, float *mean, float *filtered,
                           jitter *j)
{
    crv_options o = h->paper;
    const float *const limits[2] = {mean, filtered};
    metrics m = {0};
    int result = horizon_mean(h, &h->paper, DRAWS, mean);

    o.filter = crv_filter_find("bilateral13");
    if (result == EXIT_DONE)
        result = study_filter(h->s, h->v, &o, mean, filtered);
    if (result == EXIT_DONE)
        result = study_compare(h->s, h->v, filtered, mean, &m);
    j->detail = m.rmse;
    page_grid_begin(h->s->page);
    for (int k = 0; result == EXIT_DONE && k < 2; k++)
        result = measure_jitter(h, limits, k, j);
    page_grid_end(h->s->page);
    return result;
}

int hbao_jitter(const horizon_study *h)
{
    size_t pixels = (size_t)h->v->width * (size_t)h->v->height;
    float *mean = malloc(2 * pixels * sizeof *mean); /* and the same filtered */
    jitter j = {0};
    cJSON *all = measure_object(h->s, h->json, "jitter");
    int result = mean != NULL ? EXIT_DONE : report_no_memory(h->s->r);

    study_progress(h->s, "claims, 2008b: jitter");
    page_heading(h->s->page, 3, "hbao-jitter", "Noise for banding");
    if (result == EXIT_DONE && all != NULL)
        result = measure_jitters(h, mean, mean + pixels, &j);
    free(mean);
    if (result != EXIT_DONE || all == NULL)
        return EXIT_FAILED;
    if (!measure_array(h->s, all, "raw", j.raw, 2)
        || !measure_array(h->s, all, "filtered", j.filtered, 2)
        || !horizon_number(h, all, "detail", j.detail))
        return EXIT_FAILED;
    claim_jitter(h, &j);
    return EXIT_DONE;
}

static const double ANGLE[ANGLES] = {0, 2, 5, 10, 20, 30};

int hbao_bias(const horizon_study *h)
{
    double rmse[ANGLES], off[ANGLES];
    plot_series series[2] = {
        {.name = "RMSE", .x = ANGLE, .y = rmse, .count = ANGLES, .is_line = true},
        {.name = "mean error", .x = ANGLE, .y = off, .count = ANGLES, .is_line = true}};
    plot p = {.caption = "What an angle that raises the tangent costs: `bias_deg` at "
                         "`directions=16 steps=16`, unfiltered, against ray tracing. The "
                         "paper has none; it hides the facets of coarse meshes, and "
                         "rounding.",
              .x_title = "bias, degrees",
              .y_title = "RMSE, mean error",
              .series = series,
              .series_count = 2};
    cJSON *all = measure_object(h->s, h->json, "bias");
    int best = 0;

    study_progress(h->s, "claims, 2008b: bias of the tangent");
    for (int i = 0; i < ANGLES; i++) {
        crv_options o = h->paper;
        metrics m;
        int result;

        o.directions = 16;
        o.steps = 16;
        o.bias_deg = (float)ANGLE[i];
        result = horizon_run(h, &o, STUDY_ONE_LAYER, &m, NULL);
        if (result != EXIT_DONE)
            return result;
        rmse[i] = m.rmse;
        off[i] = m.bias;
        best = rmse[i] < rmse[best] ? i : best;
    }
    if (all == NULL || !measure_array(h->s, all, "degrees", ANGLE, ANGLES)
        || !measure_array(h->s, all, "rmse", rmse, ANGLES)
        || !measure_array(h->s, all, "mean_error", off, ANGLES))
        return EXIT_FAILED;
    page_heading(h->s->page, 3, "hbao-bias", "Bias of the tangent");
    page_plot(h->s->page, &p);
    if (best == 0)
        page_text(h->s->page,
                  "Every bias makes this picture worse: RMSE %.4f without, %.4f at %.0f "
                  "and %.4f at %.0f degrees.",
                  rmse[0], rmse[1], ANGLE[1], rmse[ANGLES - 1], ANGLE[ANGLES - 1]);
    else
        page_text(h->s->page,
                  "The RMSE is lowest at %.0f degrees: %.4f, against %.4f without a bias "
                  "and %.4f at %.0f degrees.",
                  ANGLE[best], rmse[best], rmse[0], rmse[ANGLES - 1], ANGLE[ANGLES - 1]);
    return EXIT_DONE;
}
