/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "claims_measure.h"
#include "claims_vao.h"

/* n = 4, 8, ... 128. */
enum { COUNTS = 6, FIRST = 4 };

typedef struct sweep {
    const char *method;
    double n[COUNTS];
    /* RMS distance from the method's own limit: one sample set for all pixels, sixteen
     * rotations of it in a tile, and these joined by the 4x4 box. */
    double same[COUNTS], tile[COUNTS], joined[COUNTS];
    double joined_noise[COUNTS]; /* of the last, from the limit through the same box */
    double blur;                 /* what the box does to the limit */
    double truth[COUNTS];        /* of the joined picture, to the ray-traced truth */
    double gain;                 /* by how much interleaving multiplies 8 samples */
    double ms_raw, ms_joined;    /* at 8 samples */
} sweep;

/* Few samples depend on the draw; many cost more and depend less. */
static int32_t draws_of(int32_t n)
{
    return n <= 16 ? 4 : n <= 64 ? 2 : 1;
}

/* The tile's pictures, bare and joined, over the draws. */
static int measure_tile(study *s, study_view *v, const crv_options *options,
                        const float *limit, const float *boxed, const float *truth, int i,
                        sweep *out)
{
    size_t count = (size_t)v->width * (size_t)v->height;
    int32_t draws = draws_of(options->samples);
    double squares[4] = {0.0, 0.0, 0.0, 0.0};
    float *joined = malloc(count * sizeof *joined);
    int result = EXIT_DONE;

    if (joined == NULL)
        return report_no_memory(s->r);
    for (int32_t draw = 0; draw < draws && result == EXIT_DONE; draw++) {
        crv_options o = *options;
        float *picture = NULL;
        metrics m[4];

        o.seed += draw;
        result = measure_picture(s, v, &o, &picture);
        o.filter = crv_filter_find("box4");
        if (result == EXIT_DONE)
            result = study_filter(s, v, &o, picture, joined);
        if (result == EXIT_DONE)
            result = study_compare(s, v, picture, limit, &m[0]);
        if (result == EXIT_DONE)
            result = study_compare(s, v, joined, limit, &m[1]);
        if (result == EXIT_DONE)
            result = study_compare(s, v, joined, truth, &m[2]);
        if (result == EXIT_DONE)
            result = study_compare(s, v, joined, boxed, &m[3]);
        for (int k = 0; k < 4 && result == EXIT_DONE; k++)
            squares[k] += m[k].rmse * m[k].rmse / draws;
        free(picture);
    }
    out->tile[i] = sqrt(squares[0]);
    out->joined[i] = sqrt(squares[1]);
    out->truth[i] = sqrt(squares[2]);
    out->joined_noise[i] = sqrt(squares[3]);
    free(joined);
    return result;
}

/* The limit, and the limit through the box. Both free(), also after an error. */
static int measure_limits(study *s, study_view *v, sweep *out, float **limit,
                          float **boxed)
{
    crv_options o = measure_cubic(v, out->method, 8), much = measure_much(&o, 512);
    metrics m;
    int result = measure_picture(s, v, &much, limit);

    *boxed = malloc((size_t)v->width * (size_t)v->height * sizeof **boxed);
    if (result == EXIT_DONE && *boxed == NULL)
        result = report_no_memory(s->r);
    o.filter = crv_filter_find("box4");
    if (result == EXIT_DONE)
        result = study_filter(s, v, &o, *limit, *boxed);
    if (result == EXIT_DONE)
        result = study_compare(s, v, *boxed, *limit, &m);
    if (result == EXIT_DONE)
        out->blur = m.rmse;
    return result;
}

static int measure_sweep(study *s, study_view *v, const float *truth, sweep *out)
{
    crv_options eight[2];
    float *limit = NULL, *boxed = NULL;
    double ms[2];
    int result = measure_limits(s, v, out, &limit, &boxed);

    eight[0] = eight[1] = measure_cubic(v, out->method, 8);
    eight[1].filter = crv_filter_find("box4");
    for (int i = 0; i < COUNTS && result == EXIT_DONE; i++) {
        crv_options o = measure_cubic(v, out->method, FIRST << i);

        out->n[i] = o.samples;
        result = measure_tile(s, v, &o, limit, boxed, truth, i, out);
        o.noise_size = 1;
        if (result == EXIT_DONE)
            result = measure_error(s, v, &o, limit, draws_of(o.samples), &out->same[i]);
    }
    if (result == EXIT_DONE)
        result = measure_times(s, v, eight, 2, 5, ms);
    free(limit);
    free(boxed);
    if (result != EXIT_DONE)
        return result;
    out->ms_raw = ms[0];
    out->ms_joined = ms[1];
    out->gain =
        measure_crossing(out->n, out->same, COUNTS, out->joined_noise[1]) / out->n[1];
    return EXIT_DONE;
}

