/* SPDX-License-Identifier: MIT */
/*
 * section_passes.c: what goes before and after the estimate, each by itself. Conversion
 * of normals, and taking them from depth, is put off until they are needed; so it is run
 * with an estimate of one pixel.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "study/study.h"

/* The near and far planes of hardware depth, in distances of the nearest and the farthest
 * surface. */
#define NEAR_SHARE 0.5f
#define FAR_SHARE  2.0f

typedef struct buffers {
    crv_context *context;
    crv_gbuffer *gbuffer; /* all of the frame but one pixel is guard band */
    crv_plan *one_pixel;
    const crv_camera *camera;
    int32_t width, height;
    float *depth, *encoded; /* width * height */
    float *normals;         /* width * height * 3, view space */
    float z_near, z_far;
} buffers;

typedef struct pass {
    buffers *of;
    const char *name;
    bool is_depth, has_normals;
    crv_depth_format format;
    crv_normal_space space;
} pass;

static bool pass_once(void *data)
{
    const pass *p = data;
    const buffers *u = p->of;
    crv_image depth = crv_image_packed(u->encoded, u->width, u->height, 1);
    crv_image normals = crv_image_packed(u->normals, u->width, u->height, 3);
    float pixel;
    crv_image result = crv_image_packed(&pixel, 1, 1, 1);

    if (p->is_depth)
        return crv_gbuffer_set_depth(u->gbuffer, 0, &depth, &p->format) == CRV_OK;
    return crv_gbuffer_set_normals(u->gbuffer, p->has_normals ? &normals : NULL, p->space)
               == CRV_OK
           && crv_plan_run(u->one_pixel, u->gbuffer, &result) == CRV_OK;
}

/* Distance of a pixel's centre from the eye, by its planar depth. */
static double radial_factor(const crv_camera *c, int32_t x, int32_t y)
{
    double u = (x + 0.5 - (double)c->cx_px) / (double)c->fx_px;
    double v = (y + 0.5 - (double)c->cy_px) / (double)c->fy_px;

    return c->projection == CRV_PERSPECTIVE ? sqrt(1.0 + u * u + v * v) : 1.0;
}

static double encode(const buffers *u, crv_depth_encoding encoding, int32_t x, int32_t y,
                     double depth)
{
    double n = (double)u->z_near, f = (double)u->z_far, share;

    if (u->camera->projection == CRV_PERSPECTIVE)
        share = isfinite(depth) ? f * (depth - n) / (depth * (f - n)) : 1.0;
    else
        share = isfinite(depth) ? (depth - n) / (f - n) : 1.0;
    switch (encoding) {
    case CRV_DEPTH_PLANAR:
        return depth;
    case CRV_DEPTH_RADIAL:
        return depth * radial_factor(u->camera, x, y);
    case CRV_DEPTH_HARDWARE:
        return share;
    case CRV_DEPTH_REVERSED:
        return 1.0 - share;
    case CRV_DEPTH_DISPARITY:
        return 1.0 / depth;
    }
    return depth;
}

static void encode_all(buffers *u, crv_depth_encoding encoding)
{
    for (int32_t y = 0; y < u->height; y++) {
        for (int32_t x = 0; x < u->width; x++) {
            size_t i = (size_t)y * (size_t)u->width + (size_t)x;
            u->encoded[i] = (float)encode(u, encoding, x, y, (double)u->depth[i]);
        }
    }
}

static void find_range(buffers *u)
{
    size_t count = (size_t)u->width * (size_t)u->height;

    u->z_near = INFINITY;
    u->z_far = 0.0f;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(u->depth[i]))
            continue;
        u->z_near = fminf(u->z_near, NEAR_SHARE * u->depth[i]);
        u->z_far = fmaxf(u->z_far, FAR_SHARE * u->depth[i]);
    }
    if (!(u->z_near < u->z_far))
        u->z_near = 1.0f, u->z_far = 2.0f;
}

