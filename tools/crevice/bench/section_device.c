/* SPDX-License-Identifier: MIT */
/* section_device.c: every method with every choice on a GPU, step by step, by its clock.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "common/device.h"
#include "study/study.h"

enum { RUNS_MAX = 64 };

/* The steps of a plan's runs, and the times of each. */
typedef struct steps {
    crv_device_time last[CRV_MAX_DEVICE_TIMES];
    double ms[CRV_MAX_DEVICE_TIMES][RUNS_MAX];
    int32_t count, runs;
} steps;

static int time_steps(bench *b, crv_plan *plan, crv_gbuffer *gbuffer,
                      const crv_image *image, steps *out)
{
    const double started = report_seconds();
    const int32_t wanted = b->clock.repeats < RUNS_MAX ? b->clock.repeats : RUNS_MAX;

    /* The first run compiles and warms up. */
    for (int32_t i = -1; i < wanted; i++) {
        if (!report_ok(b->r, crv_plan_run(plan, gbuffer, image), "estimation")
            || !report_ok(b->r, crv_plan_device_times(plan, out->last, &out->count),
                          "timestamps"))
            return EXIT_FAILED;
        for (int32_t s = 0; s < out->count && i >= 0; s++)
            out->ms[s][i] = out->last[s].time_ms;
        out->runs = i + 1;
        if (i >= 0 && report_seconds() - started > b->clock.seconds)
            break;
    }
    return EXIT_DONE;
}

/* A context of the device, and how its plans work. */
typedef struct device {
    crv_context *context;
    const common_settings *how;
} device;

static void append(bench *b, const bench_case *c, crv_preset preset, double factor,
                   const device *d, steps *s)
{
    const double pixels = (double)c->frame->width * (double)c->frame->height;

    for (int32_t i = 0; i < s->count; i++) {
        cJSON *row = cJSON_CreateObject();
        const double ms = bench_median(s->ms[i], s->runs);
        cJSON_AddStringToObject(row, "frame", c->frame->source->name);
        cJSON_AddNumberToObject(row, "width", c->frame->width);
        cJSON_AddNumberToObject(row, "height", c->frame->height);
        cJSON_AddStringToObject(row, "method", c->options.method->name);
        cJSON_AddStringToObject(row, "preset", crv_preset_name(preset));
        cJSON_AddStringToObject(
            row, "filter", c->options.filter != NULL ? c->options.filter->name : "none");
        cJSON_AddNumberToObject(row, "radius_factor", factor);
        cJSON_AddStringToObject(row, "layout", bench_layout_name(d->how->depth_layout));
        cJSON_AddStringToObject(row, "arithmetic",
                                d->how->half_filters ? "half" : "single");
        cJSON_AddStringToObject(row, "step", s->last[i].name);
        cJSON_AddNumberToObject(row, "runs", s->runs);
        study_add_number(row, "ms", ms);
        study_add_number(row, "mpixels_per_s", pixels / ms * 1e-3);
        bench_append(b, "device_steps", row);
    }
}

static int measure(bench *b, const device *d, const bench_case *c, crv_preset preset,
                   double factor)
{
    const size_t count = (size_t)c->frame->width * (size_t)c->frame->height;
    float *pixels = malloc(count * sizeof *pixels);
    const crv_image image =
        crv_image_packed(pixels, c->frame->width, c->frame->height, 1);
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    steps s = {0};
    int result = pixels == NULL ? report_no_memory(b->r) : EXIT_FAILED;

    bench_progress(b, "%s %s %s, %s, %s", c->frame->source->name, c->options.method->name,
                   crv_preset_name(preset),
                   c->options.filter != NULL ? c->options.filter->name : "no filter",
                   b->settings->common.device);
    if (pixels != NULL
        && report_ok(b->r, bench_frame_upload(c->frame, d->context, &gbuffer), "G-buffer")
        && report_ok(b->r,
                     crv_plan_create(d->context, &c->options, &c->frame->desc, &plan),
                     "plan"))
        result = time_steps(b, plan, gbuffer, &image, &s);
    if (result == EXIT_DONE)
        append(b, c, preset, factor, d, &s);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    free(pixels);
    return result;
}

static int run_frame(bench *b, const device *d, const bench_frame *frame)
{
    const bench_choices *o = b->choices;
    const int32_t cases =
        o->method_count * o->preset_count * o->filter_count * o->radius_count;
    int result = EXIT_DONE;

    for (int32_t i = 0; i < cases && result == EXIT_DONE; i++) {
        const int32_t k = i % o->radius_count, f = i / o->radius_count % o->filter_count,
                      p = i / o->radius_count / o->filter_count % o->preset_count,
                      m = i / o->radius_count / o->filter_count / o->preset_count;
        bench_case c;
        result = bench_case_make(b, frame, m, p, f, o->radii[k], &c);
        if (result == EXIT_DONE)
            result = measure(b, d, &c, o->presets[p], o->radii[k]);
    }
    return result;
}

static void print(const bench *b)
{
    static const bench_column columns[] = {
        {"frame", "frame", -1, 0},
        {"width", "width", 0, 0},
        {"height", "height", 0, 0},
        {"method", "method", -1, 0},
        {"preset", "preset", -1, 0},
        {"filter", "filter", -1, 0},
        {"radius", "radius_factor", 2, 0},
        {"depth", "layout", -1, 0},
        {"filter in", "arithmetic", -1, 0},
        {"step", "step", -1, 0},
        {"ms", "ms", 3, 0},
        {"MPix/s", "mpixels_per_s", 1, 0},
    };

    bench_print_list(b, "Steps on the device, by its clock: median of the runs",
                     "device_steps", columns, sizeof columns / sizeof columns[0]);
}

static int run_frames(bench *b, const device *d)
{
    const bench_choices *o = b->choices;
    int result = EXIT_DONE;

    for (int32_t i = 0; i < b->source_count && result == EXIT_DONE; i++) {
        int32_t sizes = b->sources[i].path != NULL ? 1 : o->size_count;

        for (int32_t s = 0; s < sizes && result == EXIT_DONE; s++) {
            bench_frame frame;
            result = bench_frame_make(
                &b->sources[i], o->sizes[s].width, o->sizes[s].height,
                b->settings->common.threads.value, &b->quiet_logger, b->r, &frame);
            if (result == EXIT_DONE)
                result = run_frame(b, d, &frame);
            bench_frame_free(&frame);
        }
    }
    return result;
}

/* Frames with a layout of depth and an arithmetic of filters. */
static int run_way(bench *b, crv_depth_layout layout, bool half)
{
    common_settings how = b->settings->common;
    device d = {.how = &how};
    int result;

    how.depth_layout = layout;
    how.half_filters = half;
    result = device_context(&how, &b->r->logger, b->r, &d.context);
    if (result == EXIT_DONE)
        result = run_frames(b, &d);
    crv_context_destroy(d.context);
    return result;
}

int bench_device_section(bench *b)
{
    const bench_choices *o = b->choices;
    int result = EXIT_DONE;

    for (int32_t l = 0; l < o->layout_count; l++)
        for (int32_t a = 0; a < o->arithmetic_count && result == EXIT_DONE; a++)
            result = run_way(b, o->layouts[l], o->half[a]);
    if (result == EXIT_DONE)
        print(b);
    return result;
}
