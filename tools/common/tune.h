/* SPDX-License-Identifier: MIT */
/*
 * tune.h: fits options of a method to the truth of a view.
 *
 * Radius, thickness and the two choices are searched; intensity and contrast follow from
 * each result in closed form, nearly: the library applies them before the filter. In the
 * end all numbers are searched together, with them where they belong.
 */
#ifndef TOOL_TUNE_H
#define TOOL_TUNE_H

#include "tune_view.h"

/* What is fitted, as bits. */
enum {
    TUNE_RADIUS = 1,
    TUNE_THICKNESS = 2, /* and thickness_rule, if the method has it */
    TUNE_FALLOFF = 4,
    TUNE_CONTRAST = 8,
    /* Beside contrast it gains next to nothing, and less on views that are not fitted. */
    TUNE_INTENSITY = 16,
    TUNE_USUAL = 15,
    TUNE_ALL = 31
};

/* "radius,contrast" to bits; 0 if a word is none of the five. */
unsigned tune_parse(const char *words);

/* Those of the bits that this method reads. */
unsigned tune_applicable(unsigned fits, const crv_method *method);

/* The words of the bits, ", " between them. Returns out. */
const char *tune_words(unsigned fits, char out[64]);

typedef struct tune_result {
    crv_options options;
    tune_error before, after;
    int32_t evaluations; /* runs of the method */
    bool finished;       /* the search came to its end before the budget's */
} tune_result;

typedef struct tune_request {
    tune_view *view; /* with its truth */
    crv_options start;
    unsigned fits;
    int32_t evaluations; /* at most, about; 0: any number */
    double seconds;      /* at most, about; INFINITY: any time */
    /* After each run: how many, and the least error so far. NULL: nobody is told. */
    void (*watch)(void *user, int32_t evaluations, double rmse);
    bool (*stop)(void *user); /* asked now and then: true ends it. NULL: never */
    void *user;
} tune_request;

/* The options are never worse than those of the start. With `evaluations` and without a
 * limit of time the result is always the same. Errors: those of the first run, and no
 * memory. */
crv_status tune_fit(const tune_request *request, tune_result *out);

#endif
