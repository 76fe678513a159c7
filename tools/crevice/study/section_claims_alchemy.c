/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "claims_alchemy.h"
#include "claims_measure.h"
#include "sections.h"

/* Rounds of a timing, and draws of the noise that an error is averaged over. */
enum { ROUNDS = 5, DRAWS = 2 };
enum { PLATFORMS = 5 };

/* The projected radius of a pixel of the picture, px. */
static double radius_px_at(const study_view *v, const scene_gbuffer *g, int32_t x,
                           int32_t y)
{
    size_t row = (size_t)(y + g->desc.guard_top);
    double d =
        (double)
            g->depth[0][row * (size_t)g->desc.width + (size_t)(x + g->desc.guard_left)];
    double unit = g->camera.projection == CRV_ORTHOGRAPHIC ? 1.0 : d;

    return (double)v->radius * (double)g->camera.fy_px / unit;
}

/* The projected radius, px, that a tenth of the view's surfaces exceed: those near by get
 * all samples. */
static int near_radius_px(study *s, study_view *v, float *out)
{
    enum { BINS = 4096 };
    const scene_gbuffer *g;
    int64_t bins[BINS] = {0}, above = 0;
    int bin = BINS - 1, result = study_gbuffer(s, v, STUDY_ONE_LAYER, &g);

    if (result != EXIT_DONE)
        return result;
    for (int32_t y = 0; y < v->height; y++) {
        for (int32_t x = 0; x < v->width; x++) {
            if (v->mask[(size_t)y * (size_t)v->width + (size_t)x] != 0)
                bins[(int)fmin(radius_px_at(v, g, x, y), BINS - 1)]++;
        }
    }
    for (; bin > 1 && above + bins[bin] < v->pixels / 10; bin--)
        above += bins[bin];
    *out = (float)bin;
    return EXIT_DONE;
}

/* Figure 5: the same picture with all samples, in bands, and with the number of samples
 * everywhere that the bands take in the mean. */
enum { ALL, BANDED, EQUAL, SPENDINGS };

/* The samples that a pixel takes, in the mean: those of a band are told by the projected
 * radius as the option's help says. */
static int mean_samples(study *s, study_view *v, const crv_options *o, double *out)
{
    const scene_gbuffer *g;
    double sum = 0.0;
    int result = study_gbuffer(s, v, STUDY_ONE_LAYER, &g);

    if (result != EXIT_DONE)
        return result;
    for (int32_t y = 0; y < v->height; y++) {
        for (int32_t x = 0; x < v->width; x++) {
            double band = ceil(o->bands * radius_px_at(v, g, x, y) / (double)o->band_px);

            if (v->mask[(size_t)y * (size_t)v->width + (size_t)x] != 0)
                sum += o->samples * fmin(fmax(band, 1.0), o->bands) / o->bands;
        }
    }
    *out = v->pixels > 0 ? sum / (double)v->pixels : o->samples;
    return EXIT_DONE;
}

typedef struct spending {
    double samples, ms, noise;
} spending;

static int measure_bands(study *s, study_view *v, float band_px, const float *limit,
                         spending out[SPENDINGS])
{
    crv_options options[SPENDINGS];
    double ms[SPENDINGS];
    int result;

    for (int i = 0; i < SPENDINGS; i++) {
        options[i] = claims_twelve_samples(v);
        options[i].filter = NULL;
        out[i].samples = 12;
    }
    options[BANDED].bands = 3;
    options[BANDED].band_px = band_px;
    result = mean_samples(s, v, &options[BANDED], &out[BANDED].samples);
    options[EQUAL].samples = (int32_t)lround(fmax(1.0, out[BANDED].samples));
    out[EQUAL].samples = options[EQUAL].samples;
    for (int i = 0; i < SPENDINGS && result == EXIT_DONE; i++)
        result = measure_error(s, v, &options[i], limit, 2 * DRAWS, &out[i].noise);
    if (result == EXIT_DONE)
        result = measure_times(s, v, options, SPENDINGS, ROUNDS, ms);
    for (int i = 0; i < SPENDINGS && result == EXIT_DONE; i++)
        out[i].ms = ms[i];
    return result;
}

