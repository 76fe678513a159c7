/* SPDX-License-Identifier: MIT */
/*
 * bench.h: what `crevice bench` is made of: lists of what to measure, scenes to measure
 * on, one timed run, and the row that it makes in the table and in the JSON. Calls that
 * can fail return an exit code after an error line.
 */
#ifndef TOOL_BENCH_BENCH_H
#define TOOL_BENCH_BENCH_H

#include <cjson/cJSON.h>

#include "bench/clock.h"
#include "common/args.h"
#include "passes/passes.h"
#include "scene.h"

enum { BENCH_LIST_MAX = 32 };

/* Lists are as written: "a,b", or the flag given again. */
typedef struct bench_settings {
    common_settings common;
    arg_texts inputs, methods, presets, filters, isas, structures, threads, sizes;
    arg_texts radius_factors, depth_layouts, arithmetic, sets;
    arg_int repeats;
    arg_number seconds, vfov_deg;
    bool json;
} bench_settings;

/* Indices into a table of names. */
typedef struct bench_list {
    int32_t count;
    int32_t at[BENCH_LIST_MAX];
} bench_list;

/* Indices of filters before those of the registry. */
enum { BENCH_FILTER_NONE, BENCH_FILTER_PRESET, BENCH_FILTER_FIRST };

/* Index of methods before those of the registry: a filter alone. */
enum { BENCH_METHOD_NONE, BENCH_METHOD_FIRST };

/* Everything to measure; each list holds at least one entry. */
typedef struct bench_choices {
    bench_list methods, presets, filters, isas;
    bench_list structures; /* 0: deinterleaved, 1: exact */
    bench_list threads;    /* the numbers themselves */
    bench_list layouts;    /* enum crv_depth_layout */
    bench_list arithmetic; /* 0: single, 1: half */
    int32_t size_count, factor_count;
    arg_size sizes[BENCH_LIST_MAX];
    double factors[BENCH_LIST_MAX]; /* of the scene's own radius */
} bench_choices;

int bench_choose(const bench_settings *s, bench_choices *out, report *r);

/* What the indices of these lists are called. */
extern const char *const bench_structures[2], *const bench_layouts[3];
extern const char *const bench_arithmetic[2];

/* A G-buffer in memory: a mesh framed by itself, or a renderer's frame. */
typedef struct bench_scene {
    const char *name;
    int32_t width, height; /* of the result */
    float radius;          /* scene units */
    crv_gbuffer_desc desc;
    bool is_frame;
    scene_gbuffer cast; /* if not is_frame */
    io_frame file;      /* if is_frame */
} bench_scene;

/* Whether an input is a renderer's frame, which keeps its size. */
bool bench_is_frame(const char *input);

/* Renders or loads. model: of a mesh, from bench_load_model(). Free it also after an
 * error. */
int bench_scene_make(const bench_settings *s, const char *input, const scene *model,
                     const arg_size *size, report *r, bench_scene *out);
void bench_scene_free(bench_scene *b);

/* Before any work: whether a frame can be read, and a mesh's name be right. */
int bench_check_input(const bench_settings *s, const char *input, report *r);
int bench_load_model(const char *input, scene **out, report *r);

/* Makes a G-buffer of it. */
crv_status bench_upload(const bench_scene *b, crv_context *context,
                        crv_gbuffer **gbuffer);

/* One measurement: what is run, where and how. */
typedef struct bench_case {
    const bench_scene *scene;
    crv_options options;
    bool filter_only;
    const char *preset; /* "none" if filter_only */
    double factor;      /* options.radius over the scene's own */
    int32_t isa, structure, threads, layout, arithmetic;
} bench_case;

typedef struct bench_outcome {
    bench_time time;
    double bytes;        /* held by G-buffer and plan */
    int64_t allocations; /* made by all runs together */
    /* By the device's clock, medians; count 0 on the CPU. */
    int32_t step_count;
    struct {
        const char *name;
        double ms;
    } steps[CRV_MAX_DEVICE_TIMES];
} bench_outcome;

int bench_measure(const bench_settings *s, const bench_clock *clock, const bench_case *c,
                  report *r, bench_outcome *out);

/* About how many seconds a run takes, 0 if that cannot be told. pixels: of the result's
 * size; they are overwritten. */
double bench_trial(const bench_case *c, crv_context *context, float *pixels);

/* The row of the JSON. */
cJSON *bench_row(const bench_settings *s, const bench_case *c, const bench_outcome *o);

/* The table's head, and a line of it from the JSON's row. */
void bench_print_head(bool device);
void bench_print_row(const cJSON *row, bool device);

#endif
