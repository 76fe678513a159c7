/* SPDX-License-Identifier: MIT */
#include "session.h"

#include <math.h>
#include <string.h>

/* Called by the thread of the truth. */
static void truth_changed(void *user)
{
    session *s = user;
    if (s->worker)
        worker_refresh(s->worker);
}

static void picture_ready(void *user)
{
    session *s = user;
    s->ready(s->user);
}

static bool usual_options(const session *s, const char *method, crv_options *out)
{
    if (crv_options_init(out, sizeof *out, method) != CRV_OK)
        return false;
    if (s->usual_radius > 0.0f)
        out->radius = s->usual_radius;
    return true;
}

/* The first frame says which radius suits it. */
static int find_radius(session *s)
{
    const common_settings *c = &s->source.settings->common;
    if (c->radius_given) {
        s->usual_radius = c->options.radius;
    } else if (s->source.model) {
        s->usual_radius = scene_suggest_radius(s->source.model, &s->wish.view);
    } else {
        if (!engine_place(&s->engine, &s->wish)) {
            if (s->engine.problem[0])
                report_error(s->r, "%s", s->engine.problem);
            return EXIT_FAILED;
        }
        s->usual_radius = s->source.radius > 0.0f ? s->source.radius : 1.0f;
    }
    return EXIT_DONE;
}

static int begin_wish(session *s, const viewer_settings *v)
{
    wish *w = &s->wish;
    w->width = v->view.size.width;
    w->height = v->view.size.height;
    w->heat_scale = 0.25;
    int result = s->source.model ? view_choose(&v->view, s->source.model, &w->view, s->r)
                                 : EXIT_DONE;
    if (result == EXIT_DONE)
        result = find_radius(s);
    for (int i = 0; i < HALVES; i++)
        w->half[i].options = v->view.common.options;
    for (int i = 0; i < HALVES && result == EXIT_DONE; i++)
        w->half[i].options.radius = s->usual_radius;
    w->half[1].content = HALF_TRUTH;
    return result;
}

int session_open(session *s, const viewer_settings *settings, void (*ready)(void *user),
                 void *user, report *r)
{
    const view_settings *v = &settings->view;
    *s = (session){.r = r, .ready = ready, .user = user};
    int result = source_open(&s->source, settings, r);
    s->input_s = report_seconds();
    if (result == EXIT_DONE)
        result = engine_open(&s->engine, &s->source, NULL, &v->common, r);
    if (result == EXIT_DONE)
        result = begin_wish(s, settings);
    if (result != EXIT_DONE)
        return result;
    if (!s->source.model)
        s->input_s = report_seconds();
    s->truth = truth_start(s->source.model, v->common.threads.value, truth_changed, s);
    s->engine.truth = s->truth;
    s->worker = s->truth ? worker_start(&s->engine, picture_ready, s) : NULL;
    return s->worker ? EXIT_DONE : report_no_memory(r);
}

void session_close(session *s)
{
    /* Each of them calls the other. */
    truth_stop(s->truth);
    worker_stop(s->worker);
    truth_free(s->truth);
    engine_close(&s->engine);
    source_free(&s->source);
    *s = (session){0};
}

uint64_t session_ask(session *s)
{
    return worker_ask(s->worker, &s->wish);
}

bool session_set_method(session *s, int half, const char *name)
{
    half_wish *h = &s->wish.half[half];
    const float radius = h->options.radius;
    if (!crv_method_find(name) || !usual_options(s, name, &h->options))
        return false;
    h->options.radius = radius;
    h->content = HALF_METHOD;
    h->keeps_target = false;
    return true;
}

bool session_set_option(session *s, int half, const char *key, const char *value)
{
    return crv_options_set(&s->wish.half[half].options, key, value, &s->r->logger)
           == CRV_OK;
}

void session_set_preset(session *s, int half, crv_preset preset)
{
    crv_options_preset(&s->wish.half[half].options, preset);
}

bool session_take_over(session *s, const tuning *t)
{
    half_wish *h = &s->wish.half[t->half];
    if (t->phase != TUNING_DONE || h->content != HALF_METHOD
        || h->options.method != t->found.options.method)
        return false;
    h->options = t->found.options;
    h->keeps_target = true;
    h->target = t->target;
    return true;
}

void session_reset(session *s, int half)
{
    s->wish.half[half].keeps_target = false;
    usual_options(s, s->wish.half[half].options.method->name,
                  &s->wish.half[half].options);
}

void session_fit(session *s)
{
    const wish *w = &s->wish;
    if (s->source.model)
        scene_frame(s->source.model,
                    w->view.vfov_rad > 0.0f ? w->view.vfov_rad : 0.785398f,
                    (float)w->width / (float)w->height, &s->wish.view);
}

void session_enter(session *s)
{
    scene_view *v = &s->wish.view;
    double lower[3], upper[3];
    int longest = -1, up = 0;
    if (!s->source.model)
        return;
    scene_bounds(s->source.model, lower, upper);
    for (int i = 1; i < 3; i++)
        if (fabs(v->up[i]) > fabs(v->up[up]))
            up = i;
    for (int i = 0; i < 3; i++) {
        v->eye[i] = v->target[i] = 0.5 * (lower[i] + upper[i]);
        if (i != up
            && (longest < 0 || upper[i] - lower[i] > upper[longest] - lower[longest]))
            longest = i;
    }
    v->target[longest] = upper[longest];
}
