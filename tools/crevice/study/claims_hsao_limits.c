/* SPDX-License-Identifier: MIT */
/* claims_hsao_limits.c: what the horizon leaves to the normal rays (2008a, Figures 1 and
 * 10), whether it is a lower bound, and what helps at depth discontinuities. */
#include <stdio.h>
#include <stdlib.h>

#include "claims_horizon.h"

typedef struct parts {
    metrics alone, whole;
    double share;   /* of the occlusion that the horizon finds */
    double over;    /* share of pixels that the horizon alone makes too dark */
    double over_by; /* and by how much on average there */
} parts;

/* An error that the noise of neither picture explains. */
static const double OVER = 0.03;

static void count_over(const horizon_study *h, const float *alone, parts *out)
{
    size_t pixels = (size_t)h->v->width * (size_t)h->v->height;
    double count = 0.0, sum = 0.0;

    for (size_t k = 0; k < pixels; k++) {
        double by = (double)h->truth[k] - (double)alone[k];

        if (h->v->mask[k] && by > OVER) {
            count++;
            sum += by;
        }
    }
    out->over = h->v->pixels > 0 ? count / (double)h->v->pixels : 0.0;
    out->over_by = count > 0 ? sum / count : 0.0;
}

static int show_parts(const horizon_study *h, const float *alone, const float *whole)
{
    size_t pixels = (size_t)h->v->width * (size_t)h->v->height;
    float *normal = malloc(pixels * sizeof *normal);
    int result = normal != NULL ? EXIT_DONE : report_no_memory(h->s->r);

    for (size_t k = 0; normal != NULL && k < pixels; k++) {
        float a = 1 - (alone[k] - whole[k]);

        normal[k] = a < 0 ? 0 : a > 1 ? 1 : a;
    }
    page_grid_begin(h->s->page);
    if (result == EXIT_DONE)
        result = horizon_show(h, "hsao-part-horizon", alone, "horizon occlusion");
    if (result == EXIT_DONE)
        result = horizon_show(h, "hsao-part-normal", normal, "normal occlusion");
    if (result == EXIT_DONE)
        result = horizon_show(h, "hsao-part-both", whole, "both");
    if (result == EXIT_DONE)
        result = horizon_show(h, "hsao-part-truth", h->truth, "ray traced");
    page_grid_end(h->s->page);
    free(normal);
    return result;
}

static void claim_parts(const horizon_study *h, const parts *p)
{
    char text[480];

    snprintf(
        text, sizeof text,
        "The horizon finds %.0f %% of the occlusion that hsao finds with normal rays "
        "on this view. Alone it has an RMSE of %.4f and a mean error of %+.4f; "
        "with normal rays %.4f and %+.4f.",
        100 * p->share, p->alone.rmse, p->alone.bias, p->whole.rmse, p->whole.bias);
    measure_claim(
        h->s,
        (page_claim){
            .paper = "2008a, Figures 1 and 10",
            .statement = "The horizon term dominates, so that the normal rays can "
                         "be left out.",
            /* Dominates: more than half. Can be left out: a tenth more error at
             * most. */
            .verdict = p->share > 0.5 && p->alone.rmse < 1.1 * p->whole.rmse ? PAGE_HOLDS
                       : p->share > 0.5 || p->alone.rmse < 1.1 * p->whole.rmse
                           ? PAGE_PARTLY
                           : PAGE_FAILS,
            .measured = text,
            .reason = "The paper says it of single objects with relief. Here "
                      "things stand on and over others, and reach into the hemisphere "
                      "from above the horizon."});
}

static void claim_bound(const horizon_study *h, const parts *p)
{
    char text[320];

    snprintf(
        text, sizeof text,
        "The horizon alone is darker than ray tracing by more than %.2f at %.1f %% of "
        "the pixels, there by %.3f on average.",
        OVER, 100 * p->over, p->over_by);
    measure_claim(
        h->s,
        (page_claim){.paper = "2008a, section 1",
                     .statement = "Horizon occlusion is a lower bound of the occlusion.",
                     /* A percent of pixels lies on edges, where a pixel is two surfaces
                      * at once. */
                     .verdict = p->over < 0.01  ? PAGE_HOLDS
                                : p->over < 0.1 ? PAGE_PARTLY
                                                : PAGE_FAILS,
                     .measured = text,
                     .reason = "It is a bound for a height field without gaps. At depth "
                               "discontinuities, which section 5 of the paper concedes, "
                               "everything below the horizon counts as blocked although "
                               "there may be nothing behind a thin occluder."});
}

static int part_contributions(const horizon_study *h)
{
    crv_options o = h->paper;
    float *alone = NULL, *whole = NULL;
    parts p = {0};
    int result;

    o.directions = 24;
    o.steps = 24;
    o.normal_rays = 2;
    study_progress(h->s, "claims, 2008a: what the horizon leaves out");
    result = horizon_run(h, &o, STUDY_ONE_LAYER, &p.whole, &whole);
    o.normal_rays = 0;
    if (result == EXIT_DONE)
        result = horizon_run(h, &o, STUDY_ONE_LAYER, &p.alone, &alone);
    if (result == EXIT_DONE) {
        p.share = (1 - p.alone.mean_a) / (1 - p.whole.mean_a);
        count_over(h, alone, &p);
        page_heading(h->s->page, 3, "hsao-limits", "What the horizon leaves out");
        page_text(h->s->page,
                  "Figure 10 of 2008a on this view: `directions=24 steps=24`, "
                  "with `normal_rays=0` and `normal_rays=2`.");
        result = show_parts(h, alone, whole);
    }
    free(alone);
    free(whole);
    if (result == EXIT_DONE
        && (!horizon_number(h, h->json, "horizon_share", p.share)
            || !horizon_number(h, h->json, "horizon_rmse", p.alone.rmse)
            || !horizon_number(h, h->json, "with_normal_rays_rmse", p.whole.rmse)
            || !horizon_number(h, h->json, "horizon_too_dark_share", p.over)))
        result = EXIT_FAILED;
    if (result == EXIT_DONE) {
        claim_parts(h, &p);
        claim_bound(h, &p);
    }
    return result;
}

int hsao_limits(const horizon_study *h)
{
    crv_options o = h->paper;
    int result = part_contributions(h);

    if (result != EXIT_DONE)
        return result;
    o.directions = 12;
    page_heading(h->s->page, 3, "hsao-layers", "Depth discontinuities");
    return horizon_layers(h, &o, "2008a, section 5",
                          "Two depth layers, fronts and backs, improve the accuracy.");
}