static void plot_sweeps(study *s, const sweep *c, const sweep *w)
{
    double bound[COUNTS];
    plot_series own[] = {
        {.name = "containment", .x = c->n, .y = c->same},
        {.name = "containment, interleaved", .x = c->n, .y = c->joined_noise},
        {.name = "containment, and blur", .x = c->n, .y = c->joined},
        {.name = "vao", .x = w->n, .y = w->same},
        {.name = "vao, interleaved", .x = w->n, .y = w->joined_noise},
        {.name = "vao, and blur", .x = w->n, .y = w->joined},
        {.name = "independent tests: 1/sqrt(4 n)", .x = c->n, .y = bound}};
    plot_series truth[] = {{.name = "containment, interleaved", .x = c->n, .y = c->truth},
                           {.name = "vao, interleaved", .x = w->n, .y = w->truth}};

    for (int i = 0; i < COUNTS; i++)
        bound[i] = 1.0 / sqrt(4.0 * c->n[i]);
    for (int i = 0; i < 7; i++) {
        own[i].count = COUNTS;
        own[i].is_line = true;
        own[i].is_guide = i == 6;
    }
    for (int i = 0; i < 2; i++) {
        truth[i].count = COUNTS;
        truth[i].is_line = true;
    }
    page_plot(s->page,
              &(plot){.caption =
                          "Noise over samples: RMS distance from each method's own "
                          "limit at 512 samples. Interleaved: a 4x4 tile of "
                          "rotations, then `box4`; otherwise one sample set for "
                          "all pixels, and no filter.",
                      .x_title = "samples n for each pixel",
                      .y_title = "RMS error",
                      .log_x = true,
                      .log_y = true,
                      .series = own,
                      .series_count = 7});
    page_plot(s->page,
              &(plot){.caption =
                          "Error over samples against the ray-traced truth, cosine "
                          "weighting, falloff cubic. Where a curve is flat, more "
                          "samples do not help.",
                      .x_title = "samples n for each pixel",
                      .y_title = "RMS error",
                      .log_x = true,
                      .log_y = true,
                      .series = truth,
                      .series_count = 2});
}

static void claim_smooth(study *s, const sweep *c, const sweep *w)
{
    int wins = 0;
    char measured[512];

    for (int i = 0; i < 3; i++) /* 4, 8, 16 samples; 2 % may come from the draws */
        wins += w->tile[i] < 0.98 * c->tile[i];
    snprintf(
        measured, sizeof measured,
        "RMS noise before the filter, containment against vao, at 4 samples %.4f and "
        "%.4f, at 8 %.4f and %.4f, at 16 %.4f and %.4f.",
        c->tile[0], w->tile[0], c->tile[1], w->tile[1], c->tile[2], w->tile[2]);
    measure_claim(
        s, (page_claim){.paper = "2010, Figure 9",
                        .statement = "At few samples volumetric AO is smoother than "
                                     "containment tests, as a pipe knows how much of it "
                                     "is open.",
                        .verdict = wins == 3  ? PAGE_HOLDS
                                   : wins > 0 ? PAGE_PARTLY
                                              : PAGE_FAILS,
                        .measured = measured,
                        .reason = "Points spread well in three dimensions converge about "
                                  "as fast as pipes in two."});
}

static void claim_bound(study *s, const sweep *c, const sweep *w)
{
    int within = 0;
    double needs = measure_crossing(c->n, c->tile, COUNTS, 0.01);
    double vao_needs = measure_crossing(w->n, w->tile, COUNTS, 0.01);
    char measured[512], first[64], second[64];

    for (int i = 0; i < COUNTS; i++)
        within += c->tile[i] < 1.0 / sqrt(4.0 * c->n[i]);
    snprintf(first, sizeof first, isinf(needs) ? "more than %.0f" : "%.0f",
             isinf(needs) ? c->n[COUNTS - 1] : ceil(needs));
    snprintf(second, sizeof second, isinf(vao_needs) ? "more than %.0f" : "%.0f",
             isinf(vao_needs) ? w->n[COUNTS - 1] : ceil(vao_needs));
    snprintf(measured, sizeof measured,
             "RMS noise of containment at %.0f, %.0f and %.0f samples: %.4f, %.4f, %.4f; "
             "bounds %.4f, %.4f, %.4f. It falls as n to the power of %.2f. Below 0.01 it "
             "comes with %s samples, vao with %s.",
             c->n[0], c->n[2], c->n[4], c->tile[0], c->tile[2], c->tile[4],
             1.0 / sqrt(4.0 * c->n[0]), 1.0 / sqrt(4.0 * c->n[2]),
             1.0 / sqrt(4.0 * c->n[4]), measure_slope(c->n, c->tile, COUNTS), first,
             second);
    measure_claim(s, (page_claim){.paper = "2010, containment tests",
                                  .statement =
                                      "The standard deviation stays below 1/sqrt(4 n); "
                                      "independent samples must be 2500 to be surely "
                                      "below 0.01.",
                                  .verdict = within == COUNTS ? PAGE_HOLDS
                                             : within > 0     ? PAGE_PARTLY
                                                              : PAGE_FAILS,
                                  .measured = measured,
                                  .reason = "The sample sets are not independent."});
}

