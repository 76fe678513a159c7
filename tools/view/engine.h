/* SPDX-License-Identifier: MIT */
/* engine.h: from a wish to a picture, with as little work as what changed asks for. */
#ifndef VIEW_ENGINE_H
#define VIEW_ENGINE_H

#include "estimation.h"
#include "source.h"
#include "wish.h"

/* The mean that was read last. */
typedef struct seen_truth {
    float *plane; /* held; NULL: none */
    int64_t version;
} seen_truth;

/* What the pixels of a half were painted from: if it is the same, so are they. */
typedef struct painted {
    uint32_t *pixels; /* held; NULL: none */
    half_look look;
    /* Held. The second: of differences, or what stands in for pixels that are not known.
     */
    float *plane[HALVES];
    size_t known; /* the pixels from there on are not known yet */
    double heat_scale;
} painted;

/* The samples that were found last. */
typedef struct explained {
    samples *samples; /* held; NULL: none */
    int half;
    crv_options options;
} explained;

typedef struct engine {
    source *source;
    truth *truth; /* NULL: none is made */
    const common_settings *common;
    report *r;
    report quiet; /* gets what the library logs, for wish.problem */
    estimator estimator;
    estimation half[HALVES];
    /* What the estimator's G-buffer holds. */
    buffers *buffers;
    wish done;
    int32_t coarseness;
    double cast_ms, full_cast_ms; /* the last; of a full picture, 0: not known */
    float *dark, *light;          /* of lit pictures of `buffers`; NULL: not made */
    pool *planes, *lists;         /* lists: of samples */
    float *open; /* held; 1 for each pixel of `buffers`; NULL: not made */
    seen_truth seen[HALVES];
    painted painted[HALVES];
    crv_context *single; /* of one thread, for samples; NULL: not made */
    explained explained;
    char problem[PROBLEM_SIZE];
    bool muted;            /* nothing that is logged is of interest */
    double run_began_s;    /* of a half's method; 0: none runs */
    atomic_bool overtaken; /* set from outside: another wish waits */
    bool left_off;         /* a run was ended for it */
} engine;

/* `from` and t must outlive the engine. Returns an exit code; close it in any case. */
int engine_open(engine *e, source *from, truth *t, const common_settings *common,
                report *r);
void engine_close(engine *e);

/* Casts or reads the G-buffer of the wish; false if there is none. engine_render() does
 * so by itself. */
bool engine_place(engine *e, const wish *w);

/* Makes the picture; false if source->stop was set meanwhile, or `overtaken` while a run
 * would have taken long. Whatever fails is said in out->problem. The caller frees
 * *out. */
bool engine_render(engine *e, const wish *w, shown *out);

/* What follows a picture: the numbers, and samples if they are wanted and not yet found.
 * is_stale(user) is asked now and then: true gives these up. */
void engine_complete(engine *e, shown *s, bool (*is_stale)(void *user), void *user);

#endif
