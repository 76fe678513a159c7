/* SPDX-License-Identifier: MIT */
#include "tune.h"

#include <math.h>
#include <stdlib.h>

#include "estimate.h"
#include "metrics_fit.h"
#include "pattern_search.h"

/* The numbers of a point, by their logarithms, and its choices. If intensity and contrast
 * are both fitted, the strength is their product: they make up for each other. */
enum { RADIUS, THICKNESS, STRENGTH, CONTRAST };
enum { FALLOFF, RULE };
enum { SOLIDS = 1u << RADIUS | 1u << THICKNESS, EVERYTHING = 15u };

enum { MEMORY = 1024 };

/* With an intensity below 1 nothing is cut off at black that a curve would need. */
#define RUN_INTENSITY 0.25

/* Intensities and contrasts that are of use, and one over it. */
#define STRENGTH_MAX 16.0

/* The share of the budget after which all numbers are searched together. */
#define FIRST_SHARE 0.6

/* What a search must leave at most of the error for another to be worth it. */
#define GAIN 0.98

/* A run that was made, and what came of it. */
typedef struct memory {
    crv_options run;
    bool with_curve;
    search_point point;
} memory;

typedef struct fitter {
    const tune_request *q;
    tune_result *out;
    unsigned fits;
    int32_t count, step;   /* of the pixels that count, each step-th of the view's */
    float *result, *truth; /* theirs */
    bool with_curve;       /* intensity and contrast follow from each result */
    int32_t evaluations;   /* of this stage, at most */
    double end;            /* of this stage, report_seconds() */
    bool exhausted;        /* the budget ended a search */
    double least;          /* error so far */
    int32_t known;
    memory *memory;
} fitter;

static bool reads(const crv_method *method, const char *key)
{
    return crv_option_applies(crv_option_find(key), method, NULL) != 0;
}

static bool has_rule(const fitter *f)
{
    return (f->fits & TUNE_THICKNESS) && reads(f->q->start.method, "thickness_rule")
           && f->q->view->desc.layer_kind != CRV_LAYERS_SOLID;
}

/* Two of bitmask's rules have no number, and solid layers leave none of them any. */
static bool depends(void *user, const search_point *at, int number)
{
    const fitter *f = user;
    const crv_method *method = f->q->start.method;
    switch (number) {
    case RADIUS:
        return (f->fits & TUNE_RADIUS) != 0;
    case THICKNESS:
        if (!(f->fits & TUNE_THICKNESS) || !reads(method, "thickness"))
            return false;
        return !reads(method, "thickness_rule")
               || (has_rule(f) && at->choice[RULE] != CRV_THICKNESS_WIDTH
                   && at->choice[RULE] != CRV_THICKNESS_RUN);
    case STRENGTH:
        return (f->fits & TUNE_INTENSITY) != 0;
    default:
        return (f->fits & TUNE_CONTRAST) != 0;
    }
}

/* Four digits, which is less than matters. */
static float rounded(double logarithm)
{
    const double value = exp(logarithm);
    const double unit = pow(10.0, floor(log10(value)) - 3.0);
    return (float)(round(value / unit) * unit);
}

static double within(double value, double largest)
{
    return fmin(fmax(value, -largest), largest);
}

static double log_intensity(const fitter *f, const search_point *at)
{
    const double contrast = f->fits & TUNE_CONTRAST ? at->number[CONTRAST] : 0.0;
    return within(at->number[STRENGTH] - contrast, log(STRENGTH_MAX));
}

static void set_intensity(const fitter *f, search_point *at, double intensity)
{
    const double contrast = f->fits & TUNE_CONTRAST ? at->number[CONTRAST] : 0.0;
    at->number[STRENGTH] = within(log(intensity), log(STRENGTH_MAX)) + contrast;
}

static crv_options options_of(fitter *f, const search_point *at)
{
    crv_options o = f->q->start;
    if (depends(f, at, RADIUS))
        o.radius = rounded(at->number[RADIUS]);
    if (depends(f, at, THICKNESS))
        o.thickness = rounded(at->number[THICKNESS]);
    if (depends(f, at, STRENGTH))
        o.intensity = rounded(log_intensity(f, at));
    if (depends(f, at, CONTRAST))
        o.contrast = rounded(at->number[CONTRAST]);
    if (f->fits & TUNE_FALLOFF)
        o.falloff = (crv_falloff)at->choice[FALLOFF];
    if (has_rule(f))
        o.thickness_rule = (crv_thickness)at->choice[RULE];
    return o;
}

