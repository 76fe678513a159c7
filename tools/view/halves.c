/* SPDX-License-Identifier: MIT */
#include "halves.h"

#include <math.h>
#include <string.h>

#include "common/device.h"

enum { MOVING_RAYS = 4 };

void halves_forget(engine *e)
{
    pool_release(e->open);
    e->open = NULL;
    pool_release(e->explained.samples);
    e->explained = (explained){0};
    for (int i = 0; i < HALVES; i++) {
        pool_release(e->seen[i].plane);
        e->seen[i] = (seen_truth){0};
    }
    halves_forget_paint(e);
}

/* Pixels of a coarse picture are larger. */
static crv_options coarse_options(const engine *e, const crv_options *options)
{
    crv_options o = *options;
    const float by = (float)e->coarseness;
    if (crv_option_applies(crv_option_find("max_radius_px"), o.method, NULL))
        o.max_radius_px /= by;
    if (crv_option_applies(crv_option_find("band_px"), o.method, NULL))
        o.band_px = fmaxf(o.band_px / by, 1.0f);
    return o;
}

reference_options halves_target(const engine *e, const wish *w, int half)
{
    reference_options o = wish_target(w, half);
    if (!e->source->model)
        o.kind = REFERENCE_VISIBLE;
    if (e->source->settings->normals_from.value != 0)
        o.normals = SCENE_NORMALS_FACE;
    return o;
}

bool halves_are_settled(const engine *e, const wish *w)
{
    return e->coarseness == 1 && (!w->moving || !e->source->model);
}

void halves_want_truths(engine *e, const wish *w)
{
    for (int i = 0; i < HALVES && e->truth; i++) {
        const reference_options o = halves_target(e, w, i);
        truth_want(e->truth, i, halves_are_settled(e, w) ? e->buffers : NULL, &o);
    }
}

size_t halves_plane_count(const engine *e)
{
    return (size_t)e->buffers->width * (size_t)e->buffers->height;
}

static float *take_plane(engine *e)
{
    return pool_take(e->planes, halves_plane_count(e) * sizeof(float));
}

/* 1 everywhere; held once more. */
static float *open_plane(engine *e)
{
    if (!e->open) {
        e->open = take_plane(e);
        for (size_t i = 0; e->open && i < halves_plane_count(e); i++)
            e->open[i] = 1.0f;
    }
    return pool_hold(e->open);
}

/* A few rays for each pixel, while the camera moves. */
static float *trace_now(engine *e, const wish *w, int half)
{
    reference_options o = halves_target(e, w, half);
    reference *work = NULL;
    float *out = take_plane(e);
    o.rays = MOVING_RAYS;
    if (!out
        || reference_create(e->source->model, &e->buffers->g, &o, &work, NULL) != 0) {
        pool_release(out);
        return NULL;
    }
    reference_advance(work, reference_total(work),
                      e->source->settings->common.threads.value);
    memcpy(out, reference_accessibility(work), halves_plane_count(e) * sizeof *out);
    reference_free(work);
    return out;
}

/* The mean so far, read anew if it has changed. */
static bool read_truth(engine *e, int half, half_shown *out)
{
    seen_truth *seen = &e->seen[half];
    if (!truth_progress(e->truth, half, &out->truth))
        return true;
    if (out->truth.known > 0 && !(seen->plane && seen->version == out->truth.version)) {
        pool_release(seen->plane);
        *seen = (seen_truth){.plane = take_plane(e)};
        if (!seen->plane)
            return false;
        if (!truth_read(e->truth, half, e->buffers, seen->plane, &out->truth))
            return true;
        seen->version = out->truth.version;
    }
    out->has_truth = true;
    if (out->truth.known > 0)
        out->truth_plane = pool_hold(seen->plane);
    return true;
}

/* The accessibility of a half; NULL: it failed. */
static float *make_content(engine *e, const wish *w, int half, half_shown *out)
{
    const half_wish *h = &w->half[half];
    if (h->content == HALF_TRUTH && !halves_are_settled(e, w))
        return trace_now(e, w, half);
    if (h->content == HALF_TRUTH && out->truth_plane)
        return pool_hold(out->truth_plane);
    if (h->content != HALF_METHOD)
        return open_plane(e);
    const crv_options o = coarse_options(e, &h->options);
    e->run_began_s = report_seconds();
    if (estimation_run(&e->half[half], e->planes, e->estimator.context,
                       e->estimator.gbuffer, &e->buffers->g.desc, &o)
        != CRV_OK) {
        e->run_began_s = 0.0;
        return NULL;
    }
    e->run_began_s = 0.0;
    e->problem[0] = '\0'; /* a plan that was made anew is no failure */
    out->time_ms = e->half[half].time_ms;
    return pool_hold(e->half[half].result);
}

