/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "claims_measure.h"
#include "claims_vao.h"
#include "sections.h"

enum { ROUNDS = 5 };
enum { SSAO, CONTAINMENT, VAO, METHODS };

static const char *const names[METHODS] = {"ssao", "containment", "vao"};

static const study_target cubic = {
    .weighting = CRV_WEIGHTING_COSINE, .falloff = CRV_FALLOFF_CUBIC, .tau = 3, .u = 0.1f};

static crv_options method_options(const study_view *v, int method, int32_t samples)
{
    crv_options o = measure_cubic(v, names[method], samples);

    o.filter = crv_filter_find("box4");
    return o;
}

/* Figure 8: 32 samples, two neighbourhoods. */
typedef struct neighbourhood {
    study_view *view;
    const float *truth;
    float *pictures[METHODS];
    measure_fitted fit[METHODS];
    double ms[METHODS];   /* measured side by side with those of the other radius */
    double open[METHODS]; /* mean of accessibility where the truth is open */
    int64_t open_pixels;
} neighbourhood;

static void mean_of_open(neighbourhood *n)
{
    const study_view *v = n->view;
    size_t count = (size_t)v->width * (size_t)v->height;
    double sum[METHODS] = {0.0};

    for (size_t i = 0; i < count; i++) {
        if (v->mask[i] == 0 || !(n->truth[i] > 0.995f))
            continue;
        n->open_pixels++;
        for (int m = 0; m < METHODS; m++)
            sum[m] += (double)n->pictures[m][i];
    }
    for (int m = 0; m < METHODS; m++)
        n->open[m] = sum[m] / (double)n->open_pixels;
}

static int fit_picture(study *s, study_view *v, const crv_options *options,
                       const float *picture, const float *truth, measure_fitted *out)
{
    crv_options o = *options;
    float *linear = NULL;
    int result;

    o.intensity = MEASURE_LINEAR;
    result = measure_picture(s, v, &o, &linear);
    if (result == EXIT_DONE)
        result = measure_fit(s, v, picture, linear, truth, out);
    free(linear);
    return result;
}

static int measure_neighbourhood(study *s, study_view *v, neighbourhood *n)
{
    crv_options options[METHODS];
    int result =
        study_reference(s, v, &cubic, REFERENCE_FULL, STUDY_ONE_LAYER, &n->truth);

    n->view = v;
    for (int m = 0; m < METHODS && result == EXIT_DONE; m++) {
        options[m] = method_options(v, m, 32);
        result = measure_picture(s, v, &options[m], &n->pictures[m]);
        if (result == EXIT_DONE)
            result = fit_picture(s, v, &options[m], n->pictures[m], n->truth, &n->fit[m]);
    }
    if (result == EXIT_DONE)
        mean_of_open(n);
    return result;
}

static int time_neighbourhoods(study *s, neighbourhood of[2])
{
    crv_options options[2 * METHODS];
    double ms[2 * METHODS];
    int result;

    for (int i = 0; i < 2 * METHODS; i++) {
        options[i] = method_options(s->main, i / 2, 32);
        options[i].radius = of[i % 2].view->radius;
    }
    result = measure_times(s, s->main, options, 2 * METHODS, ROUNDS, ms);
    for (int i = 0; i < 2 * METHODS && result == EXIT_DONE; i++)
        of[i % 2].ms[i / 2] = ms[i];
    return result;
}

static void write_neighbourhoods(study *s, const neighbourhood of[2])
{
    static const char *const headers[] = {"R",    "method", "RMSE",    "fitted",
                                          "bias", "SSIM",   "time, ms"};
    page *p = s->page;

    page_table_begin(p,
                     "32 samples, interleaved, against the ray-traced truth: cosine "
                     "weighting, falloff cubic. Fitted: with the best intensity and "
                     "contrast.",
                     headers, 7);
    for (int i = 0; i < 2; i++) {
        for (int m = 0; m < METHODS; m++) {
            page_cell(p, "%.3g", (double)of[i].view->radius);
            page_cell(p, "%s", names[m]);
            page_cell(p, "%.4f", of[i].fit[m].rmse);
            page_cell(p, "%.4f", of[i].fit[m].fitted_rmse);
            page_cell(p, "%+.4f", of[i].fit[m].bias);
            page_cell(p, "%.3f", of[i].fit[m].ssim);
            page_cell(p, "%.2f", of[i].ms[m]);
        }
    }
    page_table_end(p);
    page_grid_begin(p);
    for (int i = 0; i < 2; i++) {
        const study_view *v = of[i].view;
        char name[48], caption[128];

        for (int m = 0; m < METHODS; m++) {
            snprintf(name, sizeof name, "vao-%s-32-%s", names[m], i ? "large" : "small");
            snprintf(caption, sizeof caption, "%s, 32 samples, R = %.3g", names[m],
                     (double)v->radius);
            page_picture(p, name, of[i].pictures[m], v->width, v->height, caption);
        }
        snprintf(name, sizeof name, "vao-truth-%s", i ? "large" : "small");
        snprintf(caption, sizeof caption, "ray-traced, R = %.3g", (double)v->radius);
        page_picture(p, name, of[i].truth, v->width, v->height, caption);
    }
    page_grid_end(p);
}

