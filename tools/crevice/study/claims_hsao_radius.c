/* SPDX-License-Identifier: MIT */
/* claims_hsao_radius.c: Figure 6 of Dimitrov, Bavoil, Sainz 2008: what the radius does.
 */
#include <stdio.h>
#include <stdlib.h>

#include "claims_horizon.h"

enum { RADII = 5 };

static const double FACTORS[RADII] = {0.25, 0.5, 1, 2, 4};

typedef struct radii {
    int32_t width, height;
    double mean[RADII];  /* accessibility */
    double noise[RADII]; /* RMS distance from many directions, steps and rays */
} radii;

/* At half the size: the many directions and steps are slow. */
static int measure_radii(const horizon_study *h, radii *out)
{
    study_view v;
    int result;

    out->width = (h->v->width + 1) / 2;
    out->height = (h->v->height + 1) / 2;
    result = study_view_resized(h->s, h->v, out->width, out->height, &v);
    if (result != EXIT_DONE)
        return result;
    for (int i = 0; result == EXIT_DONE && i < RADII; i++) {
        crv_options o = h->paper, much;
        float *limit = NULL, *picture = NULL;
        metrics m = {0};

        o.radius = (float)((double)h->v->radius * FACTORS[i]);
        much = o;
        much.directions = 32;
        much.steps = 48;
        much.normal_rays = 2;
        study_progress(h->s, "claims, 2008a: radius %g", (double)o.radius);
        result = measure_picture(h->s, &v, &much, &limit);
        if (result == EXIT_DONE)
            result = measure_picture(h->s, &v, &o, &picture);
        if (result == EXIT_DONE)
            result = study_compare(h->s, &v, picture, limit, &m);
        out->mean[i] = m.mean_b;
        out->noise[i] = m.rmse;
        free(limit);
        free(picture);
    }
    study_view_free(&v);
    return result;
}

static int show_radii(const horizon_study *h)
{
    int result = EXIT_DONE;

    page_grid_begin(h->s->page);
    for (int i = 0; result == EXIT_DONE && i < RADII; i++) {
        crv_options o = h->paper;
        float *picture = NULL;
        char name[32], caption[96];

        o.radius = (float)((double)h->v->radius * FACTORS[i]);
        o.filter = crv_filter_find("gauss5");
        result = horizon_run(h, &o, STUDY_ONE_LAYER, NULL, &picture);
        snprintf(name, sizeof name, "hsao-radius-%d", i);
        snprintf(caption, sizeof caption, "radius %.3g (%g times the view's), gauss5",
                 (double)o.radius, FACTORS[i]);
        if (result == EXIT_DONE)
            result = horizon_show(h, name, picture, caption);
        free(picture);
    }
    page_grid_end(h->s->page);
    return result;
}

static void draw_radii(const horizon_study *h, const radii *r)
{
    double radius[RADII], dark[RADII];
    plot_series series[2] = {{.name = "mean occlusion, converged",
                              .x = radius,
                              .y = dark,
                              .count = RADII,
                              .is_line = true},
                             {.name = "noise of 7 directions, 12 steps, 1 normal ray",
                              .x = radius,
                              .y = r->noise,
                              .count = RADII,
                              .is_line = true}};
    plot p = {.caption =
                  "Figure 6 of 2008a as numbers. Mean occlusion 1 - A of the view, "
                  "and the RMS distance of `directions=7 steps=12 normal_rays=1` "
                  "from `directions=32 steps=48 normal_rays=2`, unfiltered, at "
                  "half the size.",
              .x_title = "radius, scene units",
              .y_title = "occlusion; RMS distance",
              .log_x = true,
              .y_from_zero = true,
              .series = series,
              .series_count = 2};

    for (int i = 0; i < RADII; i++) {
        radius[i] = (double)h->v->radius * FACTORS[i];
        dark[i] = 1 - r->mean[i];
    }
    page_plot(h->s->page, &p);
}

static void claim_radii(const horizon_study *h, const radii *r)
{
    char text[400];
    bool darker = true;
    double grows = r->noise[RADII - 1] / r->noise[0];

    for (int i = 1; i < RADII; i++)
        darker = darker && r->mean[i] < r->mean[i - 1];
    snprintf(
        text, sizeof text,
        "From a quarter of the radius to four times: mean occlusion from %.3f to "
        "%.3f, distance from many directions and steps from %.4f to %.4f at the same "
        "number of samples.",
        1 - r->mean[0], 1 - r->mean[RADII - 1], r->noise[0], r->noise[RADII - 1]);
    measure_claim(
        h->s, (page_claim){
                  .paper = "2008a, Figure 6 and section 3.6",
                  .statement = "A larger radius gives stronger occlusion, and needs "
                               "more rays for the same quality.",
                  /* A quarter more noise is about half as many rays again at the
                   * rates of Figure 12. */
                  .verdict = darker && grows > 1.25   ? PAGE_HOLDS
                             : darker || grows > 1.25 ? PAGE_PARTLY
                                                      : PAGE_FAILS,
                  .measured = text,
                  .reason = darker ? "The occluders of this view are large against the "
                                     "steps at every radius."
                                   : "At the largest radius occluders reach over the "
                                     "guard band, where nothing is known."});
}

int hsao_radius(const horizon_study *h)
{
    radii r = {0};
    cJSON *all = measure_object(h->s, h->json, "radius");
    int result = all != NULL ? measure_radii(h, &r) : EXIT_FAILED;

    if (result != EXIT_DONE)
        return result;
    if (!measure_array(h->s, all, "factors", FACTORS, RADII)
        || !measure_array(h->s, all, "mean_accessibility", r.mean, RADII)
        || !measure_array(h->s, all, "noise", r.noise, RADII))
        return EXIT_FAILED;
    page_heading(h->s->page, 3, "hsao-radius", "Effect of the radius");
    draw_radii(h, &r);
    claim_radii(h, &r);
    return show_radii(h);
}
