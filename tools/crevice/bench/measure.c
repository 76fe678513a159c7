/* SPDX-License-Identifier: MIT */
/* measure.c: one measurement, with a context of its own that counts its memory. */
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "common/device.h"
#include "common/progress.h"
#include "system/interrupt.h"
#include "system/memory.h"

enum { STEP_RUNS_MAX = 64 };

typedef struct memory {
    double bytes;  /* held */
    int64_t calls; /* of allocate */
} memory;

static void *count_allocate(void *user, size_t size, size_t alignment)
{
    memory *m = user;
    void *bytes = memory_aligned(size, alignment);
    m->calls++;
    if (bytes)
        m->bytes += (double)size;
    return bytes;
}

static void count_release(void *user, void *bytes, size_t size)
{
    memory *m = user;
    m->bytes -= (double)size;
    memory_release(bytes);
}

/* watch: who is told of its runs, or NULL. */
static int open_context(const bench_settings *s, const bench_case *c, memory *m,
                        const crv_progress *watch, report *r, crv_context **out)
{
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = report_errors_only(r);
    desc.allocator = (crv_allocator){count_allocate, count_release, m};
    common_settings common = s->common;
    common.threads = (arg_int){true, c->threads};
    common.depth_layout = c->layout;
    common.half_filters = c->arithmetic == 1;
    if (device_is_cpu(&common)) {
        common.isa = crv_isa_name((crv_isa)c->isa);
        common.exact = c->structure == 1;
    }
    if (watch)
        desc.progress = *watch;
    return device_context_in(&common, &desc, r, out);
}

typedef struct running {
    const bench_case *of;
    crv_plan *plan;
    crv_gbuffer *gbuffer;
    crv_image image;
    bool on_device;
    int32_t runs, step_count; /* runs: whose steps were read */
    crv_device_time steps[CRV_MAX_DEVICE_TIMES];
    double step_ms[CRV_MAX_DEVICE_TIMES][STEP_RUNS_MAX];
} running;

/* The first run compiles and warms up; its steps are overwritten by the second's. */
static bool read_steps(running *w)
{
    if (crv_plan_device_times(w->plan, w->steps, &w->step_count) != CRV_OK)
        return false;
    const int32_t slot = w->runs < 2 ? 0 : w->runs - 1;
    for (int32_t i = 0; i < w->step_count && slot < STEP_RUNS_MAX; i++)
        w->step_ms[i][slot] = w->steps[i].time_ms;
    w->runs++;
    return true;
}

static bool run_once(void *data)
{
    running *w = data;
    const crv_const_image estimate = crv_image_const(w->image);
    if (interrupt_waits())
        return false;
    if (w->of->filter_only)
        return crv_plan_filter(w->plan, w->gbuffer, &estimate, &w->image) == CRV_OK;
    return crv_plan_run(w->plan, w->gbuffer, &w->image) == CRV_OK
           && (!w->on_device || read_steps(w));
}

static void take_steps(running *w, bench_outcome *out)
{
    const int32_t timed = w->runs > 1 ? w->runs - 1 : w->runs;
    const int32_t count = timed < STEP_RUNS_MAX ? timed : STEP_RUNS_MAX;
    out->step_count = w->step_count;
    for (int32_t i = 0; i < w->step_count; i++) {
        out->steps[i].name = w->steps[i].name;
        out->steps[i].ms = bench_median(w->step_ms[i], count);
    }
}

static int run_case(const bench_clock *clock, crv_context *context, const memory *m,
                    running *w, report *r, bench_outcome *out)
{
    const bench_case *c = w->of;
    if (!report_ok(r, bench_upload(c->scene, context, &w->gbuffer), "G-buffer")
        || !report_ok(r, crv_plan_create(context, &c->options, &c->scene->desc, &w->plan),
                      "plan"))
        return EXIT_FAILED;
    out->bytes = m->bytes;
    const int64_t before = m->calls;
    if (!bench_time_runs(clock, run_once, w, &out->time)) {
        if (r->errors == 0)
            report_error(r,
                         interrupt_waits() ? "bench: interrupted" : "estimation: failed");
        return EXIT_FAILED;
    }
    out->allocations = m->calls - before;
    take_steps(w, out);
    return EXIT_DONE;
}

/* Runs that take longer than this are watched, and so ended by a signal: for shorter ones
 * it can wait. */
#define WATCHED_SECONDS 0.5

static int32_t watch_run(void *user, int32_t done, int32_t total)
{
    const crv_progress shown = progress_runs(user);
    shown.fn(shown.user, done, total);
    return interrupt_waits();
}

static int32_t stop_trial(void *user, int32_t done, int32_t total)
{
    (void)user;
    (void)done;
    (void)total;
    return interrupt_waits();
}

/* Announces runs that take long. */
static int announce(const bench_settings *s, const bench_case *c, float *pixels,
                    report *r, bool *is_long)
{
    crv_context *context = NULL;
    memory m = {0};
    const crv_progress stops = {.fn = stop_trial};
    if (!device_is_cpu(&s->common))
        return EXIT_DONE;
    const int result = open_context(s, c, &m, &stops, r, &context);
    if (result != EXIT_DONE)
        return result;
    const double seconds = bench_trial(c, context, pixels);
    crv_context_destroy(context);
    progress_announce(
        r, c->filter_only ? c->options.filter->name : c->options.method->name, seconds);
    *is_long = seconds > WATCHED_SECONDS;
    return EXIT_DONE;
}

int bench_measure(const bench_settings *s, const bench_clock *clock, const bench_case *c,
                  report *r, bench_outcome *out)
{
    const size_t count = (size_t)c->scene->width * (size_t)c->scene->height;
    float *pixels = malloc(count * sizeof *pixels);
    running *w = calloc(1, sizeof *w);
    crv_context *context = NULL;
    memory m = {0};
    bool is_long = false;
    progress p = progress_begin(r, "run", 0, 0);
    const crv_progress watch = {watch_run, &p};
    *out = (bench_outcome){0};
    int result = pixels && w ? EXIT_DONE : report_no_memory(r);
    if (result == EXIT_DONE) {
        memset(pixels, 0, count * sizeof *pixels); /* touches the pages */
        result = announce(s, c, pixels, r, &is_long);
    }
    if (result == EXIT_DONE)
        result = open_context(s, c, &m, is_long ? &watch : NULL, r, &context);
    if (result == EXIT_DONE) {
        w->of = c;
        w->on_device = !device_is_cpu(&s->common) && !c->filter_only;
        w->image = crv_image_packed(pixels, c->scene->width, c->scene->height, 1);
        p.start = report_seconds();
        result = run_case(clock, context, &m, w, r, out);
        progress_end(&p);
    }
    if (w) {
        crv_plan_destroy(w->plan);
        crv_gbuffer_destroy(w->gbuffer);
    }
    crv_context_destroy(context);
    free(w);
    free(pixels);
    return result;
}