/* Root mean square and mean of the error over the surfaces. */
static void measure(const buffers *b, half_shown *h)
{
    const size_t count = (size_t)b->width * (size_t)b->height;
    double sum = 0.0, squares = 0.0;
    size_t surfaces = 0;
#ifdef _OPENMP
#pragma omp parallel for reduction(+ : sum, squares, surfaces)
#endif
    for (size_t i = 0; i < count; i++) {
        const double error = (double)h->accessibility[i] - (double)h->truth_plane[i];
        if (!b->surface[i])
            continue;
        surfaces++;
        sum += error;
        squares += error * error;
    }
    h->measured = surfaces > 0;
    if (!h->measured)
        return;
    h->bias = sum / (double)surfaces;
    h->rmse =
        sqrt(fmax(squares / (double)surfaces - h->truth.error * h->truth.error, 0.0));
}

static bool can_measure(const shown *s, int half)
{
    return s->wish.half[half].content == HALF_METHOD && s->half[half].has_truth
           && s->half[half].truth.passes > 1;
}

/* Settled pictures of methods are explained. */
static bool can_explain(const engine *e, const wish *w)
{
    return w->explains && w->half[w->explained_half].content == HALF_METHOD
           && halves_are_settled(e, w);
}

/* Those that are known already; else more follows. */
static bool take_explained(engine *e, const wish *w, shown *out)
{
    const explained *known = &e->explained;
    if (!known->samples || known->half != w->explained_half
        || known->samples->x != w->explained_x || known->samples->y != w->explained_y
        || !estimate_same_options(&known->options, &w->half[known->half].options))
        return false;
    out->samples = pool_hold(known->samples);
    return true;
}

static bool open_single(engine *e)
{
    common_settings common = *e->common;
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    common.device = NULL;
    common.exact = true;
    common.threads = (arg_int){.given = true, .value = 1};
    return e->single
           || device_context_in(&common, &desc, &e->quiet, &e->single) == EXIT_DONE;
}

/* An empty list if the pixel shows no surface. */
static void explain(engine *e, shown *s, bool (*is_stale)(void *user), void *user)
{
    const wish *w = &s->wish;
    const crv_options *options = &w->half[w->explained_half].options;
    samples *found = pool_take(e->lists, sizeof *found);
    if (!found || !open_single(e)) {
        pool_release(found);
        return;
    }
    if (!samples_find(e->single, s->buffers, options, w->explained_x, w->explained_y,
                      is_stale, user, found))
        *found = (samples){.x = w->explained_x, .y = w->explained_y, .is_whole = true};
    if (is_stale(user)) {
        pool_release(found);
        return;
    }
    pool_release(e->explained.samples);
    e->explained = (explained){found, w->explained_half, *options};
    s->samples = pool_hold(found);
}

void engine_complete(engine *e, shown *s, bool (*is_stale)(void *user), void *user)
{
    for (int i = 0; i < HALVES; i++)
        if (can_measure(s, i))
            measure(s->buffers, &s->half[i]);
    if (can_explain(e, &s->wish) && !s->samples)
        explain(e, s, is_stale, user);
    s->more_follows = false;
}

bool halves_make(engine *e, const wish *w, shown *out)
{
    bool done = true;
    for (int i = 0; i < HALVES && done; i++) {
        half_shown *h = &out->half[i];
        if (e->truth && halves_are_settled(e, w))
            done = read_truth(e, i, h);
        h->accessibility = done ? make_content(e, w, i, h) : NULL;
        done = h->accessibility;
        out->more_follows |= can_measure(out, i);
    }
    for (int i = 0; i < HALVES && done; i++)
        done = halves_paint(e, w, i, out);
    if (done && can_explain(e, w) && !take_explained(e, w, out))
        out->more_follows = true;
    return done;
}
