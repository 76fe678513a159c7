/* SPDX-License-Identifier: MIT */
/* claims_hsao_numbers.c: Figure 7 of Dimitrov, Bavoil, Sainz 2008: what the numbers of
 * directions, steps and normal rays do. */
#include <stdio.h>

#include "claims_horizon.h"

enum { VALUES = 5 };

typedef enum number { DIRECTIONS, STEPS, NORMAL_RAYS, NUMBERS } number;

static const double VALUE[NUMBERS][VALUES] = {
    {2, 4, 7, 14, 28}, {3, 6, 12, 24, 48}, {0, 1, 2, 4, 8}};
static const char *const NUMBER_NAMES[NUMBERS] = {"Nd, directions", "Ns, steps",
                                                  "Nn, normal rays"};
static const char *const NUMBER_KEYS[NUMBERS] = {"directions", "steps", "normal_rays"};

static crv_options with_number(const horizon_study *h, number what, int i)
{
    crv_options o = h->paper;
    int32_t value = (int32_t)VALUE[what][i];

    if (what == DIRECTIONS)
        o.directions = value;
    else if (what == STEPS)
        o.steps = value;
    else
        o.normal_rays = value;
    return o;
}

static int measure_numbers(const horizon_study *h, metrics m[NUMBERS][VALUES],
                           double samples[NUMBERS][VALUES])
{
    for (int k = 0; k < NUMBERS; k++) {
        study_progress(h->s, "claims, 2008a: %s", NUMBER_NAMES[k]);
        for (int i = 0; i < VALUES; i++) {
            crv_options o = with_number(h, (number)k, i);
            int result = horizon_run(h, &o, STUDY_ONE_LAYER, &m[k][i], NULL);

            if (result != EXIT_DONE)
                return result;
            samples[k][i] = study_samples(&o);
        }
    }
    return EXIT_DONE;
}

static void draw_numbers(const horizon_study *h, double values[NUMBERS][VALUES],
                         double samples[NUMBERS][VALUES], bool error)
{
    plot_series series[NUMBERS];
    plot p = {.caption =
                  error ? "Each of the three numbers varied alone about `directions=7 "
                          "steps=12 normal_rays=1` (Figures 7 and 11 of 2008a), over the "
                          "look-ups it costs. Unfiltered, against ray tracing."
                        : "The same runs: mean signed error. Above 0 the picture is too "
                          "bright.",
              .x_title = "look-ups in the buffers for each pixel",
              .y_title = error ? "RMSE to ray tracing" : "mean error",
              .log_x = true,
              .series = series,
              .series_count = NUMBERS};

    for (int k = 0; k < NUMBERS; k++)
        series[k] = (plot_series){.name = NUMBER_NAMES[k],
                                  .x = samples[k],
                                  .y = values[k],
                                  .count = VALUES,
                                  .is_line = true};
    page_plot(h->s->page, &p);
}

/* How much of the error goes away from the lowest value to the highest. */
static double gain(const metrics m[VALUES])
{
    return 1 - m[VALUES - 1].rmse / m[0].rmse;
}

static void claim_numbers(const horizon_study *h, metrics m[NUMBERS][VALUES])
{
    char text[512];
    int helped = 0;

    /* 3 % is what another seed changes at most. */
    for (int k = 0; k < NUMBERS; k++)
        helped += gain(m[k]) > 0.03;
    snprintf(
        text, sizeof text,
        "RMSE from %.4f to %.4f with 2 to 28 directions, from %.4f to %.4f with 3 to "
        "48 steps, from %.4f to %.4f with 0 to 8 normal rays.",
        m[DIRECTIONS][0].rmse, m[DIRECTIONS][VALUES - 1].rmse, m[STEPS][0].rmse,
        m[STEPS][VALUES - 1].rmse, m[NORMAL_RAYS][0].rmse,
        m[NORMAL_RAYS][VALUES - 1].rmse);
    measure_claim(
        h->s, (page_claim){
                  .paper = "2008a, Figure 7 and section 3.6",
                  .statement = "More directions, more steps and more normal rays each "
                               "give a better picture.",
                  .verdict = helped == NUMBERS ? PAGE_HOLDS
                             : helped > 0      ? PAGE_PARTLY
                                               : PAGE_FAILS,
                  .measured = text,
                  .reason = gain(m[STEPS]) <= 0.03
                                ? "More steps also find more of the thin occluders, and "
                                  "take each of them for a wall without a back: the "
                                  "picture gets too dark faster than it gets "
                                  "finer."
                                : "What is left is not a matter of sampling: the depth "
                                  "buffer holds only the first surface."});
}

int hsao_numbers(const horizon_study *h)
{
    static metrics m[NUMBERS][VALUES];
    double rmse[NUMBERS][VALUES], bias[NUMBERS][VALUES], samples[NUMBERS][VALUES];
    cJSON *all = measure_object(h->s, h->json, "numbers");
    int result = all != NULL ? measure_numbers(h, m, samples) : EXIT_FAILED;

    if (result != EXIT_DONE)
        return result;
    for (int k = 0; k < NUMBERS; k++) {
        cJSON *one = measure_object(h->s, all, NUMBER_KEYS[k]);

        for (int i = 0; i < VALUES; i++) {
            rmse[k][i] = m[k][i].rmse;
            bias[k][i] = m[k][i].bias;
        }
        if (one == NULL || !measure_array(h->s, one, "values", VALUE[k], VALUES)
            || !measure_array(h->s, one, "rmse", rmse[k], VALUES)
            || !measure_array(h->s, one, "bias", bias[k], VALUES))
            return EXIT_FAILED;
    }
    page_heading(h->s->page, 3, "hsao-numbers", "Effect of Nd, Ns and Nn");
    draw_numbers(h, rmse, samples, true);
    draw_numbers(h, bias, samples, false);
    claim_numbers(h, m);
    return EXIT_DONE;
}