static void claim_quality(study *s, const neighbourhood of[2])
{
    int wins = 0;
    char measured[512];

    for (int i = 0; i < 2; i++) /* 2 %: draws of the noise, rays of the truth */
        wins += of[i].fit[VAO].rmse
                < 0.98 * fmin(of[i].fit[SSAO].rmse, of[i].fit[CONTAINMENT].rmse);
    snprintf(measured, sizeof measured,
             "RMSE of ssao, containment and vao at R = %.3g: %.4f, %.4f, %.4f; at R = "
             "%.3g: %.4f, %.4f, %.4f.",
             (double)of[0].view->radius, of[0].fit[SSAO].rmse,
             of[0].fit[CONTAINMENT].rmse, of[0].fit[VAO].rmse, (double)of[1].view->radius,
             of[1].fit[SSAO].rmse, of[1].fit[CONTAINMENT].rmse, of[1].fit[VAO].rmse);
    measure_claim(
        s, (page_claim){
               .paper = "2010, Figure 8",
               .statement = "Of SSAO, containment tests and volumetric AO at 32 samples "
                            "the volumetric is the closest to ray tracing.",
               .verdict = wins == 2   ? PAGE_HOLDS
                          : wins == 1 ? PAGE_PARTLY
                                      : PAGE_FAILS,
               .measured = measured,
               .reason =
                   of[1].fit[SSAO].rmse < of[1].fit[VAO].rmse
                       ? "The depth buffer misses much of what a large neighbourhood "
                         "holds, so that the others are too bright; ssao is grey "
                         "everywhere, and grey is near such a truth by accident."
                       : "Filtered, containment and vao are near their limits, and these "
                         "differ where a ray meets more than one surface within R: the "
                         "tangent sphere then counts other points than the rays do."});
}

static void claim_speed(study *s, const neighbourhood of[2])
{
    const double *ms = of[0].ms;
    int faster = (ms[CONTAINMENT] < 0.97 * ms[SSAO]) + (ms[VAO] < 0.97 * ms[SSAO]);
    int slowed = 0;
    double growth[METHODS];
    char measured[512];

    snprintf(measured, sizeof measured,
             "At R = %.3g ssao takes %.2f ms, containment %.2f ms, vao %.2f ms.",
             (double)of[0].view->radius, ms[SSAO], ms[CONTAINMENT], ms[VAO]);
    measure_claim(
        s,
        (page_claim){.paper = "2010, Figure 8",
                     .statement = "Containment tests and volumetric AO are faster than "
                                  "SSAO.",
                     .verdict = faster == 2   ? PAGE_HOLDS
                                : faster == 1 ? PAGE_PARTLY
                                              : PAGE_FAILS,
                     .measured = measured,
                     .reason = "On a GPU of 2007 the look-up took most of the time. "
                               "Here arithmetic does, and a pipe, which is cut with a "
                               "sphere, costs more of it than a point."});
    for (int m = 0; m < METHODS; m++) {
        growth[m] = of[1].ms[m] / of[0].ms[m];
        slowed += growth[m] > 1.1; /* less may be the machine's noise */
    }
    snprintf(measured, sizeof measured,
             "With three times the radius ssao takes %.2f times as long, containment "
             "%.2f, vao %.2f.",
             growth[SSAO], growth[CONTAINMENT], growth[VAO]);
    measure_claim(
        s, (page_claim){.paper = "2010, Figure 8",
                        .statement = "The speed of all three suffers from a large "
                                     "neighbourhood, whose look-ups miss the cache.",
                        .verdict = slowed == METHODS ? PAGE_HOLDS
                                   : slowed > 0      ? PAGE_PARTLY
                                                     : PAGE_FAILS,
                        .measured = measured,
                        .reason = "The caches of a CPU hold many more rows of the depth "
                                  "buffer than those of a GPU of 2007."});
}

