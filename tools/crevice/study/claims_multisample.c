/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "claims_alchemy.h"
#include "claims_measure.h"

/* 2x2 depth samples for each pixel: those of a picture of twice the width and height. */
enum { SIDE = 2, SAMPLES = SIDE * SIDE };

typedef struct composite {
    study *s;
    study_view pixels, samples;
    float *coarse;   /* a value for each pixel */
    float *fine;     /* one for each sample: what compositing should give */
    float *depth;    /* of the samples, SAMPLES for each pixel */
    float *gathered; /* likewise */
    float range;
} composite;

static int gather(composite *c)
{
    const scene_gbuffer *g;
    const study_view *v = &c->pixels;
    report *r = c->s->r;
    crv_gbuffer *gbuffer = NULL;
    crv_const_image coarse = crv_const_image_packed(c->coarse, v->width, v->height, 1);
    crv_const_image depth =
        crv_const_image_packed(c->depth, v->width, v->height, SAMPLES);
    crv_image gathered = crv_image_packed(c->gathered, v->width, v->height, SAMPLES);
    int result = study_gbuffer(c->s, &c->pixels, STUDY_ONE_LAYER, &g);

    if (result != EXIT_DONE)
        return result;
    result = report_ok(r, scene_gbuffer_upload(g, c->s->context, &gbuffer), "G-buffer")
                     && report_ok(r,
                                  crv_multisample_gather(gbuffer, &coarse, &depth, NULL,
                                                         c->range, &gathered),
                                  "gathering")
                 ? EXIT_DONE
                 : EXIT_FAILED;
    crv_gbuffer_destroy(gbuffer);
    return result;
}

/* The sample k of pixel i in the picture of samples. */
static size_t sample_at(const composite *c, size_t i, size_t k)
{
    size_t width = (size_t)c->pixels.width;
    size_t x = SIDE * (i % width) + k % SIDE, y = SIDE * (i / width) + k / SIDE;

    return y * (size_t)c->samples.width + x;
}

static int prepare(composite *c)
{
    size_t pixels = (size_t)c->pixels.width * (size_t)c->pixels.height;
    const scene_gbuffer *g;
    crv_options o = study_options(&c->samples, "alchemy", CRV_PRESET_MEDIUM);
    crv_options much = measure_much(&o, 256);
    int result = measure_picture(c->s, &c->pixels, &much, &c->coarse);

    c->range = o.filter_depth * o.radius;
    if (result == EXIT_DONE)
        result = measure_picture(c->s, &c->samples, &much, &c->fine);
    if (result == EXIT_DONE)
        result = study_gbuffer(c->s, &c->samples, STUDY_ONE_LAYER, &g);
    if (result != EXIT_DONE)
        return result;
    c->depth = malloc(pixels * SAMPLES * sizeof *c->depth);
    c->gathered = malloc(pixels * SAMPLES * sizeof *c->gathered);
    if (c->depth == NULL || c->gathered == NULL)
        return report_no_memory(c->s->r);
    for (size_t i = 0; i < pixels; i++) {
        for (size_t k = 0; k < SAMPLES; k++) {
            size_t at = sample_at(c, i, k), width = (size_t)c->samples.width;
            size_t row = at / width + (size_t)g->desc.guard_top;
            size_t column = at % width + (size_t)g->desc.guard_left;

            c->depth[i * SAMPLES + k] = g->depth[0][row * (size_t)g->desc.width + column];
        }
    }
    return gather(c);
}

/* RMS errors of the samples of pixels that an edge crosses. */
static int64_t errors_at_edges(const composite *c, double *plain, double *gathered)
{
    size_t pixels = (size_t)c->pixels.width * (size_t)c->pixels.height;
    double of_plain = 0.0, of_gathered = 0.0;
    int64_t count = 0;

    for (size_t i = 0; i < pixels; i++) {
        const float *d = c->depth + i * SAMPLES;
        float least = INFINITY, most = 0.0f;

        for (int k = 0; k < SAMPLES; k++) {
            least = fminf(least, d[k]);
            most = fmaxf(most, d[k]);
        }
        if (!(most - least > c->range))
            continue;
        for (size_t k = 0; k < SAMPLES; k++) {
            size_t at = sample_at(c, i, k);
            double truth = (double)c->fine[at];

            if (c->samples.mask[at] == 0)
                continue;
            of_plain += pow((double)c->coarse[i] - truth, 2.0);
            of_gathered += pow((double)c->gathered[i * SAMPLES + k] - truth, 2.0);
            count++;
        }
    }
    *plain = count > 0 ? sqrt(of_plain / (double)count) : NAN;
    *gathered = count > 0 ? sqrt(of_gathered / (double)count) : NAN;
    return count;
}

static void write_claim(const composite *c, cJSON *json)
{
    double plain, gathered;
    int64_t count = errors_at_edges(c, &plain, &gathered);
    char measured[512];

    if (count < 100)
        snprintf(measured, sizeof measured, "The view has %lld such samples, too few.",
                 (long long)count);
    else
        snprintf(measured, sizeof measured,
                 "%dx%d pixels with 2x2 depth samples each, 256 samples of occlusion: on "
                 "the %lld samples of pixels that an edge crosses, RMS error with the "
                 "pixel's own value %.4f, gathered %.4f.",
                 c->pixels.width, c->pixels.height, (long long)count, plain, gathered);
    study_add_number(json, "edge_samples", (double)count);
    study_add_number(json, "rmse_plain", plain);
    study_add_number(json, "rmse_gathered", gathered);
    measure_claim(
        c->s,
        (page_claim){.paper = "2011, section 2",
                     .statement = "Obscurance of one value for each pixel can be "
                                  "composited with subpixel precision: each depth sample "
                                  "gathers from a cross of pixels by nearness in depth.",
                     /* Two thirds of the error is a visible gain. */
                     .verdict = count < 100                ? PAGE_NOT_MEASURED
                                : gathered <= 0.67 * plain ? PAGE_HOLDS
                                : gathered < 0.98 * plain  ? PAGE_PARTLY
                                                           : PAGE_FAILS,
                     .measured = measured,
                     .reason = "Where things are thinner than a pixel no pixel of the "
                               "cross shows the surface that the sample is on."});
}

int claims_multisample(study *s, cJSON *to)
{
    const study_view *v = s->main;
    int32_t width = v->width > 1 ? v->width / SIDE : 1;
    int32_t height = v->height > 1 ? v->height / SIDE : 1;
    composite c = {.s = s};
    cJSON *json = measure_object(s, to, "multisample");
    int result;

    if (json == NULL)
        return EXIT_FAILED;
    study_progress(s, "alchemy: multisampling");
    result = study_view_resized(s, v, width, height, &c.pixels);
    if (result != EXIT_DONE)
        return result;
    result = study_view_resized(s, v, SIDE * width, SIDE * height, &c.samples);
    if (result == EXIT_DONE) {
        result = prepare(&c);
        if (result == EXIT_DONE)
            write_claim(&c, json);
        study_view_free(&c.samples);
    }
    study_view_free(&c.pixels);
    free(c.coarse);
    free(c.fine);
    free(c.depth);
    free(c.gathered);
    return result;
}
