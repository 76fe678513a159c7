/* SPDX-License-Identifier: MIT */
#include "tuning.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/motion.h"
#include "common/text.h"
#include "halves.h"

/* The turn of the camera to the view that is not fitted, and the share of the time that
 * the truth of each view gets. */
#define ORBIT_RAD   0.698
#define TRUTH_SHARE 0.2
#define TOLD_S      0.1

typedef struct job {
    engine *e;
    const wish *w;
    const tuning_request *q;
    tuning *out;
    double begun, told; /* when, report_seconds() */
} job;

static void tell(job *j)
{
    j->told = report_seconds();
    j->q->told(j->q->user, j->out);
}

static void watch(void *user, int32_t runs, double rmse)
{
    job *j = user;
    j->out->runs = runs;
    j->out->rmse = rmse;
    if (report_seconds() > j->told + TOLD_S)
        tell(j);
}

static bool stop(void *user)
{
    const job *j = user;
    return j->q->stop(j->q->user);
}

static bool fail(job *j, const char *why)
{
    const char *first = j->e->problem;
    snprintf(j->out->problem, sizeof j->out->problem, "%s", first[0] ? first : why);
    j->out->phase = TUNING_FAILED;
    return false;
}

static bool trace(job *j, const scene_gbuffer *g, tune_view *v)
{
    const source *s = j->e->source;
    const tune_trace t = {.model = s->model,
                          .g = g,
                          .target = j->out->target,
                          .threads = s->settings->common.threads.value,
                          .seconds = TRUTH_SHARE * j->q->seconds,
                          .stop = stop,
                          .user = j};
    return tune_view_trace(v, &t, &j->e->quiet.logger) == 0;
}

static bool open_view(job *j, crv_gbuffer *gbuffer, const buffers *b, tune_view *v)
{
    return tune_view_open(v, j->e->estimator.context, gbuffer, &b->g.desc, b->g.depth[0],
                          TUNE_PIXELS);
}

/* On a view whose truth is there, in what the other view's leaves of the time. */
static bool search_options(job *j, tune_view *v)
{
    const tune_request q = {.view = v,
                            .start = j->w->half[j->q->half].options,
                            .fits = TUNE_USUAL,
                            .seconds = (1.0 - TRUTH_SHARE) * j->q->seconds
                                       - (report_seconds() - j->begun),
                            .watch = watch,
                            .stop = stop,
                            .user = j};
    return tune_fit(&q, &j->out->found) == CRV_OK;
}

static bool fit(job *j)
{
    engine *e = j->e;
    tune_view v = {0};
    bool done = open_view(j, e->estimator.gbuffer, e->buffers, &v);
    if (done && v.count == 0)
        done = fail(j, "no surface is in view");
    else if (done && !trace(j, &e->buffers->g, &v))
        done = fail(j, "stopped before anything was fitted");
    else if (done && tune_view_is_open(&v))
        done = fail(j, "nothing in view is occluded; try a larger radius");
    else if (!done || !search_options(j, &v))
        done = fail(j, "out of memory; make the window smaller");
    tune_view_free(&v);
    return done;
}

/* The camera goes around its target, or half of the shot is skipped. NULL: there is no
 * other view. *gbuffer: filled, the caller destroys it. */
static buffers *other_buffers(job *j, crv_gbuffer **gbuffer)
{
    engine *e = j->e;
    source *s = e->source;
    if (s->model) {
        const buffers *b = e->buffers;
        scene_view view = j->w->view;
        motion_orbit(&view, ORBIT_RAD, 0.0);
        buffers *other = source_cast(s, &view, b->width, b->height, b->g.desc.guard_left,
                                     &e->quiet.logger);
        if (other
            && scene_gbuffer_upload(&other->g, e->estimator.context, gbuffer) == CRV_OK)
            return other;
        buffers_release(other);
        return NULL;
    }
    if (s->frame_count < 2)
        return NULL;
    const int32_t index = (j->w->frame + s->frame_count / 2) % s->frame_count;
    estimator alone = {.context = e->estimator.context};
    buffers *other = source_read(s, index, &alone, &e->quiet);
    crv_plan_destroy(alone.plan);
    *gbuffer = alone.gbuffer;
    return other;
}

static void check_other(job *j)
{
    tuning *out = j->out;
    crv_gbuffer *gbuffer = NULL;
    buffers *b = other_buffers(j, &gbuffer);
    tune_view v = {0};
    out->has_other =
        b && open_view(j, gbuffer, b, &v) && v.count > 0 && trace(j, &b->g, &v)
        && tune_view_measure(&v, &j->w->half[j->q->half].options, &out->other_before)
               == CRV_OK
        && tune_view_measure(&v, &out->found.options, &out->other_after) == CRV_OK;
    tune_view_free(&v);
    crv_gbuffer_destroy(gbuffer);
    buffers_release(b);
}

void tuning_run(engine *e, const wish *w, const tuning_request *q, tuning *out)
{
    wish still = *w;
    job j = {.e = e, .w = &still, .q = q, .out = out, .begun = report_seconds()};
    *out = (tuning){.phase = TUNING_RUNS, .half = q->half};
    still.moving = false;
    e->problem[0] = '\0';
    tell(&j);
    if (!engine_place(e, &still)) {
        fail(&j, "there is no picture to fit to");
        tell(&j);
        return;
    }
    out->target = halves_target(e, &still, q->half);
    e->muted = true; /* what is logged of the many runs is of no use */
    if (fit(&j)) {
        if (!stop(&j))
            check_other(&j);
        out->phase = TUNING_DONE;
    }
    e->muted = false;
    e->problem[0] = '\0';
    tell(&j);
}

const char *tuning_text(const tuning *t, char out[TUNING_TEXT_SIZE])
{
    const tune_error *before = &t->found.before, *after = &t->found.after;
    out[0] = '\0';
    if (t->phase == TUNING_FAILED)
        append_to(out, TUNING_TEXT_SIZE, "not fitted: %s", t->problem);
    if (t->phase == TUNING_RUNS && t->runs == 0)
        append_to(out, TUNING_TEXT_SIZE, "fits: the truth is traced ...");
    if (t->phase == TUNING_RUNS && t->runs > 0)
        append_to(out, TUNING_TEXT_SIZE, "fits: %d runs, RMSE %.4f", t->runs, t->rmse);
    if (t->phase != TUNING_DONE)
        return out;
    append_to(out, TUNING_TEXT_SIZE,
              "fitted: RMSE %.4f to %.4f, bias %+.4f to %+.4f (%d runs)", before->rmse,
              after->rmse, before->bias, after->bias, t->found.evaluations);
    if (t->has_other)
        append_to(out, TUNING_TEXT_SIZE, "\nanother view: RMSE %.4f to %.4f%s",
                  t->other_before.rmse, t->other_after.rmse,
                  t->other_after.mean_square > t->other_before.mean_square
                      ? ", worse: these options suit this view alone"
                      : "");
    return out;
}
