/* SPDX-License-Identifier: MIT */
/*
 * section_embree.c: the time in which ray tracing (reference.h, Embree) would make the
 * same picture with the error that the estimate has.
 *
 * The truth is a reference of many rays. Errors are root mean squares over the surface of
 * blocks of 8x8 px that lie evenly over the picture, a small part of it; rays in them
 * are as coherent as in the whole, so that the time of the whole follows from its number
 * of pixels. The error of n rays is taken to fall as s n^-p; s and p come from what is
 * measured at two n, and tell what the truth itself errs and how many rays reach the
 * estimate's error.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "reference.h"
#include "study/study.h"

enum {
    BLOCK = 8,
    BLOCKS = 600, /* about so many in the picture */
    FEW_RAYS = 16,
    MORE_RAYS = 64,
    TRUTH_RAYS = 512
};

typedef struct blocks {
    const bench_frame *frame;
    int32_t step, columns, rows;
    size_t pixels;
} blocks;

/* What some rays come to, pixel by pixel in the order of the blocks. */
typedef struct traced {
    float *accessibility;
    double seconds;
} traced;

typedef struct law {
    double few, more, truth; /* errors */
    double exponent;
} law;

static blocks choose_blocks(const bench_frame *frame)
{
    blocks k = {.frame = frame};
    double pixels = (double)frame->width * (double)frame->height;

    k.step = (int32_t)(BLOCK * sqrt(pixels / (BLOCK * BLOCK * BLOCKS)));
    k.step = k.step < BLOCK ? BLOCK : k.step;
    k.columns = (frame->width - BLOCK) / k.step + 1;
    k.rows = (frame->height - BLOCK) / k.step + 1;
    k.pixels = (size_t)k.columns * (size_t)k.rows * BLOCK * BLOCK;
    return k;
}

/* The pixel of this place in the order of the blocks. */
static void pixel_at(const blocks *k, size_t i, int32_t *x, int32_t *y)
{
    int32_t block = (int32_t)(i / (BLOCK * BLOCK)),
            inside = (int32_t)(i % (BLOCK * BLOCK));

    *x = block % k->columns * k->step + inside % BLOCK;
    *y = block / k->columns * k->step + inside / BLOCK;
}

static bool is_surface(const blocks *k, size_t i)
{
    int32_t x, y;

    pixel_at(k, i, &x, &y);
    return isfinite(
        k->frame->cast.depth[0][(size_t)y * (size_t)k->frame->width + (size_t)x]);
}

static void trace_blocks(const blocks *k, const reference *r, int32_t threads, float *out)
{
    const int32_t count = k->columns * k->rows;

    (void)threads;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic) num_threads(threads)
#endif
    for (int32_t block = 0; block < count; block++) {
        for (size_t i = 0; i < BLOCK * BLOCK; i++) {
            size_t at = (size_t)block * BLOCK * BLOCK + i;
            int32_t x, y;

            pixel_at(k, at, &x, &y);
            out[at] = reference_pixel(r, x, y).accessibility;
        }
    }
}

static int trace(bench *b, const blocks *k, const bench_case *c, int32_t rays,
                 uint32_t seed, traced *out)
{
    study_target target = study_target_of(&c->options);
    reference_options o = {.definition = target.definition,
                           .weighting = target.weighting,
                           .falloff = target.falloff,
                           .tau = target.tau,
                           .u = target.u,
                           .radius = c->options.radius,
                           .rays = rays,
                           .normals = SCENE_NORMALS_INTERPOLATED,
                           .seed = seed};
    reference *r = NULL;
    double start;

    *out = (traced){.accessibility = malloc(k->pixels * sizeof(float))};
    if (out->accessibility == NULL)
        return report_no_memory(b->r);
    if (reference_create(k->frame->source->model, &k->frame->cast, &o, &r,
                         &b->quiet_logger)
        != 0)
        return EXIT_FAILED;
    start = report_seconds();
    trace_blocks(k, r, c->threads, out->accessibility);
    out->seconds = report_seconds() - start;
    reference_free(r);
    return EXIT_DONE;
}

/* Root mean square of the difference over the surface. */
static double difference(const blocks *k, const float *values, const traced *truth)
{
    double sum = 0.0;
    int64_t count = 0;

    for (size_t i = 0; i < k->pixels; i++) {
        double d = (double)values[i] - (double)truth->accessibility[i];
        if (!is_surface(k, i))
            continue;
        sum += d * d;
        count++;
    }
    return count > 0 ? sqrt(sum / (double)count) : NAN;
}

/* What is left of an error when that of the truth, independent of it, is taken off. */
static double without(double error, double truth)
{
    return sqrt(fmax(error * error - truth * truth, 0.0));
}

/* The truth's error hangs on the law that it is taken off for: a few rounds settle it. */
static law find_law(const blocks *k, const traced t[3])
{
    const double few = difference(k, t[0].accessibility, &t[2]);
    const double more = difference(k, t[1].accessibility, &t[2]);
    law l = {.truth = 0.0};

    for (int i = 0; i < 20; i++) {
        l.few = without(few, l.truth);
        l.more = without(more, l.truth);
        l.exponent = log(l.few / l.more) / log((double)MORE_RAYS / (double)FEW_RAYS);
        l.truth = l.more * pow((double)MORE_RAYS / (double)TRUTH_RAYS, l.exponent);
    }
    return l;
}

