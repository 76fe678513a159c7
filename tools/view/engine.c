/* SPDX-License-Identifier: MIT */
#include "engine.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/device.h"
#include "common/target.h"
#include "paint.h"

/* Moving pictures are ray-cast in about this time. */
#define MOVING_MS 30.0
enum { COARSEST = 8, FIRST_GUESS = 4, MOVING_RAYS = 4 };

void shown_free(shown *s)
{
    if (!s)
        return;
    for (int i = 0; i < HALVES; i++) {
        free(s->half[i].pixels);
        free(s->half[i].accessibility);
        free(s->half[i].truth_plane);
    }
    buffers_release(s->buffers);
    *s = (shown){0};
}

/* The first error line of a picture is the one that says what happened. */
static void take_line(void *user, crv_log_level level, const char *line)
{
    engine *e = user;
    if (level != CRV_LOG_ERROR)
        e->r->logger.fn(e->r->logger.user, level, line);
    else if (e->problem[0] == '\0')
        snprintf(e->problem, sizeof e->problem, "%s", line);
}

int engine_open(engine *e, source *from, truth *t, const common_settings *common,
                report *r)
{
    *e = (engine){.source = from, .truth = t, .r = r};
    e->quiet = *r;
    e->quiet.logger = (crv_logger){take_line, e};
    /* The library's own loops: those of the tool tell how far long estimates are. */
    const crv_allocator usual = {0};
    return device_context_in(common, &e->quiet.logger, &usual, r, &e->estimator.context);
}

static void forget_light(engine *e)
{
    free(e->dark);
    free(e->light);
    e->dark = e->light = NULL;
}

void engine_close(engine *e)
{
    for (int i = 0; i < HALVES; i++)
        estimation_free(&e->half[i]);
    forget_light(e);
    buffers_release(e->buffers);
    estimate_close(&e->estimator);
}

static int32_t coarseness_of(const engine *e, const wish *w)
{
    if (!w->moving || !e->source->model)
        return 1;
    if (!(e->full_cast_ms > 0.0))
        return FIRST_GUESS;
    return (int32_t)fmin(fmax(ceil(sqrt(e->full_cast_ms / MOVING_MS)), 1.0), COARSEST);
}

static bool same_place(const engine *e, const wish *w, int32_t coarseness)
{
    if (!e->buffers)
        return false;
    if (!e->source->model)
        return e->done.frame == w->frame;
    return e->coarseness == coarseness && e->done.width == w->width
           && e->done.height == w->height
           && memcmp(&e->done.view, &w->view, sizeof w->view) == 0;
}

static buffers *cast(engine *e, const wish *w, int32_t coarseness)
{
    view_settings sized = *e->source->settings;
    sized.size.width = (w->width + coarseness - 1) / coarseness;
    sized.size.height = (w->height + coarseness - 1) / coarseness;
    int32_t guard = view_guard_px(&sized);
    if (sized.guard_px.given)
        guard = (guard + coarseness - 1) / coarseness;
    buffers *b = source_cast(e->source, &w->view, sized.size.width, sized.size.height,
                             guard, &e->quiet.logger);
    if (!b)
        return NULL;
    estimate_fit(&e->estimator, &b->g.desc);
    if (scene_gbuffer_upload(&b->g, e->estimator.context, &e->estimator.gbuffer)
        == CRV_OK)
        return b;
    buffers_release(b);
    return NULL;
}

