/* SPDX-License-Identifier: MIT */
/*
 * section_growth.c: how the time of the chosen methods grows with pixels, samples, radius
 * and threads, one at a time and the rest at the first choice, on the first frame. The
 * exponent p of time ~ x^p is fitted to all points.
 */
#include <math.h>
#include <string.h>

#include "bench/bench.h"
#include "study/study.h"

enum { POINTS_MAX = BENCH_CHOICES_MAX };

typedef struct curve {
    bench *b;
    const char *of; /* "pixels", "pixels_alone", "samples", "radius" or "threads" */
    int32_t count;
    double x[POINTS_MAX], ms[POINTS_MAX];
} curve;

static const arg_size SIZES[] = {
    {true, 426, 240},   {true, 640, 360},   {true, 1280, 720},
    {true, 1920, 1080}, {true, 3840, 2160}, {true, 7680, 4320},
};
enum {
    SIZE_COUNT = sizeof SIZES / sizeof SIZES[0],
    SIZES_BRIEF = 4,   /* without --full */
    ALONE_HEIGHT = 720 /* of the picture whose radius in pixels all others take */
};

static const double RADII[] = {0.125, 0.25, 0.5, 1.0, 2.0, 4.0};
enum { RADIUS_COUNT = sizeof RADII / sizeof RADII[0] };

static const int32_t SAMPLES[] = {4, 8, 16, 32, 64};
enum { SAMPLE_COUNT = sizeof SAMPLES / sizeof SAMPLES[0] };

static int add_point(curve *k, bench_case *c, double x)
{
    bench_outcome outcome;
    cJSON *row;
    int result;

    bench_progress(k->b, "%s over %s: %g", c->options.method->name, k->of, x);
    result = bench_measure(k->b, c, NULL, &outcome);
    if (result != EXIT_DONE || k->count == POINTS_MAX)
        return result;
    row = bench_row(k->b, c, &outcome);
    cJSON_AddStringToObject(row, "over", k->of);
    cJSON_AddNumberToObject(row, "x", x);
    bench_append(k->b, "growth", row);
    k->x[k->count] = x;
    k->ms[k->count++] = outcome.time.ms;
    return EXIT_DONE;
}

static void add_fit(const curve *k, const bench_case *c)
{
    cJSON *row = cJSON_CreateObject();
    double first = k->ms[0] / k->x[0], last = k->ms[k->count - 1] / k->x[k->count - 1];

    cJSON_AddStringToObject(row, "method", c->options.method->name);
    cJSON_AddStringToObject(row, "over", k->of);
    cJSON_AddStringToObject(row, "isa", bench_isa_name(k->b, c->isa));
    cJSON_AddStringToObject(row, "structure", bench_structure(c));
    cJSON_AddNumberToObject(row, "points", k->count);
    study_add_number(row, "from", k->x[0]);
    study_add_number(row, "to", k->x[k->count - 1]);
    study_add_number(row, "exponent", bench_exponent(k->x, k->ms, k->count));
    study_add_number(row, "ms_first", k->ms[0]);
    study_add_number(row, "ms_last", k->ms[k->count - 1]);
    if (strcmp(k->of, "threads") == 0)
        study_add_number(row, "speedup", k->ms[0] / k->ms[k->count - 1]);
    else
        study_add_number(row, "unit_cost_last_over_first", last / first);
    bench_append(k->b, "growth_fits", row);
}

static bool reads(const crv_options *o, const char *key)
{
    return crv_option_applies(crv_option_find(key), o->method, o->filter) != 0;
}

static int over_samples(bench *b, const bench_case *start)
{
    curve k = {.b = b, .of = "samples"};
    bench_case c = *start;
    int result = EXIT_DONE;

    for (int i = 0; i < SAMPLE_COUNT && result == EXIT_DONE; i++) {
        if (reads(&c.options, "directions"))
            c.options.directions = SAMPLES[i];
        else
            c.options.samples = SAMPLES[i];
        if (crv_options_check(&c.options, &b->quiet_logger) != CRV_OK)
            return EXIT_FAILED;
        result = add_point(&k, &c, study_samples(&c.options));
    }
    if (result == EXIT_DONE)
        add_fit(&k, &c);
    return result;
}

static int over_radius(bench *b, const bench_case *start)
{
    curve k = {.b = b, .of = "radius"};
    bench_case c = *start;
    int result = EXIT_DONE;

    for (int i = 0; i < RADIUS_COUNT && result == EXIT_DONE; i++) {
        c.options.radius = (float)(RADII[i] * (double)c.frame->radius);
        result = add_point(&k, &c, RADII[i]);
    }
    if (result == EXIT_DONE)
        add_fit(&k, &c);
    return result;
}