static void write_bands(study *s, float band_px, const spending of[SPENDINGS])
{
    static const char *const names[] = {"12 samples everywhere", "3 bands of 4 samples",
                                        "the mean of the bands everywhere"};
    static const char *const headers[] = {"samples", "mean for a pixel", "time, ms",
                                          "noise"};
    bool is_faster = of[BANDED].ms < 0.95 * of[ALL].ms;
    bool is_better = of[BANDED].noise < 1.02 * of[EQUAL].noise;
    char measured[512];

    page_table_begin(s->page, "Bands, unfiltered. Noise: RMS distance from 512 samples.",
                     headers, 4);
    for (int i = 0; i < SPENDINGS; i++) {
        page_cell(s->page, "%s", names[i]);
        page_cell(s->page, "%.1f", of[i].samples);
        page_cell(s->page, "%.2f", of[i].ms);
        page_cell(s->page, "%.4f", of[i].noise);
    }
    page_table_end(s->page);
    snprintf(
        measured, sizeof measured,
        "3 bands, all samples from %.0f px of projected radius on: %.2f ms against "
        "%.2f ms; noise %.4f against %.4f. The same %.1f samples in the mean, spread "
        "evenly: %.2f ms, noise %.4f.",
        (double)band_px, of[BANDED].ms, of[ALL].ms, of[BANDED].noise, of[ALL].noise,
        of[BANDED].samples, of[EQUAL].ms, of[EQUAL].noise);
    /* 5 % of time are beyond the noise of medians; 2 % of error beyond that of draws. */
    measure_claim(
        s,
        (page_claim){.paper = "2011, Figure 5",
                     .statement = "Fewer samples where the projected radius is small "
                                  "save time at little loss.",
                     .verdict = is_faster && is_better   ? PAGE_HOLDS
                                : is_faster || is_better ? PAGE_PARTLY
                                                         : PAGE_FAILS,
                     .measured = measured,
                     .reason = "In units of the radius there is as much to see far "
                               "away as near by. And the first samples of a set, which "
                               "a band takes, are spread less evenly than a set made "
                               "for so few."});
}

/* Table 1: samples in each band and the number of bands on the paper's five machines. */
static int write_platforms(study *s, study_view *v, float band_px, const float *filtered,
                           cJSON *to)
{
    static const int32_t in_band[PLATFORMS] = {3, 4, 4, 3, 2};
    static const int32_t bands[PLATFORMS] = {1, 1, 3, 3, 3};
    static const char *const headers[] = {"samples in a band", "bands", "time, ms",
                                          "noise, filtered"};
    crv_options options[PLATFORMS];
    double ms[PLATFORMS], noise[PLATFORMS];
    int result = EXIT_DONE;

    for (int i = 0; i < PLATFORMS && result == EXIT_DONE; i++) {
        options[i] = claims_twelve_samples(v);
        options[i].samples = in_band[i] * bands[i];
        options[i].bands = bands[i];
        options[i].band_px = band_px;
        result = measure_error(s, v, &options[i], filtered, DRAWS, &noise[i]);
    }
    if (result == EXIT_DONE)
        result = measure_times(s, v, options, PLATFORMS, ROUNDS, ms);
    if (result != EXIT_DONE)
        return result;
    page_table_begin(s->page,
                     "The five settings of the paper's Table 1 with the filter "
                     "bilateral13, all on this machine. Noise: RMS distance from 512 "
                     "samples through the same filter.",
                     headers, 4);
    for (int i = 0; i < PLATFORMS; i++) {
        page_cell(s->page, "%d", in_band[i]);
        page_cell(s->page, "%d", bands[i]);
        page_cell(s->page, "%.2f", ms[i]);
        page_cell(s->page, "%.4f", noise[i]);
    }
    page_table_end(s->page);
    return measure_array(s, to, "table_1_ms", ms, PLATFORMS)
                   && measure_array(s, to, "table_1_noise", noise, PLATFORMS)
               ? EXIT_DONE
               : EXIT_FAILED;
}