/* Depth and normals as the library has them once converted. */
static bool read_planes(bench *b, const bench_frame *frame, buffers *u)
{
    crv_gbuffer *whole = NULL;
    crv_image depth = crv_image_packed(u->depth, u->width, u->height, 1);
    crv_image normals = crv_image_packed(u->normals, u->width, u->height, 3);
    bool good = report_ok(b->r, bench_frame_upload(frame, u->context, &whole), "G-buffer")
                && report_ok(b->r, crv_gbuffer_get_depth(whole, 0, &depth), "depth")
                && report_ok(b->r, crv_gbuffer_get_normals(whole, &normals), "normals");

    crv_gbuffer_destroy(whole);
    return good;
}

static bool open_buffers(bench *b, const bench_frame *frame, buffers *u)
{
    size_t count = (size_t)frame->desc.width * (size_t)frame->desc.height;
    crv_gbuffer_desc desc;
    crv_options options;

    u->width = frame->desc.width;
    u->height = frame->desc.height;
    u->camera = frame->source->path != NULL ? &frame->file.camera : &frame->cast.camera;
    u->depth = malloc(count * sizeof(float));
    u->encoded = malloc(count * sizeof(float));
    u->normals = malloc(count * 3 * sizeof(float));
    if (u->depth == NULL || u->encoded == NULL || u->normals == NULL) {
        report_no_memory(b->r);
        return false;
    }
    if (!read_planes(b, frame, u))
        return false;
    find_range(u);
    memcpy(u->encoded, u->depth, count * sizeof(float));
    crv_gbuffer_desc_init(&desc, sizeof desc, u->width, u->height);
    desc.guard_left = u->width / 2;
    desc.guard_right = u->width - 1 - desc.guard_left;
    desc.guard_top = u->height / 2;
    desc.guard_bottom = u->height - 1 - desc.guard_top;
    crv_options_init(&options, sizeof options, "ssao");
    options.filter = NULL;
    options.samples = 1;
    options.radius = frame->radius;
    return report_ok(b->r, crv_gbuffer_create(u->context, &desc, &u->gbuffer), "G-buffer")
           && report_ok(b->r, crv_gbuffer_set_camera(u->gbuffer, u->camera), "camera")
           && report_ok(b->r, crv_plan_create(u->context, &options, &desc, &u->one_pixel),
                        "plan");
}

static void close_buffers(buffers *u)
{
    crv_plan_destroy(u->one_pixel);
    crv_gbuffer_destroy(u->gbuffer);
    free(u->depth);
    free(u->encoded);
    free(u->normals);
}

void bench_add_pass(bench *b, const bench_frame *frame, const char *name, crv_isa isa,
                    int32_t threads, double bytes, const bench_time *t)
{
    const bench_stream *stream = bench_stream_of(&b->ceilings, threads);
    double pixels = (double)frame->desc.width * (double)frame->desc.height;
    cJSON *row = cJSON_CreateObject();

    cJSON_AddStringToObject(row, "frame", frame->source->name);
    cJSON_AddNumberToObject(row, "width", frame->desc.width);
    cJSON_AddNumberToObject(row, "height", frame->desc.height);
    cJSON_AddStringToObject(row, "pass", name);
    cJSON_AddStringToObject(row, "isa", bench_isa_name(b, isa));
    cJSON_AddNumberToObject(row, "threads", threads);
    bench_add_time(b, row, t, pixels);
    cJSON_AddNumberToObject(row, "streamed_bytes_per_pixel", bytes);
    study_add_number(row, "share_of_copy",
                     stream != NULL ? pixels * bytes / (1e-3 * t->ms) / stream->copy
                                    : NAN);
    bench_append(b, "passes", row);
}

static int measure_pass(bench *b, const bench_frame *frame, pass *p, crv_isa isa,
                        int32_t threads)
{
    bench_time t;
    /* A plane in and one out for every component; from depth, three planes out. */
    double bytes = p->is_depth ? 8.0 : p->has_normals ? 24.0 : 16.0;

    bench_progress(b, "%s %s, %s", frame->source->name, p->name, bench_isa_name(b, isa));
    if (!bench_time_runs(&b->clock, pass_once, p, &t))
        return bench_failed(b, p->name);
    bench_add_pass(b, frame, p->name, isa, threads, bytes, &t);
    return EXIT_DONE;
}

