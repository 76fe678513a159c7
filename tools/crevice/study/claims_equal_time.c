/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "claims_alchemy.h"
#include "claims_measure.h"

/* Rounds of a timing: the median of five survives two that were disturbed. */
enum { ROUNDS = 5 };

enum { ALCHEMY, VO, HBAO, HBAO_FULL, RIVALS };

typedef struct rival {
    const char *id;
    char label[48];
    crv_options options;
    float *picture, *linear; /* at intensity 1 and MEASURE_LINEAR */
    const float *truth;      /* of its own integral */
    measure_fitted own, cosine, obscurance;
    double ms;
    double noise; /* RMS distance from its own limit, unfiltered */
    /* Darkness beside silhouettes as a share of that in corners, here and in its truth,
     * at the best intensity for the cosine truth. */
    double spill, truth_spill;
    double corners; /* RMS error there, likewise */
} rival;

typedef struct contest {
    study *s;
    study_view *v;
    rival rivals[RIVALS];
    const float *cosine, *obscurance; /* the common truths */
    uint8_t *beside, *corners;
    int64_t beside_count, corner_count;
} contest;

static const study_target cosine_linear = {.weighting = CRV_WEIGHTING_COSINE,
                                           .falloff = CRV_FALLOFF_LINEAR,
                                           .tau = 3,
                                           .u = 0.1f};
static const study_target cosine_alchemy = {.weighting = CRV_WEIGHTING_COSINE,
                                            .falloff = CRV_FALLOFF_ALCHEMY,
                                            .tau = 3,
                                            .u = 0.1f};

/* Settings of rising cost. */
typedef crv_options rung_fn(const study_view *v, int32_t rung);

static crv_options vo_rung(const study_view *v, int32_t rung)
{
    crv_options o = study_options(v, "vo", CRV_PRESET_MEDIUM);

    o.samples = 2 * (rung + 1); /* they come in pairs */
    return o;
}

static crv_options hbao_rung(const study_view *v, int32_t rung)
{
    crv_options o = study_options(v, "hbao", CRV_PRESET_MEDIUM);

    o.directions = 2 + (rung + 1) / 2;
    o.steps = 2 + rung / 2;
    return o;
}

/* How much longer the second takes than the first. */
static int time_ratio(study *s, study_view *v, const crv_options *first,
                      const crv_options *second, double *ratio)
{
    crv_options both[2] = {*first, *second};
    double ms[2];
    int result = measure_fastest(s, v, both, 2, ROUNDS, ms);

    *ratio = ms[0] > 0.0 ? ms[1] / ms[0] : 1.0;
    return result;
}

/* The rung whose time is nearest to that of `base`, by bisection. */
static int choose_rung(study *s, study_view *v, const crv_options *base, rung_fn *rung,
                       int32_t count, int32_t *out)
{
    int32_t low = 0, high = count - 1;
    double low_ratio = 0.0, high_ratio = INFINITY;

    while (low < high) {
        int32_t middle = (low + high) / 2;
        crv_options options = rung(v, middle);
        double ratio;
        int result = time_ratio(s, v, base, &options, &ratio);

        if (result != EXIT_DONE)
            return result;
        if (ratio < 1.0) {
            low = middle + 1;
            low_ratio = ratio;
        } else {
            high = middle;
            high_ratio = ratio;
        }
    }
    /* low is the first that takes longer; the one before may be nearer. */
    *out = low > 0 && 1.0 - low_ratio < high_ratio - 1.0 ? low - 1 : low;
    return EXIT_DONE;
}

/* On a quarter of the pixels: ratios are the same, and the search is four times as fast.
 */
