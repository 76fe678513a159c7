/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>

#include "claims_alchemy.h"
#include "claims_measure.h"

/* Rounds of a timing, and draws of the noise that an error is averaged over. */
enum { ROUNDS = 5, DRAWS = 2 };
enum { RADII = 5 };

crv_options claims_twelve_samples(const study_view *v)
{
    crv_options o = study_options(v, "alchemy", CRV_PRESET_MEDIUM);

    o.samples = 12;
    o.bands = 1;
    return o;
}

/* Figures 8 and 9. */
typedef struct over_radius {
    double factor[RADII];
    double ms[RADII], banded_ms[RADII];
    double noise[RADII]; /* RMS distance from the limit of many samples */
} over_radius;

static int measure_radii(study *s, study_view *v, float band_px, over_radius *out)
{
    crv_options options[2 * RADII];
    double ms[2 * RADII];
    int result = EXIT_DONE;

    for (int i = 0; i < RADII; i++) {
        crv_options *o = &options[i], much;
        float *limit = NULL;

        out->factor[i] = 0.25 * (1 << i);
        *o = claims_twelve_samples(v);
        o->filter = NULL;
        o->radius = (float)((double)v->radius * out->factor[i]);
        much = measure_much(o, 384);
        result = measure_picture(s, v, &much, &limit);
        if (result == EXIT_DONE)
            result = measure_error(s, v, o, limit, DRAWS, &out->noise[i]);
        free(limit);
        if (result != EXIT_DONE)
            return result;
        options[RADII + i] = *o;
        options[RADII + i].bands = 3;
        options[RADII + i].band_px = band_px;
    }
    result = measure_times(s, v, options, 2 * RADII, ROUNDS, ms);
    for (int i = 0; i < RADII; i++) {
        out->ms[i] = ms[i];
        out->banded_ms[i] = ms[RADII + i];
    }
    return result;
}

static void plot_radii(study *s, const study_view *v, const over_radius *o)
{
    double radius[RADII], linear[RADII];
    for (int i = 0; i < RADII; i++) {
        radius[i] = (double)v->radius * o->factor[i];
        linear[i] = o->ms[0] * o->factor[i] / o->factor[0];
    }
    plot_series times[] = {
        {.name = "12 samples", .x = radius, .y = o->ms, .count = RADII, .is_line = true},
        {.name = "12 samples in 3 bands",
         .x = radius,
         .y = o->banded_ms,
         .count = RADII,
         .is_line = true},
        {.name = "in proportion to R",
         .x = radius,
         .y = linear,
         .count = 2,
         .is_line = true,
         .is_guide = true}};
    plot_series noise = {.name = "12 samples",
                         .x = radius,
                         .y = o->noise,
                         .count = RADII,
                         .is_line = true};

    page_plot(s->page, &(plot){.caption = "Time of alchemy over the radius, unfiltered. "
                                          "The dashed line grows as the radius does.",
                               .x_title = "radius R, scene units",
                               .y_title = "time, ms",
                               .log_x = true,
                               .y_from_zero = true,
                               .series = times,
                               .series_count = 3});
    page_plot(s->page, &(plot){.caption = "Noise of alchemy with 12 samples over the "
                                          "radius: RMS distance from 384 samples.",
                               .x_title = "radius R, scene units",
                               .y_title = "RMS error",
                               .log_x = true,
                               .y_from_zero = true,
                               .series = &noise,
                               .series_count = 1});
}

static void claim_radii(study *s, const over_radius *o)
{
    double slope = measure_slope(o->factor, o->ms, RADII);
    double growth = o->ms[RADII - 1] / o->ms[0];
    char measured[512];

    snprintf(measured, sizeof measured,
             "From a quarter of the view's radius to four times of it, time grows from "
             "%.2f ms to %.2f ms, %.2f times: as R to the power of %.2f.",
             o->ms[0], o->ms[RADII - 1], growth, slope);
    /* A slope of 0.1 is what a busy machine does to a median. */
    measure_claim(
        s,
        (page_claim){.paper = "2011, Figure 9",
                     .statement = "Larger radii read farther apart and miss caches; "
                                  "time grows at most about linearly, not as the "
                                  "square of the radius.",
                     .verdict = slope <= 1.1   ? PAGE_HOLDS
                                : slope <= 1.6 ? PAGE_PARTLY
                                               : PAGE_FAILS,
                     .measured = measured,
                     .reason = "The buffers do not fit the caches, so that far samples "
                               "wait for memory."});
    snprintf(measured, sizeof measured,
             "RMS noise of 12 samples at a quarter of the radius %.4f, at the radius "
             "%.4f, at four times of it %.4f.",
             o->noise[0], o->noise[2], o->noise[RADII - 1]);
    measure_claim(
        s, (page_claim){
               .paper = "2011, Figure 8",
               .statement = "At the same number of samples a larger radius costs "
                            "sharpness: the variance grows.",
               .verdict = o->noise[0] < 0.98 * o->noise[2]
                                  && o->noise[2] < 0.98 * o->noise[RADII - 1]
                              ? PAGE_HOLDS
                          : o->noise[0] < 0.98 * o->noise[RADII - 1] ? PAGE_PARTLY
                                                                     : PAGE_FAILS,
               .measured = measured,
               .reason = "Where most of the view is dark and clamped at 0, there is "
                         "little left to vary."});
}

int claims_radius(study *s, float band_px, cJSON *to)
{
    study_view *v = s->main;
    over_radius o;
    cJSON *json = measure_object(s, to, "radius");
    int result;

    if (json == NULL)
        return EXIT_FAILED;
    study_progress(s, "alchemy: cost over radius");
    result = measure_radii(s, v, band_px, &o);
    if (result != EXIT_DONE)
        return result;
    page_heading(s->page, 3, "alchemy-radius", "Cost and noise over the radius");
    plot_radii(s, v, &o);
    claim_radii(s, &o);
    return measure_array(s, json, "factor", o.factor, RADII)
                   && measure_array(s, json, "ms", o.ms, RADII)
                   && measure_array(s, json, "banded_ms", o.banded_ms, RADII)
                   && measure_array(s, json, "noise", o.noise, RADII)
               ? EXIT_DONE
               : EXIT_FAILED;
}