/* "3.2", "more than 16", "less than 0.5". */
static void name_gain(const sweep *w, char *out, size_t size)
{
    if (isinf(w->gain))
        snprintf(out, size, "more than %.0f", w->n[COUNTS - 1] / w->n[1]);
    else if (w->gain <= 0.0)
        snprintf(out, size, "less than %.1f", w->n[0] / w->n[1]);
    else
        snprintf(out, size, "%.1f", w->gain);
}

static void claim_interleaved(study *s, const sweep *const of[2])
{
    char measured[1024], gains[2][32];
    double least = fmin(of[0]->gain, of[1]->gain);
    bool is_mild = of[0]->joined[1] < of[0]->same[1] && of[1]->joined[1] < of[1]->same[1];

    name_gain(of[0], gains[0], sizeof gains[0]);
    name_gain(of[1], gains[1], sizeof gains[1]);
    snprintf(
        measured, sizeof measured,
        "In noise alone (against the limit through the same box) 8 samples, "
        "interleaved, are worth %s times as many of one set for containment (%.4f to "
        "%.4f) and %s times for vao (%.4f to %.4f). The box blurs the limit by an RMS "
        "error of %.4f and %.4f; with that the error is %.4f and %.4f. Time with the "
        "box: %.2f and %.2f of that without.",
        gains[0], of[0]->same[1], of[0]->joined_noise[1], gains[1], of[1]->same[1],
        of[1]->joined_noise[1], of[0]->blur, of[1]->blur, of[0]->joined[1],
        of[1]->joined[1], of[0]->ms_joined / of[0]->ms_raw,
        of[1]->ms_joined / of[1]->ms_raw);
    measure_claim(
        s,
        (page_claim){
            .paper = "2010, Figure 9",
            .statement = "Interleaving over 4x4 pixels multiplies the effective number "
                         "of samples by 16 for the cost of a box filter, and blurs "
                         "mildly.",
            /* 16 within the quarter by which single draws differ; mild is a blur that
             * leaves a gain. */
            .verdict = least >= 12.0 && is_mild ? PAGE_HOLDS
                       : least >= 2.0           ? PAGE_PARTLY
                                                : PAGE_FAILS,
            .measured = measured,
            .reason = "Sixteen times holds for error that is independent from pixel to "
                      "pixel. Well-spread sets converge faster than that by themselves, "
                      "so that more of them gain more than averages do. And where the "
                      "occlusion has detail of a few pixels the box "
                      "takes more away than the noise was."});
}

static int write_results(study *s, cJSON *to, const sweep *w)
{
    cJSON *json = measure_object(s, to, w->method);

    if (json == NULL)
        return EXIT_FAILED;
    study_add_number(json, "interleaving_gain", w->gain);
    study_add_number(json, "box_blur", w->blur);
    study_add_number(json, "ms_raw", w->ms_raw);
    study_add_number(json, "ms_joined", w->ms_joined);
    return measure_array(s, json, "samples", w->n, COUNTS)
                   && measure_array(s, json, "noise_one_set", w->same, COUNTS)
                   && measure_array(s, json, "noise_tile", w->tile, COUNTS)
                   && measure_array(s, json, "noise_and_blur_interleaved", w->joined,
                                    COUNTS)
                   && measure_array(s, json, "noise_interleaved_without_blur",
                                    w->joined_noise, COUNTS)
                   && measure_array(s, json, "error_interleaved", w->truth, COUNTS)
               ? EXIT_DONE
               : EXIT_FAILED;
}

/* Four samples, as the paper has them: raw and interleaved. */
static int write_pictures(study *s, study_view *v)
{
    static const char *const methods[] = {"containment", "vao"};

    page_grid_begin(s->page);
    for (int m = 0; m < 2; m++) {
        for (int interleaved = 0; interleaved < 2; interleaved++) {
            crv_options o = measure_cubic(v, methods[m], 4);
            char name[48], caption[96];
            float *picture = NULL;
            int result;

            o.noise_size = interleaved ? 4 : 1;
            o.filter = interleaved ? crv_filter_find("box4") : NULL;
            result = measure_picture(s, v, &o, &picture);
            if (result != EXIT_DONE)
                return result;
            snprintf(name, sizeof name, "vao-%s-%s", methods[m],
                     interleaved ? "interleaved" : "one-set");
            snprintf(caption, sizeof caption, "%s, 4 samples, %s", methods[m],
                     interleaved ? "interleaved over 4x4 pixels" : "one set");
            page_picture(s->page, name, picture, v->width, v->height, caption);
            free(picture);
        }
    }
    page_grid_end(s->page);
    return EXIT_DONE;
}

