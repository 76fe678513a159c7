/* SPDX-License-Identifier: MIT */
#include "engine.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/device.h"
#include "common/target.h"
#include "halves.h"

/* Moving pictures are ray-cast in about this time. */
#define MOVING_MS 30.0
enum { COARSEST = 8, FIRST_GUESS = 4 };

/* Of a half that shows no method, the other one says it. */
reference_options wish_target(const wish *w, int half)
{
    const half_wish *own = &w->half[half], *other = &w->half[1 - half];
    const half_wish *asked =
        own->content == HALF_METHOD || other->content != HALF_METHOD ? own : other;
    return asked->keeps_target ? asked->target : target_of(&asked->options);
}

void shown_free(shown *s)
{
    if (!s)
        return;
    for (int i = 0; i < HALVES; i++) {
        pool_release(s->half[i].pixels);
        pool_release(s->half[i].accessibility);
        pool_release(s->half[i].truth_plane);
    }
    buffers_release(s->buffers);
    pool_release(s->samples);
    *s = (shown){0};
}

shown shown_hold(const shown *s)
{
    for (int i = 0; i < HALVES; i++) {
        pool_hold(s->half[i].pixels);
        pool_hold(s->half[i].accessibility);
        pool_hold(s->half[i].truth_plane);
    }
    buffers_hold(s->buffers);
    pool_hold(s->samples);
    return *s;
}

/* The first error line of a picture is the one that says what happened. */
static void take_line(void *user, crv_log_level level, const char *line)
{
    engine *e = user;
    if (e->muted)
        return;
    if (level != CRV_LOG_ERROR)
        e->r->logger.fn(e->r->logger.user, level, line);
    else if (e->problem[0] == '\0')
        snprintf(e->problem, sizeof e->problem, "%s", line);
}

/* Between pieces of a run: ends it for a wish that waits, unless it is about to come to
 * its end. Who drags a slider sees the pictures of short runs. */
static int32_t leave_off(void *user, int32_t done, int32_t total)
{
    engine *e = user;
    const double worth_it_s = 0.3;
    if (!(e->run_began_s > 0.0) || !atomic_load(&e->overtaken))
        return 0;
    const double spent = report_seconds() - e->run_began_s;
    e->left_off = spent * (total - done) > worth_it_s * done;
    return e->left_off;
}

int engine_open(engine *e, source *from, truth *t, const common_settings *common,
                report *r)
{
    *e = (engine){.source = from, .truth = t, .common = common, .r = r};
    e->quiet = *r;
    e->quiet.logger = (crv_logger){take_line, e};
    e->planes = pool_open();
    e->lists = pool_open();
    if (!e->planes || !e->lists)
        return report_no_memory(r);
    /* The library's own loops: those of the tool tell how far long estimates are. */
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = e->quiet.logger;
    desc.progress = (crv_progress){.fn = leave_off, .user = e};
    return device_context_in(common, &desc, r, &e->estimator.context);
}

void engine_close(engine *e)
{
    for (int i = 0; i < HALVES; i++)
        estimation_free(&e->half[i]);
    halves_forget(e);
    pool_close(e->planes);
    pool_close(e->lists);
    crv_context_destroy(e->single);
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
    halves_forget(e);
    for (int i = 0; i < HALVES; i++)
        estimation_stale(&e->half[i]);
    return true;
}

bool engine_render(engine *e, const wish *w, shown *out)
{
    *out = (shown){.wish = *w, .began_s = report_seconds()};
    e->problem[0] = '\0';
    e->left_off = false;
    bool done = engine_place(e, w);
    if (!done && atomic_load(&e->source->stop))
        return false;
    if (done) {
        halves_want_truths(e, w);
        done = halves_make(e, w, out);
    }
    if (e->left_off) {
        shown_free(out);
        return false;
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
    out->made_s = report_seconds();
    return true;
}