static int write_figure_8(study *s, cJSON *to)
{
    study_view large;
    neighbourhood of[2] = {{0}};
    int result;

    study_progress(s, "vao: against ray tracing");
    result = study_view_moved(s, s->main, &s->main->camera, &large);
    if (result != EXIT_DONE)
        return result;
    large.radius *= 3.0f;
    result = measure_neighbourhood(s, s->main, &of[0]);
    if (result == EXIT_DONE)
        result = measure_neighbourhood(s, &large, &of[1]);
    if (result == EXIT_DONE)
        result = time_neighbourhoods(s, of);
    if (result == EXIT_DONE) {
        page_heading(s->page, 3, "vao-quality", "Against ray tracing");
        write_neighbourhoods(s, of);
        claim_quality(s, of);
        claim_speed(s, of);
        if (of[0].open_pixels > 0)
            page_text(s->page,
                      "On the %lld open pixels (truth above 0.995) of the smaller "
                      "neighbourhood the mean is %.3f for `ssao`, %.3f for "
                      "`containment`, %.3f for `vao`.",
                      (long long)of[0].open_pixels, of[0].open[SSAO],
                      of[0].open[CONTAINMENT], of[0].open[VAO]);
    }
    for (int i = 0; i < 2 && result == EXIT_DONE; i++) {
        cJSON *json = measure_object(s, to, i ? "large_radius" : "small_radius");

        for (int m = 0; m < METHODS && json != NULL; m++) {
            cJSON *one = measure_object(s, json, names[m]);

            study_add_number(one, "rmse", of[i].fit[m].rmse);
            study_add_number(one, "fitted_rmse", of[i].fit[m].fitted_rmse);
            study_add_number(one, "bias", of[i].fit[m].bias);
            study_add_number(one, "ms", of[i].ms[m]);
            study_add_number(one, "mean_of_open", of[i].open[m]);
        }
        result = json != NULL ? EXIT_DONE : EXIT_FAILED;
    }
    for (int m = 0; m < METHODS; m++) {
        free(of[0].pictures[m]);
        free(of[1].pictures[m]);
    }
    study_view_free(&large);
    return result;
}

/* Figure 11: eight samples; containment with the hard cutoff. */
static int write_figure_11(study *s, cJSON *to)
{
    study_view *v = s->main;
    crv_options options[METHODS];
    double raw[METHODS], joined[METHODS], ms[METHODS];
    char measured[512];
    int result = EXIT_DONE;

    study_progress(s, "vao: eight samples");
    page_heading(s->page, 3, "vao-eight", "Eight samples");
    page_grid_begin(s->page);
    for (int m = 0; m < METHODS && result == EXIT_DONE; m++) {
        crv_options o = method_options(v, m, 8), bare, much;
        float *limit = NULL, *picture = NULL;
        char name[32], caption[64];

        if (m == CONTAINMENT)
            o.falloff = CRV_FALLOFF_NONE;
        options[m] = bare = o;
        bare.filter = NULL;
        much = measure_much(&o, 512);
        result = measure_picture(s, v, &much, &limit);
        if (result == EXIT_DONE)
            result = measure_error(s, v, &bare, limit, 2, &raw[m]);
        if (result == EXIT_DONE)
            result = measure_error(s, v, &o, limit, 2, &joined[m]);
        if (result == EXIT_DONE)
            result = measure_picture(s, v, &o, &picture);
        snprintf(name, sizeof name, "vao-%s-8", names[m]);
        snprintf(caption, sizeof caption, "%s, 8 samples, interleaved", names[m]);
        if (result == EXIT_DONE)
            page_picture(s->page, name, picture, v->width, v->height, caption);
        free(limit);
        free(picture);
    }
    page_grid_end(s->page);
    if (result == EXIT_DONE)
        result = measure_times(s, v, options, METHODS, ROUNDS, ms);
    if (result != EXIT_DONE)
        return result;
    snprintf(measured, sizeof measured,
             "RMS noise of ssao, containment (falloff none) and vao: %.4f, %.4f, %.4f; "
             "interleaved %.4f, %.4f, %.4f. Time %.2f, %.2f, %.2f ms.",
             raw[SSAO], raw[CONTAINMENT], raw[VAO], joined[SSAO], joined[CONTAINMENT],
             joined[VAO], ms[SSAO], ms[CONTAINMENT], ms[VAO]);
    measure_claim(
        s, (page_claim){.paper = "2010, Figure 11",
                        .statement = "At eight samples volumetric AO is smoother than "
                                     "SSAO and containment tests.",
                        .verdict = raw[VAO] < 0.98 * fmin(raw[SSAO], raw[CONTAINMENT])
                                       ? PAGE_HOLDS
                                   : raw[VAO] < 0.98 * fmax(raw[SSAO], raw[CONTAINMENT])
                                       ? PAGE_PARTLY
                                       : PAGE_FAILS,
                        .measured = measured,
                        .reason = "ssao spans half the range: its noise, like its "
                                  "picture, has half the contrast."});
    return measure_array(s, to, "eight_noise", raw, METHODS)
                   && measure_array(s, to, "eight_noise_interleaved", joined, METHODS)
                   && measure_array(s, to, "eight_ms", ms, METHODS)
               ? EXIT_DONE
               : EXIT_FAILED;
}

