/* SPDX-License-Identifier: MIT */
#include "worker.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* A picture is on the screen after this time. */
#define DRAWN_S 0.04

struct worker {
    engine *engine;
    void (*ready)(void *user);
    void *user;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    bool quit, again;
    wish wish;
    uint64_t asked, served; /* numbers of wishes */
    bool busy;              /* with wish number `served` */
    shown shown;
    bool has_shown;
    uint64_t shown_number;
};

static bool same_view(const wish *a, const wish *b)
{
    return a->width == b->width && a->height == b->height && a->frame == b->frame
           && memcmp(&a->view, &b->view, sizeof a->view) == 0;
}

/* Takes over *s, which replaces a picture that nobody took. */
static void publish(worker *k, shown *s, uint64_t number)
{
    pthread_mutex_lock(&k->lock);
    shown_free(&k->shown);
    k->shown = *s;
    k->has_shown = true;
    k->shown_number = number;
    pthread_mutex_unlock(&k->lock);
    k->ready(k->user);
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
    if (done)
        publish(k, &made, number);
}

static void *run(void *data)
{
    worker *k = data;
    pthread_mutex_lock(&k->lock);
    while (!k->quit) {
        if (k->asked == k->served && !k->again) {
            pthread_cond_wait(&k->wake, &k->lock);
            continue;
        }
        const wish w = k->wish;
        const uint64_t number = k->asked;
        const bool again = number == k->served;
        k->served = number;
        k->again = false;
        k->busy = true;
        atomic_store(&k->engine->source->stop, false);
        pthread_mutex_unlock(&k->lock);
        serve(k, &w, number, again);
        pthread_mutex_lock(&k->lock);
        k->busy = false;
    }
    pthread_mutex_unlock(&k->lock);
    return NULL;
}

worker *worker_start(engine *e, void (*ready)(void *user), void *user)
{
    worker *k = calloc(1, sizeof *k);
    if (!k)
        return NULL;
    k->engine = e;
    k->ready = ready;
    k->user = user;
    pthread_mutex_init(&k->lock, NULL);
    pthread_cond_init(&k->wake, NULL);
    if (pthread_create(&k->thread, NULL, run, k) == 0)
        return k;
    pthread_cond_destroy(&k->wake);
    pthread_mutex_destroy(&k->lock);
    free(k);
    return NULL;
}

void worker_stop(worker *k)
{
    if (!k)
        return;
    pthread_mutex_lock(&k->lock);
    k->quit = true;
    atomic_store(&k->engine->source->stop, true);
    pthread_cond_signal(&k->wake);
    pthread_mutex_unlock(&k->lock);
    pthread_join(k->thread, NULL);
    shown_free(&k->shown);
    pthread_cond_destroy(&k->wake);
    pthread_mutex_destroy(&k->lock);
    free(k);
}

uint64_t worker_ask(worker *k, const wish *w)
{
    pthread_mutex_lock(&k->lock);
    if (k->busy && !same_view(&k->wish, w))
        atomic_store(&k->engine->source->stop, true);
    k->wish = *w;
    const uint64_t number = ++k->asked;
    pthread_cond_signal(&k->wake);
    pthread_mutex_unlock(&k->lock);
    return number;
}

void worker_refresh(worker *k)
{
    pthread_mutex_lock(&k->lock);
    k->again = k->asked > 0;
    pthread_cond_signal(&k->wake);
    pthread_mutex_unlock(&k->lock);
}

bool worker_take(worker *k, shown *out, uint64_t *number)
{
    pthread_mutex_lock(&k->lock);
    const bool has = k->has_shown;
    if (has) {
        *out = k->shown;
        *number = k->shown_number;
        k->shown = (shown){0};
        k->has_shown = false;
    }
    pthread_mutex_unlock(&k->lock);
    return has;
}