bool engine_place(engine *e, const wish *w)
{
    const int32_t coarseness = coarseness_of(e, w);
    if (same_place(e, w, coarseness))
        return true;
    const double start = report_seconds();
    buffers *b = e->source->model
                     ? cast(e, w, coarseness)
                     : source_read(e->source, w->frame, &e->estimator, &e->quiet);
    if (!b)
        return false;
    e->cast_ms = 1e3 * (report_seconds() - start);
    if (coarseness == 1 || !(e->full_cast_ms > 0.0))
        e->full_cast_ms = e->cast_ms * coarseness * coarseness;
    buffers_release(e->buffers);
    e->buffers = b;
    e->done = *w;
    e->coarseness = coarseness;
    forget_light(e);
    for (int i = 0; i < HALVES; i++)
        estimation_stale(&e->half[i]);
    return true;
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

/* Whose method says what the truth of this half is. */
static const crv_options *truth_options(const wish *w, int half)
{
    const half_wish *own = &w->half[half], *other = &w->half[1 - half];
    return own->content == HALF_METHOD || other->content != HALF_METHOD ? &own->options
                                                                        : &other->options;
}

static reference_options truth_of(const engine *e, const wish *w, int half)
{
    reference_options o = target_of(truth_options(w, half));
    if (!e->source->model)
        o.kind = REFERENCE_VISIBLE;
    if (e->source->settings->normals_from.value != 0)
        o.normals = SCENE_NORMALS_FACE;
    return o;
}

/* Whether the picture is more than a glimpse. */
static bool is_settled(const engine *e, const wish *w)
{
    return e->coarseness == 1 && (!w->moving || !e->source->model);
}

static void want_truths(engine *e, const wish *w)
{
    for (int i = 0; i < HALVES && e->truth; i++) {
        const reference_options o = truth_of(e, w, i);
        truth_want(e->truth, i, is_settled(e, w) ? e->buffers : NULL, &o);
    }
}

/* A few rays for each pixel, while the camera moves. */
static bool trace_now(const engine *e, const wish *w, int half, float *out)
{
    const buffers *b = e->buffers;
    reference_options o = truth_of(e, w, half);
    reference *work = NULL;
    o.rays = MOVING_RAYS;
    if (reference_create(e->source->model, &b->g, &o, &work, NULL) != 0)
        return false;
    reference_advance(work, reference_total(work),
                      e->source->settings->common.threads.value);
    memcpy(out, reference_accessibility(work),
           (size_t)b->width * (size_t)b->height * sizeof *out);
    reference_free(work);
    return true;
}

static bool fill_content(engine *e, const wish *w, int half, half_shown *out)
{
    const size_t count = (size_t)e->buffers->width * (size_t)e->buffers->height;
    const half_wish *h = &w->half[half];
    if (h->content == HALF_TRUTH && !is_settled(e, w))
        return trace_now(e, w, half, out->accessibility);
    if (h->content == HALF_TRUTH && out->has_truth) {
        memcpy(out->accessibility, out->truth_plane, count * sizeof(float));
        return true;
    }
    if (h->content != HALF_METHOD) {
        for (size_t i = 0; i < count; i++)
            out->accessibility[i] = 1.0f;
        return true;
    }
    const crv_options o = coarse_options(e, &h->options);
    if (estimation_run(&e->half[half], e->estimator.context, e->estimator.gbuffer,
                       &e->buffers->g.desc, &o)
        != CRV_OK)
        return false;
    e->problem[0] = '\0'; /* a plan that was made anew is no failure */
    memcpy(out->accessibility, e->half[half].result, count * sizeof(float));
    out->time_ms = e->half[half].time_ms;
    return true;
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

/* Lit pictures without sky and with all of it; what lies between is in proportion. */
static bool make_light(engine *e)
{
    const int32_t width = e->buffers->width, height = e->buffers->height;
    const size_t count = (size_t)width * (size_t)height;
    const int32_t threads = e->source->settings->common.threads.value;
    if (e->dark)
        return true;
    float *closed = calloc(count, sizeof *closed);
    e->dark = malloc(3 * count * sizeof *e->dark);
    e->light = malloc(3 * count * sizeof *e->light);
    bool done = closed && e->dark && e->light;
    if (done) {
        const scene_occlusion none = {
            .accessibility = crv_const_image_packed(closed, width, height, 1)};
        const crv_image dark = crv_image_packed(e->dark, width, height, 3);
        const crv_image light = crv_image_packed(e->light, width, height, 3);
        done = scene_shade(e->source->model, &e->buffers->g, NULL, &none, &dark, threads,
                           &e->quiet.logger)
                   == 0
               && scene_shade(e->source->model, &e->buffers->g, NULL, NULL, &light,
                              threads, &e->quiet.logger)
                      == 0;
    }
    free(closed);
    if (!done)
        forget_light(e);
    return done;
}

static bool paint(engine *e, const wish *w, int half, shown *out)
{
    const buffers *b = e->buffers;
    const size_t count = (size_t)b->width * (size_t)b->height;
    half_shown *h = &out->half[half];
    switch (w->half[half].look) {
    case LOOK_DIFFERENCE:
        paint_difference(out->half[0].accessibility, out->half[1].accessibility,
                         b->surface, w->heat_scale, count, h->pixels);
        break;
    case LOOK_LIT:
        if (e->source->model) {
            if (!make_light(e))
                return false;
            paint_lit(e->dark, e->light, h->accessibility, count, h->pixels);
            break;
        } /* frames carry no materials: */
        /* fall through */
    case LOOK_ACCESSIBILITY:
        paint_grey(h->accessibility, count, h->pixels);
        break;
    }
    for (int i = 0; i < HALVES; i++)
        if (w->half[i].content == HALF_TRUTH && is_settled(e, w)
            && (i == half || w->half[half].look == LOOK_DIFFERENCE))
            paint_unknown(out->half[i].has_truth ? (size_t)out->half[i].truth.known : 0,
                          count, b->width, h->pixels);
    return true;
}

static bool make_room(const buffers *b, half_shown *h)
{
    const size_t count = (size_t)b->width * (size_t)b->height;
    h->accessibility = malloc(count * sizeof *h->accessibility);
    h->pixels = malloc(count * sizeof *h->pixels);
    h->truth_plane = malloc(count * sizeof *h->truth_plane);
    return h->accessibility && h->pixels && h->truth_plane;
}

static bool make_halves(engine *e, const wish *w, shown *out)
{
    bool done = true;
    for (int i = 0; i < HALVES && done; i++) {
        half_shown *h = &out->half[i];
        done = make_room(e->buffers, h);
        if (done && e->truth && is_settled(e, w))
            h->has_truth = truth_read(e->truth, i, e->buffers, h->truth_plane, &h->truth);
        done = done && fill_content(e, w, i, h);
        if (done && h->has_truth && h->truth.passes > 1
            && w->half[i].content != HALF_TRUTH)
            measure(e->buffers, h);
    }
    for (int i = 0; i < HALVES && done; i++)
        done = paint(e, w, i, out);
    return done;
}

bool engine_render(engine *e, const wish *w, shown *out)
{
    *out = (shown){.wish = *w};
    e->problem[0] = '\0';
    bool done = engine_place(e, w);
    if (!done && atomic_load(&e->source->stop))
        return false;
    if (done) {
        want_truths(e, w);
        done = make_halves(e, w, out);
    }
    if (!done) {
        shown_free(out);
        out->wish = *w;
        snprintf(out->problem, sizeof out->problem, "%s",
                 e->problem[0] ? e->problem : "out of memory; make the window smaller");
    }
    out->buffers = done ? buffers_hold(e->buffers) : NULL;
    out->coarseness = e->coarseness;
    out->cast_ms = e->cast_ms;
    return true;
}
