/* SPDX-License-Identifier: MIT */
#include "claims_horizon.h"

#include <math.h>
#include <stdlib.h>

/* Shown at most: small enough to see single pixels in a grid of pictures. */
enum { SHOWN_WIDTH = 320, SHOWN_HEIGHT = 180 };

/* Windows that are tried along each side of the picture. */
enum { SHOWN_TRIES = 6 };

static double variance(const study_view *v, const float *picture, int32_t x0, int32_t y0,
                       int32_t width, int32_t height)
{
    double sum = 0.0, squares = 0.0, count = (double)width * height;

    for (int32_t y = y0; y < y0 + height; y++) {
        for (int32_t x = x0; x < x0 + width; x++) {
            double a = (double)picture[(size_t)y * (size_t)v->width + (size_t)x];

            sum += a;
            squares += a * a;
        }
    }
    return squares / count - sum / count * (sum / count);
}

static void choose_window(horizon_study *h)
{
    double best = -1.0;

    h->width = h->v->width < SHOWN_WIDTH ? h->v->width : SHOWN_WIDTH;
    h->height = h->v->height < SHOWN_HEIGHT ? h->v->height : SHOWN_HEIGHT;
    for (int32_t i = 0; i < SHOWN_TRIES * SHOWN_TRIES; i++) {
        int32_t x = i % SHOWN_TRIES * (h->v->width - h->width) / (SHOWN_TRIES - 1);
        int32_t y = i / SHOWN_TRIES * (h->v->height - h->height) / (SHOWN_TRIES - 1);
        double varies = variance(h->v, h->truth, x, y, h->width, h->height);

        if (varies > best) {
            best = varies;
            h->x = x;
            h->y = y;
        }
    }
}

int horizon_open(study *s, const char *method, const char *section, horizon_study *out)
{
    horizon_study h = {.s = s, .v = s->main};
    study_target target;
    int result;

    h.paper = study_options(s->main, method, CRV_PRESET_PAPER);
    h.paper.filter = NULL;
    h.json = measure_object(s, s->results, section);
    if (h.json == NULL)
        return EXIT_FAILED;
    target = study_target_of(&h.paper);
    result =
        study_reference(s, s->main, &target, REFERENCE_FULL, STUDY_ONE_LAYER, &h.truth);
    if (result != EXIT_DONE)
        return result;
    choose_window(&h);
    *out = h;
    return EXIT_DONE;
}

int horizon_run(const horizon_study *h, const crv_options *options, study_buffers buffers,
                metrics *out, float **picture)
{
    study_estimate estimate = {0};
    int result = study_run(h->s, h->v, options, buffers, 0, &estimate);

    if (result == EXIT_DONE && out != NULL)
        result = study_compare(h->s, h->v, estimate.accessibility, h->truth, out);
    if (result == EXIT_DONE && picture != NULL) {
        *picture = estimate.accessibility;
        return EXIT_DONE;
    }
    free(estimate.accessibility);
    return result;
}

int horizon_mean(const horizon_study *h, const crv_options *options, int32_t draws,
                 float *mean)
{
    size_t pixels = (size_t)h->v->width * (size_t)h->v->height;
    crv_options o = *options;

    for (size_t k = 0; k < pixels; k++)
        mean[k] = 0;
    for (int32_t i = 0; i < draws; i++) {
        float *picture = NULL;
        int result;

        o.seed = 1 + i;
        result = horizon_run(h, &o, STUDY_ONE_LAYER, NULL, &picture);
        if (result != EXIT_DONE)
            return result;
        for (size_t k = 0; k < pixels; k++)
            mean[k] += picture[k] / (float)draws;
        free(picture);
    }
    return EXIT_DONE;
}

/* The shown part of a picture, packed; NULL where memory ran out. */
static float *cut(const horizon_study *h, const float *picture)
{
    size_t width = (size_t)h->width, height = (size_t)h->height;
    float *part = malloc(width * height * sizeof *part);

    for (size_t y = 0; part != NULL && y < height; y++) {
        const float *row = picture + ((size_t)h->y + y) * (size_t)h->v->width + h->x;

        for (size_t x = 0; x < width; x++)
            part[y * width + x] = row[x];
    }
    return part;
}

int horizon_show(const horizon_study *h, const char *name, const float *picture,
                 const char *caption)
{
    float *part = cut(h, picture);

    if (part == NULL)
        return report_no_memory(h->s->r);
    page_picture(h->s->page, name, part, h->width, h->height, caption);
    free(part);
    return EXIT_DONE;
}

int horizon_show_error(const horizon_study *h, const char *name, const float *picture,
                       const float *truth, const char *caption)
{
    float *a = cut(h, picture), *b = cut(h, truth);
    size_t width = (size_t)h->width, height = (size_t)h->height;
    uint8_t *mask = malloc(width * height);
    bool done = a != NULL && b != NULL && mask != NULL;

    if (done) {
        for (size_t y = 0; y < height; y++) {
            for (size_t x = 0; x < width; x++)
                mask[y * width + x] = h->v->mask[((size_t)h->y + y) * (size_t)h->v->width
                                                 + (size_t)h->x + x];
        }
        page_error_map(h->s->page, name, a, b, mask, h->width, h->height, 0.5, caption);
    }
    free(a);
    free(b);
    free(mask);
    return done ? EXIT_DONE : report_no_memory(h->s->r);
}

void horizon_sides(const study_view *v, const float *picture, const float *truth,
                   double *too_dark, double *too_bright)
{
    size_t count = (size_t)v->width * (size_t)v->height;
    double pixels = v->pixels > 0 ? (double)v->pixels : 1.0;

    *too_dark = *too_bright = 0.0;
    for (size_t i = 0; i < count; i++) {
        double error = v->mask[i] ? (double)picture[i] - (double)truth[i] : 0.0;

        if (error < 0)
            *too_dark -= error / pixels;
        else
            *too_bright += error / pixels;
    }
}

bool horizon_number(const horizon_study *h, cJSON *to, const char *name, double value)
{
    if (cJSON_AddNumberToObject(to, name, value) != NULL)
        return true;
    report_no_memory(h->s->r);
    return false;
}
