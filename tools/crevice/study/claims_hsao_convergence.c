/* SPDX-License-Identifier: MIT */
/* claims_hsao_convergence.c: Figure 12 of Dimitrov, Bavoil, Sainz 2008, error over the
 * number of rays, for horizon-split ambient occlusion and for ray marching. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "claims_horizon.h"

/* Rays of a pixel: 2, 4, 8, 16, 32. */
enum { POINTS = 5, MOST_RAYS = 1 << POINTS };

/* Seeds, one ray each, that the random rays' own limit is the mean of; others than those
 * of the curve. Seven times the most rays: adds 7 % to the last error, the first ones
 * hardly. */
enum { LIMIT_SEEDS = 7 * MOST_RAYS };

/* Rays at which methods are compared. */
enum { LEVEL = 2, LEVEL_RAYS = 2 << LEVEL };

typedef enum kind {
    HORIZON_ALONE,
    HORIZON_SPLIT,
    MARCH_SPREAD,
    MARCH_RANDOM,
    KINDS
} kind;

static const char *const NAMES[KINDS] = {"hsao, horizon alone (Nn = 0)", "hsao, Nn = 1",
                                         "ray marching, well-spread rays",
                                         "ray marching, random rays"};
static const char *const WORDS[KINDS] = {"horizon_alone", "horizon_split",
                                         "march_well_spread", "march_random"};

typedef struct convergence {
    double rays[POINTS];
    double truth[KINDS][POINTS]; /* RMSE against the ray-traced picture */
    double own[KINDS][POINTS];   /* against what the method itself converges to */
    double limit[KINDS];         /* RMSE of that against the ray-traced picture */
    double slope[KINDS];         /* of own */
    double needs[KINDS];         /* rays for the error of HORIZON_SPLIT at LEVEL_RAYS */
    double levels[KINDS];        /* greys of 256 in use without a falloff */
    float *shown[KINDS][POINTS]; /* owned */
} convergence;

static crv_options options_of(const horizon_study *h, kind what, int32_t rays)
{
    crv_options o = h->paper;

    if (what >= MARCH_SPREAD)
        o.method = crv_method_find("raymarch");
    o.normal_rays = what == HORIZON_ALONE ? 0 : 1;
    o.directions = what == HORIZON_SPLIT ? rays / 2 : rays;
    return o;
}

/* About eight times the most rays, over the same jitter of the steps, which is part of
 * the method and which more rays do not average out. */
static crv_options limit_of(const horizon_study *h, kind what)
{
    crv_options o = options_of(h, what, MOST_RAYS);

    o.directions = what == HORIZON_ALONE ? 4 * MOST_RAYS : MOST_RAYS;
    o.normal_rays = what == HORIZON_ALONE ? 0 : 8;
    return o;
}

static int measure_regular(const horizon_study *h, kind what, convergence *c)
{
    crv_options o = limit_of(h, what);
    float *limit = NULL;
    metrics m = {0};
    int result = horizon_run(h, &o, STUDY_ONE_LAYER, &m, &limit);

    c->limit[what] = m.rmse;
    for (int i = 0; result == EXIT_DONE && i < POINTS; i++) {
        o = options_of(h, what, (int32_t)c->rays[i]);
        result = horizon_run(h, &o, STUDY_ONE_LAYER, &m, &c->shown[what][i]);
        if (result != EXIT_DONE)
            break;
        c->truth[what][i] = m.rmse;
        result = study_compare(h->s, h->v, c->shown[what][i], limit, &m);
        c->own[what][i] = m.rmse;
    }
    free(limit);
    return result;
}

/* The sum of pictures of one ray with these seeds, added to `sum`. */
static int add_random_rays(const horizon_study *h, int32_t first, int32_t count,
                           double *sum)
{
    size_t pixels = (size_t)h->v->width * (size_t)h->v->height;
    crv_options o = options_of(h, MARCH_RANDOM, 1);

    o.noise_size = 63; /* not a power of two: shuffled anew by each seed */
    for (int32_t i = 0; i < count; i++) {
        float *picture = NULL;
        int result;

        o.seed = first + i;
        result = horizon_run(h, &o, STUDY_ONE_LAYER, NULL, &picture);
        if (result != EXIT_DONE)
            return result;
        for (size_t k = 0; k < pixels; k++)
            sum[k] += (double)picture[k];
        free(picture);
    }
    return EXIT_DONE;
}

static float *mean_of(const study_view *v, const double *sum, double count)
{
    size_t pixels = (size_t)v->width * (size_t)v->height;
    float *mean = malloc(pixels * sizeof *mean);

    for (size_t k = 0; mean != NULL && k < pixels; k++)
        mean[k] = (float)(sum[k] / count);
    return mean;
}