/* 1, 2, 4 ... and all. */
static int over_threads(bench *b, const bench_case *start)
{
    curve k = {.b = b, .of = "threads"};
    bench_case c = *start;
    int32_t all = b->all_threads;
    int result = EXIT_DONE;

    for (int32_t threads = 1; threads <= all && result == EXIT_DONE;
         threads = threads < all && 2 * threads > all ? all : 2 * threads) {
        c.threads = threads;
        result = add_point(&k, &c, threads);
    }
    if (result == EXIT_DONE)
        add_fit(&k, &c);
    return result;
}

static int on_one_frame(bench *b, const bench_frame *frame)
{
    int result = EXIT_DONE;

    for (int32_t m = 0; m < b->choices->method_count && result == EXIT_DONE; m++) {
        bench_case c;
        result = bench_case_make(b, frame, m, 0, 0, 1.0, &c);
        if (result == EXIT_DONE)
            result = over_samples(b, &c);
        if (result == EXIT_DONE)
            result = over_radius(b, &c);
        if (result == EXIT_DONE)
            result = over_threads(b, &c);
    }
    return result;
}

/* One method at one size, the radius the view's own times the factor. */
static int over_pixels_on(bench *b, const bench_frame *frame, int32_t method,
                          double radius_factor, bool is_last, curve *k)
{
    bench_case c;
    int result = bench_case_make(b, frame, method, 0, 0, radius_factor, &c);

    if (result == EXIT_DONE)
        result = add_point(k, &c, (double)frame->width * (double)frame->height);
    if (result == EXIT_DONE && is_last)
        add_fit(k, &c);
    return result;
}

/*
 * Frame by frame, so that only one of the large ones is held. With `pixels` the radius is
 * the same part of the picture in all, so that samples lie farther apart in memory in
 * large ones; with `pixels_alone` it is as many pixels as at ALONE_HEIGHT.
 */
static int over_pixels(bench *b)
{
    int32_t sizes = b->settings->full ? SIZE_COUNT : SIZES_BRIEF;
    curve curves[BENCH_CHOICES_MAX], alone[BENCH_CHOICES_MAX];
    int result = EXIT_DONE;

    for (int32_t m = 0; m < b->choices->method_count; m++) {
        curves[m] = (curve){.b = b, .of = "pixels"};
        alone[m] = (curve){.b = b, .of = "pixels_alone"};
    }
    for (int32_t s = 0; s < sizes && result == EXIT_DONE; s++) {
        bench_frame frame;
        const double factor = (double)ALONE_HEIGHT / SIZES[s].height;
        const bool is_last = s == sizes - 1;
        result = bench_frame_make(&b->sources[0], SIZES[s].width, SIZES[s].height,
                                  b->settings->common.threads.value, &b->quiet_logger,
                                  b->r, &frame);
        for (int32_t m = 0; m < b->choices->method_count && result == EXIT_DONE; m++) {
            result = over_pixels_on(b, &frame, m, 1, is_last, &curves[m]);
            if (result == EXIT_DONE)
                result = over_pixels_on(b, &frame, m, factor, is_last, &alone[m]);
        }
        bench_frame_free(&frame);
    }
    return result;
}

static void print(const bench *b)
{
    static const bench_column points[] = {
        {"method", "method", -1, 0},
        {"over", "over", -1, 0},
        {"", "x", 3, 0},
        {"isa", "isa", -1, 0},
        {"", "structure", -1, 0},
        {"thr", "threads", 0, 0},
        {"ms", "ms", 2, 0},
        {"+-", "ms_spread", 2, 0},
        {"MPix/s", "mpixels_per_s", 1, 0},
        {"ns/px/smp", "ns_per_pixel_sample", 3, 0},
    };
    static const bench_column fits[] = {
        {"method", "method", -1, 0},
        {"time over", "over", -1, 0},
        {"isa", "isa", -1, 0},
        {"", "structure", -1, 0},
        {"from", "from", 3, 0},
        {"to", "to", 3, 0},
        {"exponent", "exponent", 3, 0},
        {"cost per unit, last over first", "unit_cost_last_over_first", 3, 0},
        {"speed-up", "speedup", 2, 0},
    };

    bench_print_list(b, "Growth", "growth", points, sizeof points / sizeof points[0]);
    bench_print_list(b, "Fitted exponents: time ~ x^p", "growth_fits", fits,
                     sizeof fits / sizeof fits[0]);
}

int bench_growth_section(bench *b)
{
    bench_frame frame;
    int result;

    result = bench_frame_make(
        &b->sources[0], b->choices->sizes[0].width, b->choices->sizes[0].height,
        b->settings->common.threads.value, &b->quiet_logger, b->r, &frame);
    if (result == EXIT_DONE)
        result = on_one_frame(b, &frame);
    bench_frame_free(&frame);
    if (result == EXIT_DONE && b->sources[0].path == NULL)
        result = over_pixels(b);
    else if (result == EXIT_DONE)
        report_info(b->r, "%s: has one size; growth with pixels wants a scene",
                    b->sources[0].path);
    if (result == EXIT_DONE)
        print(b);
    return result;
}
