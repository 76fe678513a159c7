/* SPDX-License-Identifier: MIT */
/* tuning.h: the options of a half, fitted to the truth of the view, as `crevice tune`
 * does. */
#ifndef VIEW_TUNING_H
#define VIEW_TUNING_H

#include "common/tune.h"
#include "engine.h"

typedef enum tuning_phase {
    TUNING_NONE,
    TUNING_RUNS,
    TUNING_DONE,  /* found.options are there to be taken over */
    TUNING_FAILED /* problem says why */
} tuning_phase;

typedef struct tuning {
    tuning_phase phase;
    int half;
    int32_t runs; /* so far, and the least error */
    double rmse;
    reference_options target; /* what the truth is */
    tune_result found;
    bool has_other; /* of a view that was not fitted: the camera turned, another frame */
    tune_error other_before, other_after;
    char problem[PROBLEM_SIZE];
} tuning;

typedef struct tuning_request {
    int half;
    double seconds;
    void (*told)(void *user, const tuning *so_far);
    bool (*stop)(void *user); /* true: the best so far is enough */
    void *user;
} tuning_request;

/* Fits the half's options on the engine's G-buffer. */
void tuning_run(engine *e, const wish *w, const tuning_request *q, tuning *out);

enum { TUNING_TEXT_SIZE = 512 };

/* How it stands, in a line or two; "" if there is none. Returns out. */
const char *tuning_text(const tuning *t, char out[TUNING_TEXT_SIZE]);

#endif