static int measure_random_sums(const horizon_study *h, convergence *c, double *sum,
                               const float *limit)
{
    int32_t done = 0;
    metrics m = {0};

    for (int i = 0; i < POINTS; i++) {
        int32_t rays = (int32_t)c->rays[i];
        int result = add_random_rays(h, 1 + done, rays - done, sum);

        if (result != EXIT_DONE)
            return result;
        done = rays;
        c->shown[MARCH_RANDOM][i] = mean_of(h->v, sum, rays);
        if (c->shown[MARCH_RANDOM][i] == NULL)
            return report_no_memory(h->s->r);
        result = study_compare(h->s, h->v, c->shown[MARCH_RANDOM][i], h->truth, &m);
        c->truth[MARCH_RANDOM][i] = m.rmse;
        if (result == EXIT_DONE)
            result = study_compare(h->s, h->v, c->shown[MARCH_RANDOM][i], limit, &m);
        c->own[MARCH_RANDOM][i] = m.rmse;
        if (result != EXIT_DONE)
            return result;
    }
    return EXIT_DONE;
}

/* Each ray's direction and jitter drawn anew: another seed for each ray. */
static int measure_random(const horizon_study *h, convergence *c)
{
    size_t pixels = (size_t)h->v->width * (size_t)h->v->height;
    double *sum = calloc(pixels, sizeof *sum);
    float *limit = NULL;
    metrics m = {0};
    int result = sum != NULL ? add_random_rays(h, 1000, LIMIT_SEEDS, sum)
                             : report_no_memory(h->s->r);

    if (result == EXIT_DONE) {
        limit = mean_of(h->v, sum, LIMIT_SEEDS);
        result = limit != NULL ? study_compare(h->s, h->v, limit, h->truth, &m)
                               : report_no_memory(h->s->r);
    }
    c->limit[MARCH_RANDOM] = m.rmse;
    if (result == EXIT_DONE) {
        memset(sum, 0, pixels * sizeof *sum);
        result = measure_random_sums(h, c, sum, limit);
    }
    free(sum);
    free(limit);
    return result;
}

/* The greys of an 8-bit picture that are in use. */
static int grey_levels(const study_view *v, const float *picture)
{
    size_t pixels = (size_t)v->width * (size_t)v->height;
    bool used[256] = {false};
    int count = 0;

    for (size_t k = 0; k < pixels; k++) {
        if (v->mask[k])
            used[(int)((double)picture[k] * 255.0 + 0.5)] = true;
    }
    for (int i = 0; i < 256; i++)
        count += used[i];
    return count;
}

static int measure_levels(const horizon_study *h, convergence *c)
{
    for (kind k = HORIZON_ALONE; k <= MARCH_SPREAD; k++) {
        crv_options o = options_of(h, k, LEVEL_RAYS);
        float *picture = NULL;
        int result;

        o.falloff = CRV_FALLOFF_NONE;
        result = horizon_run(h, &o, STUDY_ONE_LAYER, NULL, &picture);
        if (result != EXIT_DONE)
            return result;
        c->levels[k] = grey_levels(h->v, picture);
        free(picture);
    }
    return EXIT_DONE;
}

static int measure_all(const horizon_study *h, convergence *c)
{
    int result = EXIT_DONE;

    for (int i = 0; i < POINTS; i++)
        c->rays[i] = 2 << i;
    for (kind k = HORIZON_ALONE; result == EXIT_DONE && k <= MARCH_SPREAD; k++) {
        study_progress(h->s, "claims, 2008a: %s", NAMES[k]);
        result = measure_regular(h, k, c);
    }
    if (result == EXIT_DONE) {
        study_progress(h->s, "claims, 2008a: %s", NAMES[MARCH_RANDOM]);
        result = measure_random(h, c);
    }
    if (result == EXIT_DONE)
        result = measure_levels(h, c);
    for (kind k = HORIZON_ALONE; result == EXIT_DONE && k < KINDS; k++) {
        c->slope[k] = measure_slope(c->rays, c->own[k], POINTS);
        c->needs[k] =
            measure_crossing(c->rays, c->own[k], POINTS, c->own[HORIZON_SPLIT][LEVEL]);
    }
    return result;
}

