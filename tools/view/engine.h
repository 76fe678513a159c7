/* SPDX-License-Identifier: MIT */
/* engine.h: from a wish to a picture, with as little work as what changed asks for. */
#ifndef VIEW_ENGINE_H
#define VIEW_ENGINE_H

#include "estimation.h"
#include "source.h"
#include "wish.h"

typedef struct engine {
    source *source;
    truth *truth; /* NULL: none is made */
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
    char problem[PROBLEM_SIZE];
} engine;

/* `from` and t must outlive the engine. Returns an exit code; close it in any case. */
int engine_open(engine *e, source *from, truth *t, const common_settings *common,
                report *r);
void engine_close(engine *e);

/* Casts or reads the G-buffer of the wish; false if there is none. engine_render() does
 * so by itself. */
bool engine_place(engine *e, const wish *w);

/* Makes the picture; false if source->stop was set meanwhile. Whatever fails is said in
 * out->problem. The caller frees *out. */
bool engine_render(engine *e, const wish *w, shown *out);

#endif