/* Figure 10. */
static int write_normaliser(study *s, study_view *v, cJSON *to)
{
    enum { SIZES = 4 };
    double n[SIZES], weighted[SIZES], analytic[SIZES];
    crv_options much = measure_cubic(v, "vao", 4);
    cJSON *json = measure_object(s, to, "normaliser");
    float *limit = NULL;
    char measured[256];
    int result;

    if (json == NULL)
        return EXIT_FAILED;
    much = measure_much(&much, 512);
    result = measure_picture(s, v, &much, &limit);
    for (int i = 0; i < SIZES && result == EXIT_DONE; i++) {
        crv_options o = measure_cubic(v, "vao", FIRST << i);

        n[i] = o.samples;
        result = measure_error(s, v, &o, limit, draws_of(o.samples), &weighted[i]);
        o.normaliser = CRV_NORMALISER_ANALYTIC;
        if (result == EXIT_DONE)
            result = measure_error(s, v, &o, limit, draws_of(o.samples), &analytic[i]);
    }
    free(limit);
    if (result != EXIT_DONE)
        return result;
    plot_series series[] = {
        {.name = "analytic", .x = n, .y = analytic, .count = SIZES, .is_line = true},
        {.name = "weighted", .x = n, .y = weighted, .count = SIZES, .is_line = true}};
    page_plot(s->page,
              &(plot){.caption = "Noise of vao with both normalisers (`--normaliser`), "
                                 "4x4 tile, unfiltered: RMS distance from 512 samples of "
                                 "the weighted one. What the analytic formula keeps is "
                                 "perspective: seen from the side of the picture a "
                                 "sphere is an ellipse, of which the pipes cover a "
                                 "circle, and each is shorter along the view axis than "
                                 "along its ray. The weighted one divides by what it "
                                 "covers.",
                      .x_title = "samples n for each pixel",
                      .y_title = "RMS error",
                      .log_x = true,
                      .log_y = true,
                      .series = series,
                      .series_count = 2});
    snprintf(measured, sizeof measured,
             "RMS noise at 4 samples: weighted %.4f, analytic %.4f; at 8: %.4f, %.4f; at "
             "32: %.4f, %.4f.",
             weighted[0], analytic[0], weighted[1], analytic[1], weighted[3],
             analytic[3]);
    measure_claim(
        s, (page_claim){.paper = "2010, Figure 10",
                        .statement = "With four samples weighted importance sampling is "
                                     "far closer to the limit than the analytic formula.",
                        .verdict = weighted[0] < 0.75 * analytic[0]   ? PAGE_HOLDS
                                   : weighted[0] < 0.98 * analytic[0] ? PAGE_PARTLY
                                                                      : PAGE_FAILS,
                        .measured = measured,
                        .reason = "The samples of a disk are spread so well that their "
                                  "chords add up to nearly the volume already."});
    return measure_array(s, json, "samples", n, SIZES)
                   && measure_array(s, json, "weighted", weighted, SIZES)
                   && measure_array(s, json, "analytic", analytic, SIZES)
               ? EXIT_DONE
               : EXIT_FAILED;
}

int claims_samples(study *s, cJSON *to)
{
    static const study_target cubic = {.weighting = CRV_WEIGHTING_COSINE,
                                       .falloff = CRV_FALLOFF_CUBIC,
                                       .tau = 3,
                                       .u = 0.1f};
    sweep sweeps[2] = {{.method = "containment"}, {.method = "vao"}};
    const sweep *const both[2] = {&sweeps[0], &sweeps[1]};
    const float *truth;
    int result =
        study_reference(s, s->main, &cubic, REFERENCE_FULL, STUDY_ONE_LAYER, &truth);

    for (int i = 0; i < 2 && result == EXIT_DONE; i++) {
        study_progress(s, "vao: %s over samples", sweeps[i].method);
        result = measure_sweep(s, s->main, truth, &sweeps[i]);
    }
    if (result != EXIT_DONE)
        return result;
    page_heading(s->page, 3, "vao-samples", "Samples and interleaving");
    plot_sweeps(s, &sweeps[0], &sweeps[1]);
    result = write_pictures(s, s->main);
    if (result != EXIT_DONE)
        return result;
    claim_smooth(s, &sweeps[0], &sweeps[1]);
    claim_bound(s, &sweeps[0], &sweeps[1]);
    claim_interleaved(s, both);
    for (int i = 0; i < 2 && result == EXIT_DONE; i++)
        result = write_results(s, to, &sweeps[i]);
    return result == EXIT_DONE ? write_normaliser(s, s->main, to) : result;
}
