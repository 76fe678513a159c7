/* SPDX-License-Identifier: MIT */
#include "stability_reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int trace(study *s, const camera_move *move, const study_target *target, int32_t k,
                 float *plane)
{
    /* Other rays for each frame, too: equal ones at one pixel would leave a pattern that
     * is fixed to the screen. */
    reference_options options = {.definition = target->definition,
                                 .kind = REFERENCE_FULL,
                                 .weighting = target->weighting,
                                 .falloff = target->falloff,
                                 .tau = target->tau,
                                 .u = target->u,
                                 .radius = move->base.radius,
                                 .rays = STABILITY_RAYS,
                                 .normals = SCENE_NORMALS_INTERPOLATED,
                                 .seed = (uint32_t)(1 + k)};
    reference *r;

    if (reference_create(move->base.model, move->gbuffers[k / 2], &options, &r,
                         &s->r->logger)
        != 0)
        return EXIT_FAILED;
    reference_advance(r, reference_total(r), s->threads);
    memcpy(plane, reference_accessibility(r), (size_t)reference_total(r) * sizeof *plane);
    reference_free(r);
    return EXIT_DONE;
}

/* The traced frames as a pair to compare. */
static void make_pair(const camera_move *move, const float *planes, const uint8_t *mask,
                      stability_frame pair[2])
{
    size_t pixels = (size_t)move->base.width * (size_t)move->base.height;

    for (size_t n = 0; n < 2; n++) {
        pair[n] = move->frames[n];
        pair[n].accessibility = planes + 2 * n * pixels;
        pair[n].repetition = planes + (2 * n + 1) * pixels;
        pair[n].mask = mask;
    }
}

/* The mean of products may fall below 0 where there is next to nothing. */
static double mean_square(const stability *sum)
{
    return sum->points > 0 ? fmax(0.0, sum->change2 / (double)sum->points) : 0.0;
}

static void find_steady(const camera_move *move, stability_truth *t)
{
    stability_frame pair[2];
    stability all = {0}, steady = {0};
    int32_t width = move->base.width;

    make_pair(move, t->planes, NULL, pair);
    for (int32_t y = 0; y < move->base.height; y++) {
        for (int32_t x = 0; x < width; x++) {
            double a, b;
            t->steady[(size_t)y * (size_t)width + (size_t)x] =
                stability_point(&pair[0], &pair[1], x, y, &a, &b)
                && fabs(0.5 * (a + b)) < STABILITY_STEADY;
        }
    }
    stability_add(&all, &pair[0], &pair[1]);
    make_pair(move, t->planes, t->steady, pair);
    stability_add(&steady, &pair[0], &pair[1]);
    t->all2 = mean_square(&all);
    t->steady2 = mean_square(&steady);
    t->share = all.points > 0 ? (double)steady.points / (double)all.points : 0.0;
}

int stability_truth_trace(study *s, const camera_move *move, const study_target *target,
                          stability_truth *out)
{
    size_t pixels = (size_t)move->base.width * (size_t)move->base.height;
    int code = EXIT_DONE;

    *out = (stability_truth){.target = *target,
                             .planes = malloc(4 * pixels * sizeof *out->planes),
                             .steady = malloc(pixels)};
    if (out->planes == NULL || out->steady == NULL)
        return report_no_memory(s->r);
    for (int32_t k = 0; k < 4 && code == EXIT_DONE; k++)
        code = trace(s, move, target, k, out->planes + pixels * (size_t)k);
    if (code == EXIT_DONE)
        find_steady(move, out);
    return code;
}

void stability_truth_free(stability_truth *t)
{
    free(t->planes);
    free(t->steady);
    *t = (stability_truth){0};
}

int stability_truth_compare(study *s, const camera_move *move, const stability_truth *t,
                            float *const estimates[2], double *change2, double *error2)
{
    size_t pixels = (size_t)move->base.width * (size_t)move->base.height;
    float *errors = malloc(4 * pixels * sizeof *errors);
    stability change = {0}, error = {0};
    stability_frame pair[2];

    if (errors == NULL)
        return report_no_memory(s->r);
    for (size_t k = 0; k < 4; k++)
        for (size_t i = 0; i < pixels; i++)
            errors[k * pixels + i] = estimates[k / 2][i] - t->planes[k * pixels + i];
    make_pair(move, errors, t->steady, pair);
    stability_add(&error, &pair[0], &pair[1]);
    for (int32_t n = 0; n < 2; n++) {
        pair[n].accessibility = estimates[n];
        pair[n].repetition = NULL;
    }
    stability_add(&change, &pair[0], &pair[1]);
    free(errors);
    *change2 = mean_square(&change);
    *error2 = mean_square(&error);
    return EXIT_DONE;
}