static int choose_settings(contest *c)
{
    const study_view *v = c->v;
    crv_options base = study_options(v, "alchemy", CRV_PRESET_MEDIUM);
    study_view half;
    int32_t vo = 0, hbao = 0;
    int result = study_view_resized(c->s, v, v->width > 1 ? v->width / 2 : 1,
                                    v->height > 1 ? v->height / 2 : 1, &half);

    base.samples = 12;
    if (result != EXIT_DONE)
        return result;
    result = choose_rung(c->s, &half, &base, vo_rung, 48, &vo);
    if (result == EXIT_DONE)
        result = choose_rung(c->s, &half, &base, hbao_rung, 21, &hbao);
    study_view_free(&half);
    c->rivals[ALCHEMY] = (rival){.id = "alchemy", .options = base};
    c->rivals[VO] = (rival){.id = "vo", .options = vo_rung(v, vo)};
    c->rivals[HBAO] = (rival){.id = "hbao", .options = hbao_rung(v, hbao)};
    c->rivals[HBAO_FULL] = (rival){
        .id = "hbao-full", .options = study_options(v, "hbao", CRV_PRESET_MEDIUM)};
    c->rivals[HBAO_FULL].options.directions = 8;
    c->rivals[HBAO_FULL].options.steps = 8;
    for (int i = 0; i < RIVALS; i++) {
        const crv_options *o = &c->rivals[i].options;

        if (i == HBAO || i == HBAO_FULL)
            snprintf(c->rivals[i].label, sizeof c->rivals[i].label, "hbao, %dx%d",
                     o->directions, o->steps);
        else
            snprintf(c->rivals[i].label, sizeof c->rivals[i].label, "%s, %d samples",
                     c->rivals[i].id, o->samples);
    }
    return result;
}

/* The mean of a picture over a mask. */
static double mean_over(const float *picture, const uint8_t *mask, size_t count)
{
    double sum = 0.0, used = 0.0;

    for (size_t i = 0; i < count; i++) {
        if (mask[i] != 0) {
            sum += (double)picture[i];
            used += 1.0;
        }
    }
    return sum / used;
}

/* The RMS error over a mask at the intensity that suits the cosine truth best. */
static double error_over(const rival *r, const float *truth, const uint8_t *mask,
                         size_t count)
{
    double sum = 0.0, used = 0.0;

    for (size_t i = 0; i < count; i++) {
        if (mask[i] != 0) {
            double a = (double)measure_at_intensity(r->cosine.intensity, r->linear[i]);

            sum += (a - (double)truth[i]) * (a - (double)truth[i]);
            used += 1.0;
        }
    }
    return sqrt(sum / used);
}

/* Open pixels beside silhouettes, and the darkest corners, both by the cosine truth. */
static int find_places(contest *c)
{
    const study_view *v = c->v;
    size_t count = (size_t)v->width * (size_t)v->height;
    int result = claims_silhouettes(c->s, c->v, &c->beside);

    if (result != EXIT_DONE)
        return result;
    c->corners = calloc(count, 1);
    if (c->corners == NULL)
        return report_no_memory(c->s->r);
    for (size_t i = 0; i < count; i++) {
        if (v->mask[i] == 0)
            continue;
        c->beside[i] = c->beside[i] != 0 && c->cosine[i] > 0.9f;
        c->corners[i] = c->cosine[i] < 0.5f;
        c->beside_count += c->beside[i];
        c->corner_count += c->corners[i];
    }
    return EXIT_DONE;
}

static int measure_noise(contest *c, rival *r)
{
    crv_options much = measure_much(&r->options, 512), bare = r->options;
    float *limit = NULL;
    int result = measure_picture(c->s, c->v, &much, &limit);

    bare.filter = NULL;
    if (result == EXIT_DONE)
        result = measure_error(c->s, c->v, &bare, limit, 2, &r->noise);
    free(limit);
    return result;
}

static int measure_rival(contest *c, rival *r)
{
    const study_target target = study_target_of(&r->options);
    size_t count = (size_t)c->v->width * (size_t)c->v->height;
    crv_options linear = r->options;
    int result =
        study_reference(c->s, c->v, &target, REFERENCE_FULL, STUDY_ONE_LAYER, &r->truth);

    if (result == EXIT_DONE)
        result = measure_picture(c->s, c->v, &r->options, &r->picture);
    linear.intensity = MEASURE_LINEAR;
    if (result == EXIT_DONE)
        result = measure_picture(c->s, c->v, &linear, &r->linear);
    if (result == EXIT_DONE)
        result = measure_fit(c->s, c->v, r->picture, r->linear, r->truth, &r->own);
    if (result == EXIT_DONE)
        result = measure_fit(c->s, c->v, r->picture, r->linear, c->cosine, &r->cosine);
    if (result == EXIT_DONE)
        result =
            measure_fit(c->s, c->v, r->picture, r->linear, c->obscurance, &r->obscurance);
    if (result == EXIT_DONE)
        result = measure_noise(c, r);
    if (result != EXIT_DONE)
        return result;
    r->spill = (1.0 - mean_over(r->linear, c->beside, count))
               / (1.0 - mean_over(r->linear, c->corners, count));
    r->truth_spill = (1.0 - mean_over(r->truth, c->beside, count))
                     / (1.0 - mean_over(r->truth, c->corners, count));
    r->corners = error_over(r, c->cosine, c->corners, count);
    return EXIT_DONE;
}

