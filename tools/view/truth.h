/* SPDX-License-Identifier: MIT */
/*
 * truth.h: ray-traced accessibility that gets better and better in a thread of its own.
 *
 * Every pass traces some rays for each pixel with random numbers of its own. What is
 * shown is the mean of the passes; their spread is an honest estimate of its error.
 */
#ifndef VIEW_TRUTH_H
#define VIEW_TRUTH_H

#include "buffers.h"
#include "reference.h"

enum { TRUTH_SLOTS = 2, TRUTH_PASS_RAYS = 8, TRUTH_PASSES = 512 };

typedef struct truth truth;

/* How far one truth is. */
typedef struct truth_state {
    int32_t passes; /* whole ones; 0: the first is being made, from the top */
    int64_t known;  /* pixels that have a value */
    /* Of passes: the root mean square over the surfaces of the estimated standard errors
     * of the pixels. */
    double error;
    int64_t version; /* another one: another mean */
} truth_state;

/* changed() is called by the thread after a pass and now and then in the first. model
 * NULL: what the buffers hold is traced. threads: 0 for all. NULL: no memory or no
 * thread. */
truth *truth_start(const scene *model, int32_t threads, void (*changed)(void *user),
                   void *user);

/* Ends the thread: changed() is not called any more. NULL does nothing. */
void truth_stop(truth *t);
/* Once it is stopped and nobody else uses it. NULL does nothing. */
void truth_free(truth *t);

/* What slot is wanted for: b NULL for nothing. Wishes that were had before go on; two
 * slots that want the same share it. */
void truth_want(truth *t, int slot, buffers *b, const reference_options *o);

/* While it is held, the thread leaves the processors to others. */
void truth_hold(truth *t, bool hold);

/* The same for some time, in which what was wished for is drawn. */
void truth_rest(truth *t, double seconds);

/* Copies the mean so far, a float for each pixel inside the guard band; false if the slot
 * is not of these buffers. */
bool truth_read(truth *t, int slot, const buffers *b, float *out, truth_state *state);

/* The state alone; false if the slot wants nothing. */
bool truth_progress(truth *t, int slot, truth_state *state);

#endif