static search_point point_of(const search *s, const crv_options *o)
{
    const double thickness = o->thickness > 0.0f ? (double)o->thickness : INFINITY;
    search_point at = {
        .number = {[RADIUS] = log((double)o->radius),
                   [THICKNESS] = log(thickness),
                   [CONTRAST] = log((double)o->contrast)},
        .choice = {[FALLOFF] = (int32_t)o->falloff, [RULE] = (int32_t)o->thickness_rule},
        .value = INFINITY};
    set_intensity(s->user, &at, (double)o->intensity);
    for (int i = 0; i < SEARCH_NUMBERS; i++)
        at.number[i] = fmin(fmax(at.number[i], s->low[i]), s->high[i]);
    return at;
}

static bool recall(const fitter *f, const crv_options *run, search_point *at)
{
    for (int32_t i = 0; i < f->known; i++)
        if (f->memory[i].with_curve == f->with_curve
            && estimate_same_options(&f->memory[i].run, run)) {
            *at = f->memory[i].point;
            return true;
        }
    return false;
}

static void remember(fitter *f, const crv_options *run, const search_point *at)
{
    if (f->known < MEMORY)
        f->memory[f->known++] = (memory){*run, f->with_curve, *at};
}

/* The curve that brings the result nearest to the truth, into the point's numbers. */
static double fit_curve(fitter *f, const crv_options *run, search_point *at)
{
    const bool intensity = depends(f, at, STRENGTH), contrast = depends(f, at, CONTRAST);
    const unsigned what =
        (intensity ? METRICS_INTENSITY : 0u) | (contrast ? METRICS_POWER : 0u);
    metrics_curve curve = {.intensity = 1.0, .power = exp(at->number[CONTRAST])};
    if (intensity)
        curve.intensity = exp(log_intensity(f, at)) / (double)run->intensity;
    if (!metrics_fit_near(f->result, f->truth, (size_t)f->count, what, &curve))
        return INFINITY;
    if (contrast)
        at->number[CONTRAST] = within(log(curve.power), log(STRENGTH_MAX));
    if (intensity)
        set_intensity(f, at, curve.intensity * (double)run->intensity);
    return curve.rmse;
}

static double root_mean_square(const fitter *f)
{
    double sum = 0.0;
    for (int32_t i = 0; i < f->count; i++) {
        const double error = (double)f->result[i] - (double)f->truth[i];
        sum += error * error;
    }
    return sqrt(sum / f->count);
}

static void evaluate(void *user, search_point *at)
{
    fitter *f = user;
    tune_view *v = f->q->view;
    crv_options run = options_of(f, at);
    if (f->with_curve && depends(f, at, STRENGTH))
        run.intensity = (float)RUN_INTENSITY;
    if (f->with_curve)
        run.contrast = 1.0f;
    if (recall(f, &run, at))
        return;
    f->out->evaluations++;
    at->value = INFINITY;
    if (tune_view_run(v, &run) == CRV_OK) {
        for (int32_t i = 0; i < f->count; i++)
            f->result[i] = v->result[v->pixel[i * f->step]];
        at->value = f->with_curve ? fit_curve(f, &run, at) : root_mean_square(f);
    }
    remember(f, &run, at);
    f->least = fmin(f->least, at->value);
    if (f->q->watch)
        f->q->watch(f->q->user, f->out->evaluations,
                    sqrt(fmax(f->least * f->least - v->noise, 0.0)));
}

static bool stop(void *user)
{
    fitter *f = user;
    if ((f->q->stop && f->q->stop(f->q->user)) || f->out->evaluations >= f->evaluations
        || report_seconds() > f->end)
        f->exhausted = true;
    return f->exhausted;
}

/* Every other value of a choice, each with the numbers that suit it. */
static void try_choices(fitter *f, const search *s, int choice, const char *key,
                        search_point *best)
{
    const crv_option *option = crv_option_find(key);
    const int32_t current = best->choice[choice];
    const search_point from = *best;
    for (int32_t value = 0; value <= (int32_t)option->max && !stop(f); value++) {
        search_point at = from;
        at.choice[choice] = value;
        if (value == current
            || (choice == RULE && value == CRV_THICKNESS_LAYERS
                && f->q->view->desc.layers < 2))
            continue;
        evaluate(f, &at);
        if (choice == RULE)
            search_scan(s, THICKNESS, log(2.0), 1, &at);
        search_downhill(s, SOLIDS, log(1.6), log(1.2), &at);
        if (at.value < best->value)
            *best = at;
    }
}