static int measure_all(contest *c)
{
    crv_options options[RIVALS];
    double ms[RIVALS];
    int result = study_reference(c->s, c->v, &cosine_linear, REFERENCE_FULL,
                                 STUDY_ONE_LAYER, &c->cosine);

    if (result == EXIT_DONE)
        result = study_reference(c->s, c->v, &cosine_alchemy, REFERENCE_FULL,
                                 STUDY_ONE_LAYER, &c->obscurance);
    if (result == EXIT_DONE)
        result = find_places(c);
    if (result == EXIT_DONE)
        result = choose_settings(c);
    for (int i = 0; i < RIVALS && result == EXIT_DONE; i++) {
        options[i] = c->rivals[i].options;
        result = measure_rival(c, &c->rivals[i]);
    }
    if (result == EXIT_DONE)
        result = measure_times(c->s, c->v, options, RIVALS, ROUNDS, ms);
    for (int i = 0; i < RIVALS && result == EXIT_DONE; i++)
        c->rivals[i].ms = ms[i];
    return result;
}

static void write_table(const contest *c)
{
    static const char *const headers[] = {"method", "ms",      "times", "RMSE", "fitted",
                                          "linear", "alchemy", "SSIM",  "noise"};
    page *p = c->s->page;

    page_table_begin(p, "Alchemy, VO and HBAO, each filtered with bilateral13.", headers,
                     9);
    for (int i = 0; i < RIVALS; i++) {
        const rival *r = &c->rivals[i];

        page_cell(p, "%s", r->label);
        page_cell(p, "%.1f", r->ms);
        page_cell(p, "%.2f", r->ms / c->rivals[ALCHEMY].ms);
        page_cell(p, "%.4f", r->own.rmse);
        page_cell(p, "%.4f", r->own.fitted_rmse);
        page_cell(p, "%.4f", r->cosine.fitted_rmse);
        page_cell(p, "%.4f", r->obscurance.fitted_rmse);
        page_cell(p, "%.3f", r->own.ssim);
        page_cell(p, "%.4f", r->noise);
    }
    page_table_end(p);
}

/* The pictures at their best intensity towards the cosine truth, since the
 * methods' own strengths differ. */
static int write_pictures(const contest *c)
{
    const study_view *v = c->v;
    size_t count = (size_t)v->width * (size_t)v->height;
    float *fitted = malloc(count * sizeof *fitted);
    page *p = c->s->page;

    if (fitted == NULL)
        return report_no_memory(c->s->r);
    page_grid_begin(p);
    for (int i = 0; i < HBAO_FULL; i++) {
        const rival *r = &c->rivals[i];
        char name[64], caption[160];

        for (size_t k = 0; k < count; k++)
            fitted[k] = v->mask[k] != 0
                            ? measure_at_intensity(r->cosine.intensity, r->linear[k])
                            : 1.0f;
        snprintf(name, sizeof name, "alchemy-equal-%s", r->id);
        snprintf(caption, sizeof caption, "%s, at intensity %.2f", r->label,
                 r->cosine.intensity);
        page_picture(p, name, fitted, v->width, v->height, caption);
        snprintf(name, sizeof name, "alchemy-equal-%s-error", r->id);
        snprintf(caption, sizeof caption,
                 "%s: error; blue is too dark, orange too bright, full colour at 0.3",
                 r->label);
        page_error_map(p, name, fitted, c->cosine, v->mask, v->width, v->height, 0.3,
                       caption);
    }
    page_picture(p, "alchemy-equal-truth", c->cosine, v->width, v->height,
                 "ray-traced, cosine weighting, linear falloff");
    page_grid_end(p);
    free(fitted);
    return EXIT_DONE;
}

/* Differences under 2 % may come from the noise tile and the rays of the reference. */
static bool clearly_below(double a, double b)
{
    return a < 0.98 * b;
}