static double error_of_picture(const blocks *k, const float *picture, float *scratch,
                               const traced *truth, const law *l)
{
    for (size_t i = 0; i < k->pixels; i++) {
        int32_t x, y;
        pixel_at(k, i, &x, &y);
        scratch[i] = picture[(size_t)y * (size_t)k->frame->width + (size_t)x];
    }
    return without(difference(k, scratch, truth), l->truth);
}

/* Seconds for so many rays in every pixel of the picture. */
static double seconds_of(const blocks *k, const traced *more, double rays)
{
    double whole = (double)k->frame->width * (double)k->frame->height / (double)k->pixels;

    return whole * rays * more->seconds / MORE_RAYS;
}

static void add_row(bench *b, const blocks *k, const bench_case *c,
                    const bench_outcome *o, const traced *more, const law *l,
                    double error)
{
    cJSON *row = bench_row(b, c, o);
    study_target target = study_target_of(&c->options);
    /* No picture takes less than a ray. */
    double rays = fmax(1.0, FEW_RAYS * pow(l->few / error, 1.0 / l->exponent));
    double ms;

    rays = isfinite(l->exponent) && l->exponent > 0.0 ? rays : NAN;
    ms = 1e3 * seconds_of(k, more, rays);
    cJSON_AddStringToObject(row, "target", study_target_name(&target));
    study_add_number(row, "rmse", error);
    study_add_number(row, "rmse_of_16_rays", l->few);
    study_add_number(row, "rmse_of_64_rays", l->more);
    study_add_number(row, "exponent", l->exponent);
    study_add_number(row, "rays_for_same_rmse", rays);
    study_add_number(row, "ray_tracing_ms", ms);
    study_add_number(row, "rays_per_s",
                     1e3 * rays * c->frame->width * c->frame->height / ms);
    study_add_number(row, "speedup_over_ray_tracing", ms / o->time.ms);
    bench_append(b, "embree", row);
}

/* With and without the method's filter, against the same rays. */
static int compare(bench *b, const blocks *k, bench_case *c, const traced t[3],
                   float *picture, float *scratch)
{
    const crv_filter *filter = c->options.filter;
    const law l = find_law(k, t);
    int result = EXIT_DONE;

    for (int filtered = 0; filtered < 2 && result == EXIT_DONE; filtered++) {
        bench_outcome outcome;

        if (filtered && filter == NULL)
            break;
        c->options.filter = filtered ? filter : NULL;
        result = bench_measure(b, c, picture, &outcome);
        if (result == EXIT_DONE) {
            double error = error_of_picture(k, picture, scratch, &t[2], &l);
            add_row(b, k, c, &outcome, &t[1], &l, error);
        }
    }
    return result;
}

static int measure(bench *b, const blocks *k, int32_t method)
{
    static const int32_t rays[] = {FEW_RAYS, MORE_RAYS, TRUTH_RAYS};
    traced t[3] = {0};
    bench_case c;
    crv_options initial;
    size_t count = (size_t)k->frame->width * (size_t)k->frame->height;
    float *picture = malloc(count * sizeof *picture);
    float *scratch = malloc(k->pixels * sizeof *scratch);
    int result = bench_case_make(b, k->frame, method, 0, 0, 1.0, &c);

    if (result == EXIT_DONE && (picture == NULL || scratch == NULL))
        result = report_no_memory(b->r);
    if (result == EXIT_DONE) {
        crv_options_init(&initial, sizeof initial, c.options.method->name);
        crv_options_preset(&initial, b->choices->presets[0]);
        c.options.filter = initial.filter;
        bench_progress(b, "%s %s against ray tracing", k->frame->source->name,
                       c.options.method->name);
    }
    for (uint32_t i = 0; i < 3 && result == EXIT_DONE; i++)
        result = trace(b, k, &c, rays[i], 101 + i, &t[i]);
    if (result == EXIT_DONE)
        result = compare(b, k, &c, t, picture, scratch);
    for (int i = 0; i < 3; i++)
        free(t[i].accessibility);
    free(picture);
    free(scratch);
    return result;
}

static void print(const bench *b)
{
    static const bench_column columns[] = {
        {"frame", "frame", -1, 0},
        {"method", "method", -1, 0},
        {"filter", "filter", -1, 0},
        {"integral", "target", -1, 0},
        {"ms", "ms", 2, 0},
        {"RMSE", "rmse", 4, 0},
        {"rays for it", "rays_for_same_rmse", 1, 0},
        {"p", "exponent", 2, 0},
        {"ray tracing, ms", "ray_tracing_ms", 0, 0},
        {"times faster", "speedup_over_ray_tracing", 1, 0},
    };

    bench_print_list(b,
                     "Ray tracing the same picture with Embree to the same error "
                     "(extrapolated: error of n rays ~ n^-p)",
                     "embree", columns, sizeof columns / sizeof columns[0]);
}

int bench_embree_section(bench *b)
{
    int result = EXIT_DONE;

    for (int32_t i = 0; i < b->source_count && result == EXIT_DONE; i++) {
        bench_frame frame;
        blocks k;

        if (b->sources[i].path != NULL) {
            report_info(b->r, "%s: has no scene that rays could be traced in",
                        b->sources[i].path);
            continue;
        }
        result = bench_frame_make(
            &b->sources[i], b->choices->sizes[0].width, b->choices->sizes[0].height,
            b->settings->common.threads.value, &b->quiet_logger, b->r, &frame);
        if (result == EXIT_DONE)
            k = choose_blocks(&frame);
        for (int32_t m = 0; m < b->choices->method_count && result == EXIT_DONE; m++)
            result = measure(b, &k, m);
        bench_frame_free(&frame);
    }
    if (result == EXIT_DONE)
        print(b);
    return result;
}