static int keep(const horizon_study *h, const convergence *c)
{
    cJSON *all = measure_object(h->s, h->json, "convergence");

    if (all == NULL || !measure_array(h->s, all, "rays", c->rays, POINTS))
        return EXIT_FAILED;
    for (kind k = HORIZON_ALONE; k < KINDS; k++) {
        cJSON *one = measure_object(h->s, all, WORDS[k]);

        if (one == NULL
            || !measure_array(h->s, one, "rmse_to_ray_traced", c->truth[k], POINTS)
            || !measure_array(h->s, one, "rmse_to_own_limit", c->own[k], POINTS)
            || !horizon_number(h, one, "limit_rmse_to_ray_traced", c->limit[k])
            || !horizon_number(h, one, "slope", c->slope[k])
            || !horizon_number(h, one, "rays_for_equal_error", c->needs[k])
            || (k < MARCH_RANDOM && !horizon_number(h, one, "grey_levels", c->levels[k])))
            return EXIT_FAILED;
    }
    return EXIT_DONE;
}

/* A line for each method, and the ideal of random rays. */
static void draw(const horizon_study *h, const convergence *c, bool own)
{
    plot_series series[KINDS + 1];
    double guide[POINTS];
    plot p = {.caption =
                  own ? "Figure 12 of 2008a as numbers: RMS distance from what the same "
                        "method gives with about eight times as many rays as the last "
                        "point. How well it is on the way to its own limit, whatever "
                        "that limit is worth. Unfiltered, `steps=12`, linear falloff."
                      : "The same runs against the ray-traced picture. Where a line "
                        "turns level, the rest is no longer a matter of rays: depth "
                        "buffer, steps, and for the horizon alone what it leaves out.",
              .x_title = "rays for each pixel: Nd (1 + Nn), of ray marching Nd Nn",
              .y_title = own ? "RMS distance from own limit" : "RMSE to ray tracing",
              .log_x = true,
              .log_y = own,
              .series = series,
              .series_count = own ? KINDS + 1 : KINDS};

    for (int k = 0; k < KINDS; k++)
        series[k] = (plot_series){.name = NAMES[k],
                                  .x = c->rays,
                                  .y = own ? c->own[k] : c->truth[k],
                                  .count = POINTS,
                                  .is_line = true};
    for (int i = 0; i < POINTS; i++)
        guide[i] = c->own[MARCH_RANDOM][0] * sqrt(c->rays[0] / c->rays[i]);
    series[KINDS] = (plot_series){.name = "1/sqrt(rays)",
                                  .x = c->rays,
                                  .y = guide,
                                  .count = POINTS,
                                  .is_line = true,
                                  .is_guide = true};
    page_plot(h->s->page, &p);
}

static int show(const horizon_study *h, const convergence *c)
{
    static const kind ROWS[] = {MARCH_RANDOM, MARCH_SPREAD, HORIZON_SPLIT, HORIZON_ALONE};
    static const int COLUMNS[] = {0, 2, 4};
    int result = EXIT_DONE;

    for (int row = 0; row < 4; row++) {
        page_grid_begin(h->s->page);
        for (int column = 0; result == EXIT_DONE && column < 3; column++) {
            kind k = ROWS[row];
            int i = COLUMNS[column], rays = (int)c->rays[i];
            char name[64], caption[160];

            snprintf(name, sizeof name, "hsao-rays-%d-%d", (int)k, rays);
            snprintf(caption, sizeof caption, "%s: %d rays, RMSE %.4f", NAMES[k], rays,
                     c->truth[k][i]);
            result = horizon_show(h, name, c->shown[k][i], caption);
        }
        page_grid_end(h->s->page);
    }
    return result;
}

/* "12.3", or "more than 32" where the curve does not get there. */
static void write_rays(double rays, char text[32])
{
    if (rays > MOST_RAYS)
        snprintf(text, 32, "more than %d", MOST_RAYS);
    else if (!(rays > 0))
        snprintf(text, 32, "less than 2");
    else
        snprintf(text, 32, "%.1f", rays);
}

static void claim_fewer_rays(const horizon_study *h, const convergence *c)
{
    char spread[32], random[32], text[640];
    /* Errors over many thousand pixels repeat to a few percent; over the slopes here
     * that is 15 % in rays at most. Less than a quarter more is no difference. */
    bool beats_random = c->needs[MARCH_RANDOM] > 1.25 * LEVEL_RAYS;
    bool beats_spread = c->needs[MARCH_SPREAD] > 1.25 * LEVEL_RAYS;

    write_rays(c->needs[MARCH_SPREAD], spread);
    write_rays(c->needs[MARCH_RANDOM], random);
    snprintf(text, sizeof text,
             "For the distance from its own limit that `hsao` has with %d rays (%.4f), "
             "ray marching needs %s random rays, or %s well-spread ones. Limits: "
             "RMSE %.4f to ray tracing for hsao, %.4f for ray marching.",
             LEVEL_RAYS, c->own[HORIZON_SPLIT][LEVEL], random, spread,
             c->limit[HORIZON_SPLIT], c->limit[MARCH_SPREAD]);
    measure_claim(
        h->s,
        (page_claim){
            .paper = "2008a, Figure 12",
            .statement = "Ray marching converges to a similar picture as horizon-split "
                         "ambient occlusion, but needs more rays.",
            .verdict = beats_random && beats_spread ? PAGE_HOLDS
                       : beats_random               ? PAGE_PARTLY
                                                    : PAGE_FAILS,
            .measured = text,
            .reason =
                beats_random
                    ? "The paper compares with Monte Carlo rays, and against these it "
                      "holds. `raymarch` spreads its rays evenly in azimuth and height, "
                      "which helps it in both dimensions at once; `hsao` spends half of "
                      "its rays on the horizon, and what is above the horizon hangs on "
                      "a single ray for each direction."
                    : "What the normal rays find above the horizon varies as much here "
                      "as what ray marching finds in the whole hemisphere, at twice the "
                      "rays for each direction."});
}