static void claim_error(const contest *c)
{
    const rival *a = &c->rivals[ALCHEMY], *b = &c->rivals[VO];
    int wins = clearly_below(a->own.fitted_rmse, b->own.fitted_rmse)
               + clearly_below(a->cosine.fitted_rmse, b->cosine.fitted_rmse)
               + clearly_below(a->obscurance.fitted_rmse, b->obscurance.fitted_rmse);
    char measured[512];

    snprintf(measured, sizeof measured,
             "At %.1f ms (%s) and %.1f ms (%s) the fitted RMS error is %.4f against %.4f "
             "to each one's own truth, %.4f against %.4f to the cosine integral with "
             "linear falloff, %.4f against %.4f with alchemy's falloff.",
             a->ms, a->label, b->ms, b->label, a->own.fitted_rmse, b->own.fitted_rmse,
             a->cosine.fitted_rmse, b->cosine.fitted_rmse, a->obscurance.fitted_rmse,
             b->obscurance.fitted_rmse);
    measure_claim(
        c->s,
        (page_claim){.paper = "2011, Figure 10",
                     .statement = "At equal time Alchemy gives a better picture than "
                                  "volumetric obscurance.",
                     .verdict = wins == 3   ? PAGE_HOLDS
                                : wins == 0 ? PAGE_FAILS
                                            : PAGE_PARTLY,
                     .measured = measured,
                     .reason = "The paper judges by eye. By RMS error most pixels are "
                               "open surfaces with little noise, where a line sample, "
                               "which has no singular weight, does better."});
}

static void claim_silhouettes(const contest *c)
{
    const rival *a = &c->rivals[ALCHEMY], *b = &c->rivals[VO];
    double of_alchemy = a->spill - a->truth_spill, of_vo = b->spill - b->truth_spill;
    bool is_known = c->beside_count >= 100 && c->corner_count >= 100;
    char measured[512];

    if (is_known)
        snprintf(
            measured, sizeof measured,
            "On the %lld open pixels just behind an outline (cosine truth above 0.9) "
            "the mean darkness, as a share of that of the darkest corners, is %.3f "
            "for `alchemy` and %.3f for `vo`; their truths have %.3f and %.3f.",
            (long long)c->beside_count, a->spill, b->spill, a->truth_spill,
            b->truth_spill);
    else
        snprintf(measured, sizeof measured, "The view has too few such pixels to tell.");
    measure_claim(
        c->s,
        (page_claim){
            .paper = "2011, Figure 10 a, b",
            .statement = "Alchemy's darkness lies on surfaces; volumetric "
                         "obscurance also darkens what is far behind an outline.",
            /* Twice as much is what one sees; 0.05 of a corner's is not. */
            .verdict = !is_known                                  ? PAGE_NOT_MEASURED
                       : of_alchemy < 0.5 * of_vo && of_vo > 0.05 ? PAGE_HOLDS
                       : clearly_below(of_alchemy, of_vo) && of_vo > 0.0 ? PAGE_PARTLY
                                                                         : PAGE_FAILS,
            .measured = measured,
            .reason = "What is nearer than the outline by less than the radius "
                      "darkens in both, and the filter carries darkness over "
                      "outlines in both."});
}

static void claim_cost_of_hbao(const contest *c)
{
    double ratio = c->rivals[HBAO_FULL].ms / c->rivals[ALCHEMY].ms;
    char measured[512];

    snprintf(measured, sizeof measured,
             "%s: %.1f ms; %s: %.1f ms, both with the filter: %.1f times as long.",
             c->rivals[HBAO_FULL].label, c->rivals[HBAO_FULL].ms,
             c->rivals[ALCHEMY].label, c->rivals[ALCHEMY].ms, ratio);
    measure_claim(
        c->s,
        (page_claim){.paper = "2011, Figure 11",
                     .statement = "HBAO takes about three times as long as Alchemy "
                                  "(8.5 ms against 2.6 ms).",
                     .verdict = ratio >= 2.5   ? PAGE_HOLDS
                                : ratio >= 1.2 ? PAGE_PARTLY
                                               : PAGE_FAILS,
                     .measured = measured,
                     .reason = "The times hold the filter, which costs both the same."});
}