/* Figure 6. filtered: the limit through the filter. */
static int write_filter(study *s, study_view *v, const float *limit,
                        const float *filtered, cJSON *to)
{
    crv_options both[2] = {claims_twelve_samples(v), claims_twelve_samples(v)};
    double raw = 0.0, noise = 0.0, all = 0.0, ms[2];
    char measured[512];
    metrics blur;
    int result = study_compare(s, v, filtered, limit, &blur);

    both[0].filter = NULL;
    if (result == EXIT_DONE)
        result = measure_error(s, v, &both[0], limit, DRAWS, &raw);
    if (result == EXIT_DONE)
        result = measure_error(s, v, &both[1], filtered, DRAWS, &noise);
    if (result == EXIT_DONE)
        result = measure_error(s, v, &both[1], limit, DRAWS, &all);
    if (result == EXIT_DONE)
        result = measure_times(s, v, both, 2, ROUNDS, ms);
    if (result != EXIT_DONE)
        return result;
    snprintf(
        measured, sizeof measured,
        "RMS noise of 12 samples %.4f, filtered %.4f (against 512 samples through the "
        "same filter). The filter blurs those by %.4f; noise and blur together are "
        "%.4f. Time %.2f ms and %.2f ms.",
        raw, noise, blur.rmse, all, ms[0], ms[1]);
    measure_claim(
        s,
        (page_claim){.paper = "2011, Figure 6",
                     .statement = "Two passes of a 13-tap cross-bilateral filter "
                                  "make a usable picture of 12 samples.",
                     /* "Usable" as half of the noise, and blur that leaves a gain. */
                     .verdict = noise <= 0.5 * raw && all < 0.98 * raw ? PAGE_HOLDS
                                : noise <= 0.5 * raw                   ? PAGE_PARTLY
                                                                       : PAGE_FAILS,
                     .measured = measured,
                     .reason = "The noise goes, and detail with it: the filter keeps "
                               "edges of depth, but not those of the occlusion itself, "
                               "where that changes within its 13 taps."});
    study_add_number(to, "filter_noise_before", raw);
    study_add_number(to, "filter_noise_after", noise);
    study_add_number(to, "filter_blur", blur.rmse);
    study_add_number(to, "filter_error", all);
    return EXIT_DONE;
}

static int write_spending(study *s, const spending of[SPENDINGS], cJSON *to)
{
    static const char *const names[] = {"all", "banded", "equal"};

    for (int i = 0; i < SPENDINGS; i++) {
        cJSON *one = measure_object(s, to, names[i]);

        if (one == NULL)
            return EXIT_FAILED;
        study_add_number(one, "samples", of[i].samples);
        study_add_number(one, "ms", of[i].ms);
        study_add_number(one, "noise", of[i].noise);
    }
    return EXIT_DONE;
}

static int write_samples(study *s, study_view *v, float band_px, cJSON *to)
{
    crv_options options = claims_twelve_samples(v), much = measure_much(&options, 512);
    spending spent[SPENDINGS] = {{0}};
    cJSON *json = measure_object(s, to, "bands");
    float *limit = NULL, *filtered = NULL;
    int result;

    if (json == NULL)
        return EXIT_FAILED;
    study_progress(s, "alchemy: bands and filter");
    result = measure_picture(s, v, &much, &limit);
    if (result == EXIT_DONE)
        result = measure_bands(s, v, band_px, limit, spent);
    if (result == EXIT_DONE) {
        page_heading(s->page, 3, "alchemy-bands", "Levels of detail and the filter");
        write_bands(s, band_px, spent);
        result = write_spending(s, spent, json);
    }
    filtered = malloc((size_t)v->width * (size_t)v->height * sizeof *filtered);
    if (result == EXIT_DONE && filtered == NULL)
        result = report_no_memory(s->r);
    if (result == EXIT_DONE)
        result = study_filter(s, v, &options, limit, filtered);
    if (result == EXIT_DONE)
        result = write_platforms(s, v, band_px, filtered, json);
    if (result == EXIT_DONE)
        result = write_filter(s, v, limit, filtered, json);
    free(limit);
    free(filtered);
    return result;
}

int study_claims_alchemy(study *s)
{
    cJSON *json = measure_object(s, s->results, "alchemy");
    float band_px = 0;
    int result;

    if (json == NULL)
        return EXIT_FAILED;
    page_heading(s->page, 2, "alchemy", "McGuire et al. 2011: Alchemy obscurance");
    page_text(s->page,
              "Measured on the view %s at %dx%d with R = %.3g. Times are medians of %d "
              "rounds in which all that is compared takes its turn.",
              s->main->name, s->main->width, s->main->height, (double)s->main->radius,
              ROUNDS);
    result = near_radius_px(s, s->main, &band_px);
    if (result == EXIT_DONE)
        result = claims_equal_time(s, json);
    if (result == EXIT_DONE)
        result = claims_radius(s, band_px, json);
    if (result == EXIT_DONE)
        result = write_samples(s, s->main, band_px, json);
    if (result == EXIT_DONE)
        result = claims_multisample(s, json);
    return result;
}
