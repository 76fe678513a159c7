/* SPDX-License-Identifier: MIT */
/* section_methods.c: every method with every choice, on every frame. */
#include <math.h>
#include <string.h>

#include "bench/bench.h"
#include "study/study.h"

/* What rows must have in common for one to be the plain code's time of the other. */
static bool same_work(const cJSON *a, const cJSON *b)
{
    static const char *const keys[] = {"frame",  "width",   "height", "method", "preset",
                                       "filter", "threads", "radius", "samples"};

    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        if (!cJSON_Compare(cJSON_GetObjectItemCaseSensitive(a, keys[i]),
                           cJSON_GetObjectItemCaseSensitive(b, keys[i]), 1))
            return false;
    return true;
}

static double number_of(const cJSON *row, const char *key)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(row, key);

    return cJSON_IsNumber(value) ? value->valuedouble : NAN;
}

/* Once all are there: which comes first does not matter. */
static void add_speed_ups(const cJSON *rows)
{
    for (cJSON *row = rows != NULL ? rows->child : NULL; row != NULL; row = row->next) {
        double scalar = NAN;

        for (const cJSON *other = rows->child; other != NULL; other = other->next) {
            const cJSON *isa = cJSON_GetObjectItemCaseSensitive(other, "isa");
            if (strcmp(isa->valuestring, "scalar") == 0 && same_work(row, other))
                scalar = number_of(other, "ms");
        }
        study_add_number(row, "speedup_over_scalar", scalar / number_of(row, "ms"));
    }
}

static int measure(bench *b, bench_case *c, crv_preset preset)
{
    bench_outcome outcome;
    cJSON *row;
    int result;

    bench_progress(b, "%s %s %s, %s, %s %s, %d thread%s", c->frame->source->name,
                   c->options.method->name, crv_preset_name(preset),
                   c->options.filter != NULL ? c->options.filter->name : "no filter",
                   bench_isa_name(b, c->isa), bench_structure(c), c->threads,
                   c->threads == 1 ? "" : "s");
    result = bench_measure(b, c, NULL, &outcome);
    if (result != EXIT_DONE)
        return result;
    row = bench_row(b, c, &outcome);
    cJSON_AddStringToObject(row, "preset", crv_preset_name(preset));
    bench_append(b, "methods", row);
    return EXIT_DONE;
}

/* The plain code has one structure only. */
static int run_devices(bench *b, bench_case *c, crv_preset preset)
{
    const bench_choices *choices = b->choices;
    int result = EXIT_DONE;

    for (int32_t i = 0; i < choices->isa_count; i++) {
        for (int32_t s = 0; s < choices->structure_count; s++) {
            if (choices->isas[i] == CRV_ISA_SCALAR && s > 0)
                continue;
            for (int32_t t = 0; t < choices->thread_count && result == EXIT_DONE; t++) {
                c->isa = choices->isas[i];
                c->exact = choices->exact[s];
                c->threads = choices->threads[t];
                result = measure(b, c, preset);
            }
        }
    }
    return result;
}

static int run_frame(bench *b, const bench_frame *frame)
{
    const bench_choices *choices = b->choices;
    int result = EXIT_DONE;

    for (int32_t m = 0; m < choices->method_count; m++) {
        for (int32_t p = 0; p < choices->preset_count; p++) {
            for (int32_t f = 0; f < choices->filter_count; f++) {
                for (int32_t k = 0; k < choices->radius_count && result == EXIT_DONE;
                     k++) {
                    bench_case c;
                    result = bench_case_make(b, frame, m, p, f, choices->radii[k], &c);
                    if (result == EXIT_DONE)
                        result = run_devices(b, &c, choices->presets[p]);
                }
            }
        }
    }
    return result;
}

static void print(const bench *b)
{
    static const bench_column columns[] = {
        {"frame", "frame", -1, 0},
        {"width", "width", 0, 0},
        {"method", "method", -1, 0},
        {"preset", "preset", -1, 0},
        {"filter", "filter", -1, 0},
        {"isa", "isa", -1, 0},
        {"", "structure", -1, 0},
        {"thr", "threads", 0, 0},
        {"radius", "radius_factor", 2, 0},
        {"ms", "ms", 2, 0},
        {"+-", "ms_spread", 2, 0},
        {"MPix/s", "mpixels_per_s", 1, 0},
        {"ns/px/smp", "ns_per_pixel_sample", 3, 0},
        {"cyc/px/smp", "cycles_per_pixel_sample", 2, 0},
        {"x scalar", "speedup_over_scalar", 1, 0},
        {"% load", "share_of_load", 0, 100.0},
    };

    bench_print_list(b,
                     "Methods: median of the runs, half the distance of the quartiles; "
                     "share of the rate of contiguous loads",
                     "methods", columns, sizeof columns / sizeof columns[0]);
}

int bench_methods_section(bench *b)
{
    const bench_choices *choices = b->choices;
    int result = EXIT_DONE;

    for (int32_t i = 0; i < b->source_count; i++) {
        int32_t sizes = b->sources[i].path != NULL ? 1 : choices->size_count;

        for (int32_t s = 0; s < sizes && result == EXIT_DONE; s++) {
            bench_frame frame;
            result = bench_frame_make(
                &b->sources[i], choices->sizes[s].width, choices->sizes[s].height,
                b->settings->common.threads.value, &b->quiet_logger, b->r, &frame);
            if (result == EXIT_DONE)
                result = run_frame(b, &frame);
            bench_frame_free(&frame);
        }
    }
    add_speed_ups(cJSON_GetObjectItemCaseSensitive(b->results, "methods"));
    if (result == EXIT_DONE)
        print(b);
    return result;
}