/* The mean over the middle of a picture of a plane at this tilt about the x axis. Away
 * from the border, beyond which nothing occludes. */
static int wall_mean(study *s, int method, double tilt, double *mean)
{
    enum { SIZE = 96, EDGE = 24 };
    static float depth[SIZE * SIZE], normals[3 * SIZE * SIZE], a[SIZE * SIZE];
    const crv_camera camera = crv_camera_orthographic(SIZE, SIZE, 2.0f);
    const study_view sized = {.radius = 0.2f};
    crv_options o = method_options(&sized, method, 64);
    double sum = 0.0;
    int result;

    o.radius = 0.2f;
    o.filter = NULL;
    for (int i = 0; i < SIZE * SIZE; i++) {
        double y = -(i / SIZE + 0.5 - (double)camera.cy_px) / (double)camera.fy_px;

        depth[i] = (float)(10.0 + y * tan(tilt));
        normals[3 * i] = 0.0f;
        normals[3 * i + 1] = (float)sin(tilt);
        normals[3 * i + 2] = (float)cos(tilt);
    }
    result = study_run_buffers(s, &camera, depth, normals, SIZE, SIZE, &o, a);
    for (int y = EDGE; y < SIZE - EDGE; y++)
        for (int x = EDGE; x < SIZE - EDGE; x++)
            sum += (double)a[y * SIZE + x];
    *mean = sum / ((SIZE - 2 * EDGE) * (SIZE - 2 * EDGE));
    return result;
}

static int write_walls(study *s, cJSON *to)
{
    enum { TILTS = 3 };
    static const double degrees[TILTS] = {0, 30, 60};
    double mean[METHODS][TILTS], off[METHODS] = {0.0};
    char measured[512];

    for (int m = 0; m < METHODS; m++) {
        for (int t = 0; t < TILTS; t++) {
            int result = wall_mean(s, m, degrees[t] * 0.017453292519943295, &mean[m][t]);

            if (result != EXIT_DONE)
                return result;
            off[m] = fmax(off[m], fabs(mean[m][t] - (m == SSAO ? 0.5 : 1.0)));
        }
        if (!measure_array(s, to,
                           m == SSAO          ? "wall_ssao"
                           : m == CONTAINMENT ? "wall_containment"
                                              : "wall_vao",
                           mean[m], TILTS))
            return EXIT_FAILED;
    }
    snprintf(measured, sizeof measured,
             "A plane turned by 0, 30 and 60 degrees, 64 samples, unfiltered: ssao %.4f, "
             "%.4f, %.4f; containment %.4f, %.4f, %.4f; vao %.4f, %.4f, %.4f.",
             mean[0][0], mean[0][1], mean[0][2], mean[1][0], mean[1][1], mean[1][2],
             mean[2][0], mean[2][1], mean[2][2]);
    /* On a slope the depth buffer is a staircase, on which one point in a hundred is on
     * the wrong side. */
    measure_claim(
        s, (page_claim){.paper = "2010, Figure 8",
                        .statement = "SSAO makes a flat open wall middle grey; the other "
                                     "two leave it white.",
                        .verdict =
                            off[SSAO] < 0.02 && off[CONTAINMENT] < 0.02 && off[VAO] < 0.02
                                ? PAGE_HOLDS
                            : off[SSAO] < 0.05 ? PAGE_PARTLY
                                               : PAGE_FAILS,
                        .measured = measured,
                        .reason = "A depth buffer holds a slope as a staircase, on which "
                                  "points near the surface fall on its wrong side."});
    return EXIT_DONE;
}

int study_claims_vao(study *s)
{
    cJSON *json = measure_object(s, s->results, "vao");
    int result;

    if (json == NULL)
        return EXIT_FAILED;
    page_heading(s->page, 2, "vao", "Szirmay-Kalos et al. 2010: volumetric AO");
    page_text(
        s->page,
        "Measured on the view %s at %dx%d with R = %.3g. `containment` has the "
        "falloff cubic unless said otherwise: where a ray meets at most one surface "
        "within R, its integral is then that of `vao`. It is the paper's here, `steps=1 "
        "thickness=0`; by default it tests points on the way as well.",
        s->main->name, s->main->width, s->main->height, (double)s->main->radius);
    result = write_figure_8(s, json);
    if (result == EXIT_DONE)
        result = write_walls(s, json);
    if (result == EXIT_DONE)
        result = claims_samples(s, json);
    if (result == EXIT_DONE)
        result = write_figure_11(s, json);
    if (result == EXIT_DONE)
        result = claims_relief(s, json);
    return result;
}
