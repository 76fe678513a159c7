/* SPDX-License-Identifier: MIT */
/*
 * filter_passes.c: filters and the result. A filter takes what a run with it takes longer
 * than one without it, the two in turn, the estimate being a cheap one. The result is
 * what crv_plan_filter() takes where there is no filter: the picture in and out again.
 */
#include <stdio.h>
#include <stdlib.h>

#include "bench/bench.h"

typedef struct work {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_plan *plain, *filtered;
    crv_image image;
} work;

typedef struct one_run {
    const work *of;
    crv_plan *plan;
} one_run;

static bool run_once(void *data)
{
    const one_run *r = data;

    return crv_plan_run(r->plan, r->of->gbuffer, &r->of->image) == CRV_OK;
}

static bool copy_once(void *data)
{
    const work *w = data;

    return crv_plan_filter(w->plain, w->gbuffer, &w->image, &w->image) == CRV_OK;
}

static crv_options cheap_options(const bench_frame *frame, const crv_filter *filter)
{
    crv_options o;

    crv_options_init(&o, sizeof o, "alchemy");
    o.samples = 1;
    o.radius = frame->radius;
    o.filter = filter;
    return o;
}

static int measure_filter(bench *b, const bench_frame *frame, work *w,
                          const crv_filter *filter, crv_isa isa, int32_t threads)
{
    crv_options options = cheap_options(frame, filter);
    one_run with = {.of = w}, without = {.of = w, .plan = w->plain};
    char name[64];
    bench_time t;
    int result = EXIT_FAILED;

    snprintf(name, sizeof name, "filter %s", filter->name);
    bench_progress(b, "%s %s, %s", frame->source->name, name, bench_isa_name(b, isa));
    if (!report_ok(b->r,
                   crv_plan_create(w->context, &options, &frame->desc, &w->filtered),
                   "plan"))
        return EXIT_FAILED;
    with.plan = w->filtered;
    if (bench_time_difference(&b->clock, run_once, &with, &without, &t)) {
        /* Depth, three of normals and the estimate in, the result out. */
        bench_add_pass(b, frame, name, isa, threads, 24.0, &t);
        result = EXIT_DONE;
    } else {
        bench_failed(b, name);
    }
    crv_plan_destroy(w->filtered);
    w->filtered = NULL;
    return result;
}

static int measure_all(bench *b, const bench_frame *frame, work *w, crv_isa isa,
                       int32_t threads)
{
    one_run plain = {.of = w, .plan = w->plain};
    int result = EXIT_DONE;
    bench_time t;

    for (int32_t i = 0; i < crv_filter_count() && result == EXIT_DONE; i++)
        result = measure_filter(b, frame, w, crv_filter_at(i), isa, threads);
    if (result != EXIT_DONE)
        return result;
    if (!run_once(&plain) || !bench_time_runs(&b->clock, copy_once, w, &t))
        return bench_failed(b, "result");
    bench_add_pass(b, frame, "picture in and out", isa, threads, 16.0, &t);
    return EXIT_DONE;
}

int bench_filter_passes(bench *b, const bench_frame *frame, crv_isa isa, int32_t threads)
{
    size_t count = (size_t)frame->width * (size_t)frame->height;
    float *pixels = malloc(count * sizeof *pixels);
    work w = {.image = crv_image_packed(pixels, frame->width, frame->height, 1)};
    crv_options options = cheap_options(frame, NULL);
    bench_memory memory;
    int result;

    if (pixels == NULL)
        return report_no_memory(b->r);
    result = bench_context(b, isa, threads, b->choices->exact[0], &memory, &w.context);
    if (result == EXIT_DONE
        && !(report_ok(b->r, bench_frame_upload(frame, w.context, &w.gbuffer), "G-buffer")
             && report_ok(b->r,
                          crv_plan_create(w.context, &options, &frame->desc, &w.plain),
                          "plan")))
        result = EXIT_FAILED;
    if (result == EXIT_DONE)
        result = measure_all(b, frame, &w, isa, threads);
    crv_plan_destroy(w.plain);
    crv_gbuffer_destroy(w.gbuffer);
    crv_context_destroy(w.context);
    free(pixels);
    return result;
}