static int measure_conversions(bench *b, const bench_frame *frame, buffers *u,
                               crv_isa isa, int32_t threads)
{
    static const char *const names[] = {"depth, planar", "depth, radial",
                                        "depth, hardware", "depth, reversed",
                                        "depth, disparity"};
    pass given = {.of = u, .name = "normals, view space", .has_normals = true};
    pass turned = {.of = u,
                   .name = "normals, world space",
                   .has_normals = true,
                   .space = CRV_NORMAL_WORLD};
    pass from_depth = {.of = u, .name = "normals from depth"};
    int result = EXIT_DONE;

    /* The last one leaves planar depth, which the normals then come from. */
    for (int i = CRV_DEPTH_DISPARITY; i >= CRV_DEPTH_PLANAR && result == EXIT_DONE; i--) {
        pass p = {.of = u, .name = names[i], .is_depth = true};

        encode_all(u, (crv_depth_encoding)i);
        p.format = crv_depth_format_planar();
        p.format.encoding = (crv_depth_encoding)i;
        p.format.z_near = u->z_near;
        p.format.z_far = u->z_far;
        result = measure_pass(b, frame, &p, isa, threads);
    }
    if (result == EXIT_DONE)
        result = measure_pass(b, frame, &given, isa, threads);
    if (result == EXIT_DONE)
        result = measure_pass(b, frame, &turned, isa, threads);
    if (result == EXIT_DONE)
        result = measure_pass(b, frame, &from_depth, isa, threads);
    return result;
}

static int measure_frame(bench *b, const bench_frame *frame, crv_isa isa, int32_t threads)
{
    buffers u = {0};
    bench_memory memory;
    int result =
        bench_context(b, isa, threads, b->choices->exact[0], &memory, &u.context);

    if (result == EXIT_DONE)
        result = open_buffers(b, frame, &u)
                     ? measure_conversions(b, frame, &u, isa, threads)
                     : EXIT_FAILED;
    close_buffers(&u);
    crv_context_destroy(u.context);
    if (result == EXIT_DONE)
        result = bench_filter_passes(b, frame, isa, threads);
    return result;
}

static void print(const bench *b)
{
    static const bench_column columns[] = {
        {"frame", "frame", -1, 0},
        {"width", "width", 0, 0},
        {"pass", "pass", -1, 0},
        {"isa", "isa", -1, 0},
        {"thr", "threads", 0, 0},
        {"ms", "ms", 2, 0},
        {"+-", "ms_spread", 2, 0},
        {"MPix/s", "mpixels_per_s", 1, 0},
        {"ns/px", "ns_per_pixel", 3, 0},
        {"cyc/px", "cycles_per_pixel", 2, 0},
        {"% of streaming", "share_of_copy", 0, 100.0},
    };

    bench_print_list(b, "What surrounds the estimate", "passes", columns,
                     sizeof columns / sizeof columns[0]);
}

/* The first frame in every size; its passes are those of all. */
int bench_passes_section(bench *b)
{
    const bench_choices *choices = b->choices;
    int32_t sizes = b->sources[0].path != NULL ? 1 : choices->size_count;
    int result = EXIT_DONE;

    for (int32_t s = 0; s < sizes && result == EXIT_DONE; s++) {
        bench_frame frame;
        result = bench_frame_make(
            &b->sources[0], choices->sizes[s].width, choices->sizes[s].height,
            b->settings->common.threads.value, &b->quiet_logger, b->r, &frame);
        for (int32_t i = 0; i < choices->isa_count; i++)
            for (int32_t t = 0; t < choices->thread_count && result == EXIT_DONE; t++)
                result = measure_frame(b, &frame, choices->isas[i], choices->threads[t]);
        bench_frame_free(&frame);
    }
    if (result == EXIT_DONE)
        print(b);
    return result;
}