/* Which of the methods' results a curve brings nearest to the truth. */
static void search_roughly(fitter *f, const search *s, search_point *best)
{
    f->with_curve = (f->fits & (TUNE_INTENSITY | TUNE_CONTRAST)) != 0;
    evaluate(f, best);
    search_scan(s, RADIUS, log(2.0), 3, best);
    search_scan(s, THICKNESS, log(2.0), 2, best);
    if (f->fits & TUNE_FALLOFF)
        try_choices(f, s, FALLOFF, "falloff", best);
    const int32_t rule = best->choice[RULE];
    if (has_rule(f))
        try_choices(f, s, RULE, "thickness_rule", best);
    if (best->choice[RULE] != rule && (f->fits & TUNE_FALLOFF))
        try_choices(f, s, FALLOFF, "falloff", best);
    search_downhill(s, SOLIDS, log(1.5), log(1.04), best);
}

/* All numbers, with intensity and contrast applied by the library. */
static void search_finely(fitter *f, const search *s, search_point *best)
{
    search_point start = point_of(s, &f->q->start);
    f->with_curve = false;
    f->least = INFINITY;
    evaluate(f, best);
    evaluate(f, &start);
    if (start.value < best->value)
        *best = start;
    /* Steps along the numbers stall in valleys that lie askew: longer ones go on. */
    double before;
    do {
        before = best->value;
        search_downhill(s, EVERYTHING, log(1.1), log(1.002), best);
    } while (best->value < GAIN * before && !stop(f));
}

static void begin_stage(fitter *f, double share, double start)
{
    const tune_request *q = f->q;
    f->exhausted = false;
    f->evaluations =
        q->evaluations > 0 ? (int32_t)ceil(share * q->evaluations) : INT32_MAX;
    f->end = start + share * q->seconds;
}

/* Radii of 1/64 to 64 times the start's; the rest as far as it is of use. */
static search make_search(fitter *f)
{
    const crv_option *radius = crv_option_find("radius");
    const double start = (double)f->q->start.radius;
    search s = {
        .evaluate = evaluate,
        .depends = depends,
        .stop = stop,
        .user = f,
        .low = {[RADIUS] = log(fmax(start / 64.0, radius->min)), [THICKNESS] = log(0.01)},
        .high = {[RADIUS] = log(fmin(start * 64.0, radius->max)), [THICKNESS] = log(16)},
    };
    s.high[CONTRAST] = log(STRENGTH_MAX);
    s.high[STRENGTH] = 2.0 * s.high[CONTRAST];
    s.low[STRENGTH] = -s.high[STRENGTH];
    s.low[CONTRAST] = -s.high[CONTRAST];
    return s;
}

/* Pixels of a traced truth all count; of a large picture every so many do. */
static bool take_pixels(fitter *f)
{
    const tune_view *v = f->q->view;
    f->step = v->count / TUNE_PIXELS + 1;
    f->step += f->step % 2 == 0;
    f->count = (v->count + f->step - 1) / f->step;
    f->result = malloc(((size_t)f->count + 1) * sizeof *f->result);
    f->truth = malloc(((size_t)f->count + 1) * sizeof *f->truth);
    f->memory = malloc(MEMORY * sizeof *f->memory);
    if (!f->result || !f->truth || !f->memory)
        return false;
    for (int32_t i = 0; i < f->count; i++)
        f->truth[i] = v->truth[i * f->step];
    return true;
}

static crv_status fit(fitter *f)
{
    const tune_request *q = f->q;
    tune_result *out = f->out;
    const double start = report_seconds();
    crv_status status = tune_view_measure(q->view, &q->start, &out->before);
    out->evaluations++;
    out->after = out->before;
    if (status != CRV_OK || f->fits == 0 || f->count == 0)
        return status;
    const search s = make_search(f);
    search_point best = point_of(&s, &q->start);
    begin_stage(f, FIRST_SHARE, start);
    search_roughly(f, &s, &best);
    begin_stage(f, 1.0, start);
    search_finely(f, &s, &best);
    out->finished = !f->exhausted;
    const crv_options options = options_of(f, &best);
    tune_error after;
    status = tune_view_measure(q->view, &options, &after);
    if (status == CRV_ERROR_STOPPED) { /* what the search knows of it */
        after.mean_square = f->least * f->least;
        after.rmse = sqrt(fmax(after.mean_square - q->view->noise, 0.0));
    }
    if ((status == CRV_OK || status == CRV_ERROR_STOPPED)
        && after.mean_square < out->before.mean_square) {
        out->options = options;
        out->after = after;
    }
    return CRV_OK;
}

crv_status tune_fit(const tune_request *request, tune_result *out)
{
    fitter f = {.q = request, .out = out, .least = INFINITY};
    crv_status status = CRV_ERROR_OUT_OF_MEMORY;
    *out = (tune_result){.options = request->start};
    f.fits = tune_applicable(request->fits, request->start.method);
    if (take_pixels(&f))
        status = fit(&f);
    free(f.memory);
    free(f.truth);
    free(f.result);
    return status;
}
