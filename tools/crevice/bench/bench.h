/* SPDX-License-Identifier: MIT */
/*
 * bench.h: what the sections of `crevice bench` measure with: the choices that the user
 * made, frames to work on, contexts that count their memory, and timed runs. A section
 * appends rows to a list of b->results and prints them as a table. Calls that can fail
 * return an exit code after an error line.
 */
#ifndef TOOL_BENCH_BENCH_H
#define TOOL_BENCH_BENCH_H

#include <cjson/cJSON.h>

#include "common/args.h"
#include "bench/ceilings.h"
#include "bench/clock.h"
#include "bench/frames.h"

enum { BENCH_CHOICES_MAX = 32 };

typedef struct bench_settings {
    common_settings common;
    arg_texts inputs, methods, presets, filters, isas, structures, threads, sizes, radii,
        layouts, arithmetic;
    arg_texts views_named, sets, only;
    const char *views, *json;
    arg_int repeats;
    arg_number seconds, vfov_deg;
    bool full;
} bench_settings;

/* The lists, parsed; every one holds at least one entry. */
typedef struct bench_choices {
    int32_t method_count, preset_count, filter_count, isa_count, structure_count;
    int32_t thread_count, size_count, radius_count, section_count;
    int32_t layout_count, arithmetic_count;
    const crv_method *methods[BENCH_CHOICES_MAX];
    crv_preset presets[BENCH_CHOICES_MAX];
    /* NULL in filters: none; use_preset_filter: whatever the preset brings. */
    struct {
        bool use_preset_filter;
        const crv_filter *filter;
    } filters[BENCH_CHOICES_MAX];
    crv_isa isas[BENCH_CHOICES_MAX];
    bool exact[BENCH_CHOICES_MAX];
    int32_t threads[BENCH_CHOICES_MAX];
    arg_size sizes[BENCH_CHOICES_MAX];
    double radii[BENCH_CHOICES_MAX]; /* factors of the frame's own radius */
    /* Of a GPU only: how depth lies, and whether filters compute in half floats. */
    crv_depth_layout layouts[BENCH_CHOICES_MAX];
    bool half[BENCH_CHOICES_MAX];
    const char *sections[BENCH_CHOICES_MAX];
    const char *const *all_sections; /* NULL-terminated */
} bench_choices;

/* Parses and checks the lists. EXIT_USAGE after an error line. */
int bench_choose(const bench_settings *s, const char *const *section_names,
                 bench_choices *out, report *r);

typedef struct bench {
    report *r;
    const bench_settings *settings;
    const bench_choices *choices;
    cJSON *results;
    bench_clock clock;
    bench_ceilings ceilings;
    bench_source *sources;
    int32_t source_count;
    int32_t all_threads; /* of the machine, or of --threads */
    bool print;          /* tables to stdout */
    crv_logger quiet_logger;
    double started;
} bench;

/* What the library holds through the allocator hook. */
typedef struct bench_memory {
    double bytes, peak;
    int64_t calls; /* of allocate */
} bench_memory;

typedef struct bench_case {
    const bench_frame *frame;
    crv_options options;
    crv_isa isa;
    int32_t threads;
    bool exact;
} bench_case;

typedef struct bench_outcome {
    bench_time time;
    double bytes;            /* held by G-buffer and plan */
    int64_t run_allocations; /* made by all runs together */
} bench_outcome;

/* The case of these choices, by their indices; the frame's radius times the factor. */
int bench_case_make(bench *b, const bench_frame *frame, int32_t method, int32_t preset,
                    int32_t filter, double radius_factor, bench_case *out);

/* A context that counts into *memory, which must outlive it. */
int bench_context(bench *b, crv_isa isa, int32_t threads, bool exact,
                  bench_memory *memory, crv_context **out);

/* Times crv_plan_run(). result: of the frame's result size, NULL: not wanted. */
int bench_measure(bench *b, const bench_case *c, float *result, bench_outcome *out);

/* Sees to it that an error line has been written, and returns EXIT_FAILED. */
int bench_failed(bench *b, const char *doing);

/* What computes, in tables: the instruction set, or the device where that is no CPU. */
const char *bench_isa_name(const bench *b, crv_isa isa);

/* "fast" or "exact": the plain code has no other structure. */
const char *bench_structure(const bench_case *c);

/* A row of the case: what was chosen, its times and the rates that follow from them. */
cJSON *bench_row(bench *b, const bench_case *c, const bench_outcome *o);

/* Times and rates of any work on so many pixels. */
void bench_add_time(const bench *b, cJSON *row, const bench_time *t, double pixels);

/* A row of the list "passes": so many bytes a pixel that have to be read and written. */
void bench_add_pass(bench *b, const bench_frame *frame, const char *name, crv_isa isa,
                    int32_t threads, double bytes, const bench_time *t);

/* A row more in the list of that name, made where it is missing. */
void bench_append(bench *b, const char *list, cJSON *row);

/* A column of a printed table: a member of the rows. digits: after the point, -1: text.
 * scale: what a number is multiplied by. */
typedef struct bench_column {
    const char *heading, *key;
    int digits;
    double scale;
} bench_column;

void bench_print(const bench *b, const char *title, const cJSON *rows,
                 const bench_column *columns, int32_t count);
void bench_print_list(const bench *b, const char *title, const char *list,
                      const bench_column *columns, int32_t count);

void bench_progress(bench *b, const char *format, ...) REPORT_PRINTF;

/* The slope of a line through log x and log y: p where y grows as x^p. NAN with fewer
 * than two different x. */
double bench_exponent(const double *x, const double *y, int32_t count);

/* "plain", "apart", "levels". */
const char *bench_layout_name(crv_depth_layout layout);

/* The sections. */
int bench_ceilings_section(bench *b);
int bench_methods_section(bench *b);
int bench_passes_section(bench *b);
int bench_filter_passes(bench *b, const bench_frame *frame, crv_isa isa, int32_t threads);
int bench_memory_section(bench *b);
int bench_growth_section(bench *b);
int bench_embree_section(bench *b);
int bench_whole_section(bench *b);
/* Instead of all the others, with --device vulkan. */
int bench_device_section(bench *b);

#endif
