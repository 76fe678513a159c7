/* SPDX-License-Identifier: MIT */
/* worker.h: an engine in a thread of its own, which serves the newest wish. */
#ifndef VIEW_WORKER_H
#define VIEW_WORKER_H

#include "tuning.h"

typedef struct worker worker;

/* ready() is called by the thread whenever there is a new picture or news of a fit. The
 * engine is the thread's until worker_stop(). NULL: no memory or no thread. */
worker *worker_start(engine *e, void (*ready)(void *user), void *user);
void worker_stop(worker *k);

/* Replaces the wish before; ray casting of another view is given up. Returns the wish's
 * number, counted from 1. */
uint64_t worker_ask(worker *k, const wish *w);

/* Makes the newest wish once more, as the truth has got better. */
void worker_refresh(worker *k);

/* Fits the options of a half of the newest wish, once that is served. Another wish ends
 * it with the best so far, and so does worker_stop_tuning(). */
void worker_tune(worker *k, int half, double seconds);
void worker_stop_tuning(worker *k);
/* How the last fit stands. */
void worker_tuning(worker *k, tuning *out);

/* The newest picture, once: *out is the caller's then. *number: of its wish. */
bool worker_take(worker *k, shown *out, uint64_t *number);

#endif
