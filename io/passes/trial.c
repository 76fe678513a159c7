/* SPDX-License-Identifier: MIT */
#include "trial.h"

#include <string.h>

enum {
    FEWEST_PAIRS = 50,  /* fewer say nothing */
    GLANCE_PAIRS = 1500 /* enough to dismiss most trials */
};

/* Keeps every k-th, so that at most so many are left. */
static void thin(io__pair_list *pairs, size_t most)
{
    const size_t step = pairs->count / most + 1;
    if (pairs->count <= most)
        return;
    const size_t count = pairs->count / step;
    for (size_t i = 1; i < count; i++) {
        memcpy(pairs->from[i], pairs->from[step * i], sizeof pairs->from[i]);
        memcpy(pairs->to[i], pairs->to[step * i], sizeof pairs->to[i]);
    }
    pairs->count = count;
}

static int try_with(const io__court *c, io__trial *t, size_t most_pairs)
{
    const crv_const_image given = crv_image_const(c->frame->depth[0]);
    if (crv_depth_convert(&given, &t->format, &t->camera, &c->planar, c->log) != CRV_OK)
        return -1;
    t->reading = (io__reading){0};
    t->pairs = 0;
    if (!c->has_normals) {
        t->bend = io__surface_bend(&c->planar, &t->camera);
        return 0;
    }
    const io_normal_space space = c->request->normal_space;
    const io__reading_request request = {
        .try_view = space != IO_NORMALS_WORLD,
        .try_world = space != IO_NORMALS_VIEW,
        .to_view = t->guess->has_rotation ? t->guess->to_view : NULL,
        .usual = c->request->usual_reading};
    io__pair_list pairs;
    io__find_pairs(&c->planar, &t->camera, &c->frame->normals, &pairs);
    t->pairs = pairs.count;
    thin(&pairs, most_pairs);
    if (pairs.count >= FEWEST_PAIRS)
        t->reading = io__choose_reading(&pairs, &request);
    io__free_pairs(&pairs);
    return 0;
}

int io__try(const io__court *c, io__trial *t)
{
    return try_with(c, t, SIZE_MAX);
}

/* Whether a trial contradicts the first one by far. */
bool io__is_better(const io__court *c, const io__trial *t, const io__trial *first)
{
    if (!c->has_normals)
        return t->bend >= 0.0 && t->bend < 0.05 && t->bend < 0.1 * first->bend;
    return t->reading.id && 2 * t->pairs > first->pairs
           && t->reading.deviation < 0.5 * first->reading.deviation
           && t->reading.deviation < IO__SUSPICIOUS;
}

static bool is_best(const io__court *c, const io__trial *t, const io__trial *best)
{
    return c->has_normals ? t->reading.deviation < best->reading.deviation
                          : t->bend < best->bend;
}

/* Some twenty trials are for nothing where one is worth a second look. */
static bool is_worth_it(const io__trial *t, const io__trial *first)
{
    return t->reading.id && 2 * t->pairs > first->pairs
           && t->reading.deviation < 0.6 * first->reading.deviation
           && t->reading.deviation < 1.25 * IO__SUSPICIOUS;
}

int io__compare_trials(const io__court *c, const io__trial *first, io__trial *t,
                       io__trial *better, bool *found)
{
    if (c->has_normals) {
        if (try_with(c, t, GLANCE_PAIRS))
            return -1;
        if (!is_worth_it(t, first))
            return 0;
    }
    if (io__try(c, t))
        return -1;
    if (io__is_better(c, t, first) && (!*found || is_best(c, t, better))) {
        *better = *t;
        *found = true;
    }
    return 0;
}
