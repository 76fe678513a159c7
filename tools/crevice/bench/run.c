/* SPDX-License-Identifier: MIT */
/* run.c: contexts that count their memory, and timed runs of the library. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "common/device.h"
#include "study/study.h"

/* The size stands before what the caller gets, so that releasing needs no table. */
static void *count_allocate(void *user, size_t size, size_t alignment)
{
    bench_memory *m = user;
    size_t whole = (size + alignment - 1) / alignment * alignment;
    void *memory = whole < size ? NULL : aligned_alloc(alignment, whole);

    m->calls++;
    if (memory == NULL)
        return NULL;
    m->bytes += (double)size;
    m->peak = fmax(m->peak, m->bytes);
    return memory;
}

static void count_release(void *user, void *memory, size_t size)
{
    bench_memory *m = user;

    m->bytes -= (double)size;
    free(memory);
}

int bench_context(bench *b, crv_isa isa, int32_t threads, bool exact,
                  bench_memory *memory, crv_context **out)
{
    common_settings common = b->settings->common;
    const crv_allocator allocator = {count_allocate, count_release, memory};

    *memory = (bench_memory){0};
    common.threads = (arg_int){true, threads};
    if (device_is_cpu(&common)) {
        common.isa = (arg_int){true, (int32_t)isa + 1};
        common.exact = exact;
    }
    return device_context_in(&common, &b->quiet_logger, &allocator, b->r, out);
}

/* --set KEY=VALUE, where the method reads that; cmd_bench.c has checked the keys. */
static int set_options(bench *b, crv_options *o)
{
    for (int32_t i = 0; i < b->settings->sets.count; i++) {
        const char *given = b->settings->sets.value[i], *equals = strchr(given, '=');
        char key[64] = "";
        const crv_option *option;

        memcpy(key, given, (size_t)(equals - given));
        option = crv_option_find(key);
        if (!crv_option_applies(option, o->method, o->filter))
            continue;
        if (crv_options_set(o, option->key, equals + 1, &b->r->logger) != CRV_OK)
            return EXIT_USAGE;
    }
    return EXIT_DONE;
}

int bench_case_make(bench *b, const bench_frame *frame, int32_t method, int32_t preset,
                    int32_t filter, double radius_factor, bench_case *out)
{
    const bench_choices *c = b->choices;
    int result;

    *out = (bench_case){.frame = frame,
                        .isa = c->isas[0],
                        .threads = c->threads[0],
                        .exact = c->exact[0]};
    crv_options_init(&out->options, sizeof out->options, c->methods[method]->name);
    crv_options_preset(&out->options, c->presets[preset]);
    if (!c->filters[filter].use_preset_filter)
        out->options.filter = c->filters[filter].filter;
    out->options.radius = (float)(radius_factor * (double)frame->radius);
    result = set_options(b, &out->options);
    if (result == EXIT_DONE
        && crv_options_check(&out->options, &b->quiet_logger) != CRV_OK)
        result = EXIT_USAGE;
    return result;
}

typedef struct running {
    crv_plan *plan;
    crv_gbuffer *gbuffer;
    const crv_image *image;
} running;

static bool run_once(void *data)
{
    running *r = data;

    return crv_plan_run(r->plan, r->gbuffer, r->image) == CRV_OK;
}

static int run_case(bench *b, const bench_case *c, crv_context *context,
                    const bench_memory *memory, const crv_image *image,
                    bench_outcome *out)
{
    running work = {.image = image};
    int result = EXIT_FAILED;
    int64_t before;

    if (report_ok(b->r, bench_frame_upload(c->frame, context, &work.gbuffer), "G-buffer")
        && report_ok(b->r,
                     crv_plan_create(context, &c->options, &c->frame->desc, &work.plan),
                     "plan")) {
        out->bytes = memory->bytes;
        before = memory->calls;
        if (bench_time_runs(&b->clock, run_once, &work, &out->time))
            result = EXIT_DONE;
        else
            bench_failed(b, "estimation");
        out->run_allocations = memory->calls - before;
    }
    crv_plan_destroy(work.plan);
    crv_gbuffer_destroy(work.gbuffer);
    return result;
}

int bench_measure(bench *b, const bench_case *c, float *result_pixels, bench_outcome *out)
{
    size_t count = (size_t)c->frame->width * (size_t)c->frame->height;
    float *pixels =
        result_pixels != NULL ? result_pixels : malloc(count * sizeof *pixels);
    crv_image image = crv_image_packed(pixels, c->frame->width, c->frame->height, 1);
    crv_context *context = NULL;
    bench_memory memory;
    int result;

    *out = (bench_outcome){0};
    if (pixels == NULL)
        return report_no_memory(b->r);
    memset(pixels, 0, count * sizeof *pixels); /* pages that are there already */
    result = bench_context(b, c->isa, c->threads, c->exact, &memory, &context);
    if (result == EXIT_DONE)
        result = run_case(b, c, context, &memory, &image, out);
    crv_context_destroy(context);
    if (result_pixels == NULL)
        free(pixels);
    return result;
}

int bench_failed(bench *b, const char *doing)
{
    if (b->r->errors == 0)
        report_error(b->r, "%s: failed", doing);
    return EXIT_FAILED;
}

const char *bench_isa_name(const bench *b, crv_isa isa)
{
    const common_settings *common = &b->settings->common;

    return device_is_cpu(common) ? crv_isa_name(isa) : common->device;
}

const char *bench_structure(const bench_case *c)
{
    return c->exact || c->isa == CRV_ISA_SCALAR ? "exact" : "fast";
}