static void claim_horizon_rate(const horizon_study *h, const convergence *c)
{
    char text[512];
    double best = fmin(c->slope[MARCH_SPREAD], c->slope[MARCH_RANDOM]);

    snprintf(text, sizeof text,
             "Distance from the own limit falls with rays^%.2f for the horizon alone, "
             "rays^%.2f for hsao with one normal ray, rays^%.2f for well-spread and "
             "rays^%.2f for random marched rays. The horizon alone has its limit at an "
             "RMSE of %.4f to ray tracing, hsao with normal rays at %.4f.",
             c->slope[HORIZON_ALONE], c->slope[HORIZON_SPLIT], c->slope[MARCH_SPREAD],
             c->slope[MARCH_RANDOM], c->limit[HORIZON_ALONE], c->limit[HORIZON_SPLIT]);
    measure_claim(
        h->s,
        (page_claim){
            .paper = "2008a, sections 1 and 5",
            .statement = "Horizon occlusion converges faster than marched rays, because "
                         "what is below the horizon is integrated in closed form.",
            /* Over a factor of 16 in rays, 0.1 in the exponent is a third in error. */
            .verdict = c->slope[HORIZON_ALONE] < best - 0.1 ? PAGE_HOLDS
                       : c->slope[HORIZON_ALONE] < c->slope[MARCH_RANDOM] - 0.1
                           ? PAGE_PARTLY
                           : PAGE_FAILS,
            .measured = text,
            .reason = "Well-spread rays come near the rate that one dimension of closed "
                      "form gains over random ones."});
}

static void claim_greys(const horizon_study *h, const convergence *c)
{
    char text[320];

    snprintf(text, sizeof text,
             "With %d rays and falloff `none`, the unfiltered 8-bit picture has %.0f "
             "greys for the horizon alone, %.0f for hsao with Nn = 1 and %.0f for ray "
             "marching.",
             LEVEL_RAYS, c->levels[HORIZON_ALONE], c->levels[HORIZON_SPLIT],
             c->levels[MARCH_SPREAD]);
    measure_claim(
        h->s,
        (page_claim){.paper = "2008a, section 6",
                     .statement = "Fewer steps in the shades of grey than ray "
                                  "marching at a low number of rays.",
                     /* Twice the greys is an edge that can be seen. */
                     .verdict = c->levels[HORIZON_SPLIT] > 2 * c->levels[MARCH_SPREAD]
                                    ? PAGE_HOLDS
                                    : PAGE_FAILS,
                     .measured = text,
                     .reason = "The horizon is cut off at so few heights here "
                               "that it takes few values, too."});
}

int hsao_convergence(const horizon_study *h)
{
    convergence *c = calloc(1, sizeof *c);
    int result = c != NULL ? measure_all(h, c) : report_no_memory(h->s->r);

    if (result == EXIT_DONE)
        result = keep(h, c);
    if (result == EXIT_DONE) {
        page_heading(h->s->page, 3, "hsao-convergence", "Error over rays");
        page_text(h->s->page,
                  "A horizon ray and a marched ray take `steps=12` look-ups each, so "
                  "rays stand for cost. Random rays are the mean of runs with one ray "
                  "and another seed each; well-spread rays are those of `raymarch` as "
                  "it is, with `normal_rays=1` and one direction for each ray.");
        draw(h, c, true);
        draw(h, c, false);
        claim_fewer_rays(h, c);
        claim_horizon_rate(h, c);
        claim_greys(h, c);
        page_details_begin(h->s->page, "Pictures: 2, 8 and 32 rays, unfiltered");
        result = show(h, c);
        page_details_end(h->s->page);
    }
    for (int k = 0; c != NULL && k < KINDS; k++) {
        for (int i = 0; i < POINTS; i++)
            free(c->shown[k][i]);
    }
    free(c);
    return result;
}