static void claim_smoothness(const contest *c)
{
    const rival *a = &c->rivals[ALCHEMY], *b = &c->rivals[HBAO];
    bool is_smoother = clearly_below(b->noise, a->noise);
    bool is_finer = a->own.ssim > b->own.ssim;
    char measured[512];

    snprintf(
        measured, sizeof measured,
        "At equal time (%s: %.1f ms) the noise before the filter is %.4f for hbao and "
        "%.4f for alchemy; SSIM to its own truth is %.3f for hbao and %.3f for "
        "alchemy; the fitted RMS error %.4f and %.4f.",
        b->label, b->ms, b->noise, a->noise, b->own.ssim, a->own.ssim, b->own.fitted_rmse,
        a->own.fitted_rmse);
    measure_claim(
        c->s,
        (page_claim){.paper = "2011, Figure 11",
                     .statement = "HBAO is smoother, Alchemy keeps finer detail; here "
                                  "at equal time.",
                     .verdict = is_smoother && is_finer   ? PAGE_HOLDS
                                : is_smoother || is_finer ? PAGE_PARTLY
                                                          : PAGE_FAILS,
                     .measured = measured,
                     .reason = "The paper's HBAO runs at half resolution and is scaled "
                               "up; here both have every pixel, and the few directions "
                               "that this time buys."});
}

static int write_results(const contest *c, cJSON *to)
{
    cJSON *all = measure_object(c->s, to, "equal_time");

    for (int i = 0; i < RIVALS && all != NULL; i++) {
        const rival *r = &c->rivals[i];
        cJSON *one = measure_object(c->s, all, r->id);

        if (one == NULL)
            return EXIT_FAILED;
        cJSON_AddStringToObject(one, "settings", r->label);
        study_add_number(one, "ms", r->ms);
        study_add_number(one, "rmse", r->own.rmse);
        study_add_number(one, "fitted_rmse", r->own.fitted_rmse);
        study_add_number(one, "fitted_rmse_cosine_linear", r->cosine.fitted_rmse);
        study_add_number(one, "fitted_rmse_cosine_alchemy", r->obscurance.fitted_rmse);
        study_add_number(one, "ssim", r->own.ssim);
        study_add_number(one, "noise", r->noise);
        study_add_number(one, "best_intensity", r->own.intensity);
        study_add_number(one, "best_intensity_rmse", r->own.intensity_rmse);
        study_add_number(one, "spill_beside_silhouettes", r->spill);
        study_add_number(one, "spill_of_truth", r->truth_spill);
        study_add_number(one, "rmse_in_corners", r->corners);
    }
    return all != NULL ? EXIT_DONE : EXIT_FAILED;
}

static int write_all(const contest *c, cJSON *to)
{
    page *p = c->s->page;
    int result;

    page_heading(p, 3, "alchemy-equal-time", "Alchemy, VO and HBAO at equal time");
    page_text(
        p,
        "For `vo` and `hbao` the sample count was searched whose time, filter "
        "included, is nearest to that of `alchemy` with 12 samples. The last row is "
        "`hbao` at its usual settings, which takes longer. RMSE, the same at the best "
        "intensity and contrast (fitted), and SSIM are against its own truth: the "
        "ray-traced picture of the integral that it estimates. The columns linear and "
        "alchemy are fitted to a truth common to all: cosine weighting with these "
        "falloffs. Noise: unfiltered RMS distance from its own limit at many samples.");
    write_table(c);
    page_text(p,
              "In the darkest corners (the %lld pixels whose cosine truth is under 0.5) "
              "the RMS error at the best intensity is %.4f for `alchemy`, %.4f for `vo`, "
              "%.4f for `hbao`.",
              (long long)c->corner_count, c->rivals[ALCHEMY].corners,
              c->rivals[VO].corners, c->rivals[HBAO].corners);
    result = write_pictures(c);
    if (result != EXIT_DONE)
        return result;
    claim_error(c);
    claim_silhouettes(c);
    claim_cost_of_hbao(c);
    claim_smoothness(c);
    return write_results(c, to);
}

int claims_equal_time(study *s, cJSON *to)
{
    contest c = {.s = s, .v = s->main};
    int result;

    study_progress(s, "alchemy: equal time");
    result = measure_all(&c);
    if (result == EXIT_DONE)
        result = write_all(&c, to);
    for (int i = 0; i < RIVALS; i++) {
        free(c.rivals[i].picture);
        free(c.rivals[i].linear);
    }
    free(c.beside);
    free(c.corners);
    return result;
}
