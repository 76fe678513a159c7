/* SPDX-License-Identifier: MIT */
#include "worker.h"

#include <stdlib.h>
#include <string.h>

#include "system/monitor.h"

/* A picture is on the screen after this time. */
#define DRAWN_S 0.04

struct worker {
    engine *engine;
    void (*ready)(void *user);
    void *user;
    monitor *monitor;
    bool quit, again;
    wish wish;
    uint64_t asked, served; /* numbers of wishes */
    bool busy;              /* with wish number `served` */
    shown shown;
    bool has_shown;
    uint64_t shown_number;
    bool tune_asked, tune_stop;
    tuning_request tune;
    tuning tuning; /* the last */
};

static bool same_view(const wish *a, const wish *b)
{
    return a->width == b->width && a->height == b->height && a->frame == b->frame
           && memcmp(&a->view, &b->view, sizeof a->view) == 0;
}

/* Takes over *s, which replaces a picture that nobody took. */
static void publish(worker *k, shown *s, uint64_t number)
{
    monitor_enter(k->monitor);
    shown_free(&k->shown);
    k->shown = *s;
    k->has_shown = true;
    k->shown_number = number;
    monitor_leave(k->monitor);
    k->ready(k->user);
}

/* Another wish waits. */
static bool is_stale(void *user)
{
    worker *k = user;
    monitor_enter(k->monitor);
    const bool stale = k->quit || k->asked != k->served;
    monitor_leave(k->monitor);
    return stale;
}

/* again: the wish was served before. */
static void serve(worker *k, const wish *w, uint64_t number, bool again)
{
    truth *t = k->engine->truth;
    shown made;
    if (t)
        truth_hold(t, true);
    const bool done = engine_render(k->engine, w, &made);
    if (t && !again)
        truth_rest(t, DRAWN_S);
    if (t)
        truth_hold(t, false);
    if (!done)
        return;
    shown complete = {0};
    const bool more_follows = made.more_follows;
    if (more_follows)
        complete = shown_hold(&made);
    publish(k, &made, number);
    if (!more_follows)
        return;
    engine_complete(k->engine, &complete, is_stale, k);
    publish(k, &complete, number);
}

static void tuning_told(void *user, const tuning *so_far)
{
    worker *k = user;
    monitor_enter(k->monitor);
    k->tuning = *so_far;
    monitor_leave(k->monitor);
    k->ready(k->user);
}

static bool tuning_stops(void *user)
{
    worker *k = user;
    monitor_enter(k->monitor);
    const bool stops = k->quit || k->tune_stop || k->asked != k->served;
    monitor_leave(k->monitor);
    return stops;
}

/* The thread of the truth leaves the processors to it. */
static void tune(worker *k, const wish *w, const tuning_request *q)
{
    truth *t = k->engine->truth;
    tuning made;
    if (t)
        truth_hold(t, true);
    tuning_run(k->engine, w, q, &made);
    if (t)
        truth_hold(t, false);
}

/* Called and left with the lock held. */
static void begin_tuning(worker *k)
{
    const wish w = k->wish;
    const tuning_request q = k->tune;
    k->tune_asked = false;
    k->busy = true;
    atomic_store(&k->engine->source->stop, false);
    monitor_leave(k->monitor);
    tune(k, &w, &q);
    monitor_enter(k->monitor);
    k->busy = false;
}

static void run(void *data)
{
    worker *k = data;
    monitor_enter(k->monitor);
    while (!k->quit) {
        if (k->asked == k->served && k->tune_asked) {
            begin_tuning(k);
            continue;
        }
        if (k->asked == k->served && !k->again) {
            monitor_wait(k->monitor);
            continue;
        }
        const wish w = k->wish;
        const uint64_t number = k->asked;
        const bool again = number == k->served;
        k->served = number;
        k->again = false;
        k->busy = true;
        atomic_store(&k->engine->source->stop, false);
        atomic_store(&k->engine->overtaken, false);
        monitor_leave(k->monitor);
        serve(k, &w, number, again);
        monitor_enter(k->monitor);
        k->busy = false;
    }
    monitor_leave(k->monitor);
}

worker *worker_start(engine *e, void (*ready)(void *user), void *user)
{
    worker *k = calloc(1, sizeof *k);
    if (!k)
        return NULL;
    k->engine = e;
    k->ready = ready;
    k->user = user;
    k->monitor = monitor_create();
    if (k->monitor && monitor_start(k->monitor, run, k))
        return k;
    monitor_free(k->monitor);
    free(k);
    return NULL;
}

void worker_stop(worker *k)
{
    if (!k)
        return;
    monitor_enter(k->monitor);
    k->quit = true;
    atomic_store(&k->engine->source->stop, true);
    atomic_store(&k->engine->overtaken, true);
    monitor_wake(k->monitor);
    monitor_leave(k->monitor);
    monitor_join(k->monitor);
    shown_free(&k->shown);
    monitor_free(k->monitor);
    free(k);
}

uint64_t worker_ask(worker *k, const wish *w)
{
    monitor_enter(k->monitor);
    if (k->busy && !same_view(&k->wish, w))
        atomic_store(&k->engine->source->stop, true);
    atomic_store(&k->engine->overtaken, true);
    k->wish = *w;
    const uint64_t number = ++k->asked;
    monitor_wake(k->monitor);
    monitor_leave(k->monitor);
    return number;
}

void worker_refresh(worker *k)
{
    monitor_enter(k->monitor);
    k->again = k->asked > 0;
    monitor_wake(k->monitor);
    monitor_leave(k->monitor);
}

void worker_tune(worker *k, int half, double seconds)
{
    monitor_enter(k->monitor);
    k->tune = (tuning_request){.half = half,
                               .seconds = seconds,
                               .told = tuning_told,
                               .stop = tuning_stops,
                               .user = k};
    k->tuning = (tuning){.phase = TUNING_RUNS, .half = half};
    k->tune_stop = false;
    k->tune_asked = true;
    monitor_wake(k->monitor);
    monitor_leave(k->monitor);
}

void worker_stop_tuning(worker *k)
{
    monitor_enter(k->monitor);
    k->tune_stop = true;
    monitor_leave(k->monitor);
}

void worker_tuning(worker *k, tuning *out)
{
    monitor_enter(k->monitor);
    *out = k->tuning;
    monitor_leave(k->monitor);
}

bool worker_take(worker *k, shown *out, uint64_t *number)
{
    monitor_enter(k->monitor);
    const bool has = k->has_shown;
    if (has) {
        *out = k->shown;
        *number = k->shown_number;
        k->shown = (shown){0};
        k->has_shown = false;
    }
    monitor_leave(k->monitor);
    return has;
}
