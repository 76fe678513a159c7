/* SPDX-License-Identifier: MIT */
#include "readings.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180.0;

enum {
    MAX_READINGS = 64,
    CLAMP_DEGREES = 30, /* pixels that are further off tell nothing more */
    CONTRARY_DEGREES = 20,
    FITTED_PAIRS = 8000
};

/* Degrees. Below `settled`, no fit is tried: it could not be better by much. A reading
 * that is worse than the best by less than `margin` and a tenth may still be the right
 * one, for a fit is always a little better than the truth. */
static const double settled = 1.0, margin = 0.3;

typedef struct reading_list {
    int count;
    io__reading list[MAX_READINGS];
} reading_list;

/* Fills in the mean of the clamped angles, in degrees, and the share of those that are
 * large. By the chord, which is exact for small angles, as a cosine is not. */
static void measure(const io__pair_list *pairs, io__reading *r)
{
    const double farthest = 2.0 * sin(0.5 * CLAMP_DEGREES * degree);
    const double contrary = 2.0 * sin(0.5 * CONTRARY_DEGREES * degree);
    const double *m = r->turn;
    double sum = 0.0;
    size_t contraries = 0;
    for (size_t i = 0; i < pairs->count; i++) {
        const float *n = pairs->from[i];
        double square = 0.0;
        for (int k = 0; k < 3; k++) {
            const double turned = m[3 * k] * (double)n[0] + m[3 * k + 1] * (double)n[1]
                                  + m[3 * k + 2] * (double)n[2];
            const double difference = turned - (double)pairs->to[i][k];
            square += difference * difference;
        }
        sum += square < farthest * farthest ? 2.0 * asin(0.5 * sqrt(square)) / degree
                                            : (double)CLAMP_DEGREES;
        contraries += square > contrary * contrary;
    }
    r->deviation = sum / (double)pairs->count;
    r->contrary = (double)contraries / (double)pairs->count;
}

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] =
                a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

static void add(reading_list *all, const io__pair_list *pairs, int id, const char *text,
                const double turn[9])
{
    io__reading *r = &all->list[all->count++];
    *r = (io__reading){.id = id};
    snprintf(r->text, sizeof r->text, "%s", text);
    memcpy(r->turn, turn, sizeof r->turn);
    measure(pairs, r);
}

static double best_of(const reading_list *all)
{
    double best = DBL_MAX;
    for (int i = 0; i < all->count; i++)
        best = fmin(best, all->list[i].deviation);
    return best;
}

static void add_views(reading_list *all, const io__pair_list *pairs)
{
    static const char *const texts[8] = {"view space",
                                         "view space, x flipped",
                                         "view space, y flipped",
                                         "view space, x and y flipped",
                                         "view space, z flipped",
                                         "view space, x and z flipped",
                                         "view space, y and z flipped",
                                         "view space, all axes flipped"};
    for (int flips = 0; flips < 8; flips++) {
        const double turn[9] = {flips & 1 ? -1 : 1, 0, 0, 0, flips & 2 ? -1 : 1, 0, 0, 0,
                                flips & 4 ? -1 : 1};
        add(all, pairs, flips ? IO__READ_VIEW_FLIPPED + flips - 1 : IO__READ_VIEW,
            texts[flips], turn);
    }
}

/* Other axes than those of the file's camera: z up, left-handed and the like. */
static void add_axes(reading_list *all, const io__pair_list *pairs, const double *to_view)
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {2, 1, 0},
                                     {1, 0, 2}, {1, 2, 0}, {2, 0, 1}};
    for (int order = 0; order < 6; order++)
        for (int flips = 0; flips < 8; flips++) {
            double axes[9] = {0}, turn[9];
            char text[96];
            if (order == 0 && flips == 0)
                continue;
            for (int k = 0; k < 3; k++)
                axes[3 * k + orders[order][k]] = flips & (1 << k) ? -1 : 1;
            snprintf(text, sizeof text,
                     "world space with axes %s%c %s%c %s%c, rotation from the "
                     "camera",
                     flips & 1 ? "-" : "", 'x' + orders[order][0], flips & 2 ? "-" : "",
                     'x' + orders[order][1], flips & 4 ? "-" : "",
                     'x' + orders[order][2]);
            multiply(to_view, axes, turn);
            add(all, pairs, IO__READ_AXES + 8 * order + flips, text, turn);
        }
}

static void add_fits(reading_list *all, const io__pair_list *pairs)
{
    const size_t stride = pairs->count / FITTED_PAIRS + 1;
    const size_t count = pairs->count / stride;
    float(*some)[3] = malloc((2 * count + 1) * sizeof *some);
    if (!some)
        return;
    for (size_t i = 0; i < count; i++) {
        memcpy(some[i], pairs->from[i * stride], sizeof *some);
        memcpy(some[count + i], pairs->to[i * stride], sizeof *some);
    }
    const io__normal_pairs view = {(const float(*)[3])some,
                                   (const float(*)[3])some + count, count};
    double turn[9];
    if (!io__normal_fit(&view, false, turn))
        add(all, pairs, IO__READ_FITTED, "world space, rotation found from depth", turn);
    if (!io__normal_fit(&view, true, turn)) {
        for (int k = 2; k < 9; k += 3)
            turn[k] = -turn[k];
        add(all, pairs, IO__READ_MIRRORED,
            "left-handed space, mirrored, rotation found from depth", turn);
    }
    free(some);
}

static bool is_near(const io__reading *r, double best)
{
    return r->deviation <= 1.1 * best + margin;
}

/* Whether both say the same of every direction, within 5 degrees. */
static bool agree(const io__reading *a, const io__reading *b)
{
    double square = 0.0;
    for (int i = 0; i < 9; i++)
        square += (a->turn[i] - b->turn[i]) * (a->turn[i] - b->turn[i]);
    return square < 2.0 * (5.0 * degree) * (5.0 * degree);
}

/* A fit turns freely about whatever the picture leaves open: it contradicts nobody. */
static bool contradicts(const io__reading *other, const io__reading *chosen, double best)
{
    return is_near(other, best) && other->id < IO__READ_FITTED && !agree(other, chosen);
}

io__reading io__choose_reading(const io__pair_list *pairs,
                               const io__reading_request *request)
{
    reading_list all = {0};
    io__reading chosen = {0};
    if (pairs->count == 0)
        return chosen;
    if (request->try_world && request->to_view)
        add(&all, pairs, IO__READ_METADATA, "world space, rotation from the camera",
            request->to_view);
    if (request->try_view)
        add_views(&all, pairs);
    if (request->try_world && request->to_view && best_of(&all) > settled)
        add_axes(&all, pairs, request->to_view);
    if (request->try_world && best_of(&all) > settled)
        add_fits(&all, pairs);
    const double best = best_of(&all);
    for (int i = all.count - 1; i >= 0; i--)
        if (is_near(&all.list[i], best)
            && (chosen.id != request->usual || chosen.id == 0))
            chosen = all.list[i];
    chosen.decided = true;
    for (int i = 0; i < all.count; i++)
        if (contradicts(&all.list[i], &chosen, best))
            chosen.decided = false;
    return chosen;
}
