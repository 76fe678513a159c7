/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "claims_measure.h"
#include "claims_relief_truth.h"
#include "claims_vao.h"

enum { VAO, CONTAINMENT, METHODS, KINDS = 3, ROUNDS = 5 };
#define RELIEF_RADIUS 0.3f
#define RELIEF_HEIGHT 0.1

static const char *const methods[METHODS] = {"vao", "containment"};
/* In the order of crv_characteristic. */
static const char *const kinds[KINDS] = {"both", "depth buffer", "height field"};

/* A picture of the built-in scene for height maps, with the library's objects. */
typedef struct relief_view {
    study *s;
    scene_gbuffer g;
    int32_t width, height;
    uint8_t *mask;
    crv_gbuffer *gbuffer;
} relief_view;

static void close_view(relief_view *v)
{
    crv_gbuffer_destroy(v->gbuffer);
    scene_gbuffer_free(&v->g);
    free(v->mask);
}

static int fill_view(relief_view *v, const relief_map *map)
{
    const scene_gbuffer *g = &v->g;
    int32_t width = g->desc.width, height = g->desc.height;
    report *r = v->s->r;
    crv_height_field field = {
        .uv = crv_const_image_packed(g->uv, width, height, 2),
        .tangent = crv_const_image_packed(g->tangent, width, height, 3),
        .bitangent = crv_const_image_packed(g->bitangent, width, height, 3),
        .height = crv_const_image_packed(map->texels, RELIEF_TEXELS, RELIEF_TEXELS, 1),
        .scale = (float)map->scale,
        .wrap = CRV_WRAP_REPEAT,
    };

    return report_ok(r, scene_gbuffer_upload(g, v->s->context, &v->gbuffer), "G-buffer")
                   && report_ok(r, crv_gbuffer_set_height_field(v->gbuffer, &field),
                                "height field")
               ? EXIT_DONE
               : EXIT_FAILED;
}

/* Close it, also after an error. */
static int open_view(relief_view *v, study *s, const scene *model,
                     const scene_view *camera, const relief_map *map)
{
    const study_view *main = s->main;
    /* The map has its own detail; more pixels than this show no more of it. */
    double shrink = fmin(0.5, 480.0 / main->width);
    scene_gbuffer_request request = {
        .view = *camera, .layers = 1, .threads = s->threads, .texture_frames = true};
    size_t count;

    *v = (relief_view){.s = s};
    v->width = request.width = (int32_t)fmax(32.0, main->width * shrink);
    v->height = request.height = (int32_t)fmax(18.0, main->height * shrink);
    request.guard_px = (v->height + 9) / 10;
    count = (size_t)v->width * (size_t)v->height;
    if (scene_render_gbuffer(model, &request, &v->g, &s->r->logger) != 0)
        return EXIT_FAILED;
    v->mask = malloc(count);
    if (v->mask == NULL)
        return report_no_memory(s->r);
    for (size_t i = 0; i < count; i++) {
        size_t row = i / (size_t)v->width + (size_t)request.guard_px;
        size_t column = i % (size_t)v->width + (size_t)request.guard_px;

        v->mask[i] = isfinite(v->g.depth[0][row * (size_t)v->g.desc.width + column]) != 0;
    }
    return fill_view(v, map);
}

static crv_options relief_options(const study *s, int method, int kind, int32_t samples)
{
    crv_options o = measure_cubic(s->main, methods[method], samples);

    o.radius = RELIEF_RADIUS;
    o.characteristic = (crv_characteristic)kind;
    return o;
}

/* *picture gets width * height floats; free() it, also after an error. ms may be NULL. */
static int run_view(const relief_view *v, const crv_options *options, float **picture,
                    double *ms)
{
    report *r = v->s->r;
    crv_plan *plan = NULL;
    crv_image image;
    double start;
    bool done;

    *picture = malloc((size_t)v->width * (size_t)v->height * sizeof **picture);
    if (*picture == NULL)
        return report_no_memory(r);
    image = crv_image_packed(*picture, v->width, v->height, 1);
    done =
        report_ok(r, crv_plan_create(v->s->context, options, &v->g.desc, &plan), "plan");
    start = report_seconds();
    done = done && report_ok(r, crv_plan_run(plan, v->gbuffer, &image), "estimation");
    if (ms != NULL)
        *ms = 1000.0 * (report_seconds() - start);
    crv_plan_destroy(plan);
    return done ? EXIT_DONE : EXIT_FAILED;
}

/* The rays' truth at every pixel, from its texture coordinates. */
typedef struct truths {
    float *cubic, *sphere;
} truths;

static int trace_view(const relief_view *v, const relief_map *map, truths *out)
{
    size_t count = (size_t)v->width * (size_t)v->height;

    out->cubic = malloc(count * sizeof *out->cubic);
    out->sphere = malloc(count * sizeof *out->sphere);
    if (out->cubic == NULL || out->sphere == NULL)
        return report_no_memory(v->s->r);
    for (size_t i = 0; i < count; i++) {
        size_t row = i / (size_t)v->width + (size_t)v->g.desc.guard_top;
        size_t column = i % (size_t)v->width + (size_t)v->g.desc.guard_left;
        const float *uv = v->g.uv + 2 * (row * (size_t)v->g.desc.width + column);
        relief_value value = {1.0, 1.0, 1.0};

        if (v->mask[i] != 0 && !isnan(uv[0]))
            value =
                relief_trace(map, (double)uv[0] * map->size, (double)uv[1] * map->size,
                             (double)RELIEF_RADIUS, 10, (uint32_t)i);
        out->cubic[i] = (float)fmin(1.0, value.cubic);
        out->sphere[i] = (float)fmin(1.0, value.sphere);
    }
    return EXIT_DONE;
}

typedef struct relief_numbers {
    double rmse[METHODS][KINDS]; /* 12 samples, interleaved */
    double limit[METHODS];       /* both, 256 samples */
    double ms[KINDS];            /* vao, 12 samples, unfiltered */
    double trace_error;
    double darkness; /* RMS of 1 - A of the truth: the error of doing nothing */
} relief_numbers;

static int rmse_of(const relief_view *v, const crv_options *options, const float *truth,
                   double *rmse)
{
    float *picture = NULL;
    metrics m;
    int result = run_view(v, options, &picture, NULL);

    if (result == EXIT_DONE
        && !metrics_compare(picture, truth, v->mask, v->width, v->height, &m))
        result = report_no_memory(v->s->r);
    if (result == EXIT_DONE)
        *rmse = m.rmse;
    free(picture);
    return result;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static int time_kinds(const relief_view *v, relief_numbers *out)
{
    double ms[KINDS][ROUNDS];

    for (int round = -1; round < ROUNDS; round++) { /* the first to warm up */
        for (int kind = 0; kind < KINDS; kind++) {
            crv_options o = relief_options(v->s, VAO, kind, 12);
            float *picture = NULL;
            int result = run_view(v, &o, &picture, &ms[kind][round < 0 ? 0 : round]);

            free(picture);
            if (result != EXIT_DONE)
                return result;
        }
    }
    for (int kind = 0; kind < KINDS; kind++) {
        qsort(ms[kind], ROUNDS, sizeof ms[kind][0], by_value);
        out->ms[kind] = ms[kind][ROUNDS / 2];
    }
    return EXIT_DONE;
}

/* On the floor, far from ball and wall, where the relief alone occludes. */
static int measure_floor(const relief_view *v, const truths *truth, relief_numbers *out)
{
    size_t count = (size_t)v->width * (size_t)v->height;
    double sum = 0.0;
    int result = time_kinds(v, out);

    for (int m = 0; m < METHODS && result == EXIT_DONE; m++) {
        const float *own = m == VAO ? truth->sphere : truth->cubic;
        crv_options o = relief_options(v->s, m, CRV_CHARACTERISTIC_PRODUCT, 256);

        result = rmse_of(v, &o, own, &out->limit[m]);
        for (int kind = 0; kind < KINDS && result == EXIT_DONE; kind++) {
            o = relief_options(v->s, m, kind, 12);
            o.filter = crv_filter_find("box4");
            result = rmse_of(v, &o, own, &out->rmse[m][kind]);
        }
    }
    for (size_t i = 0; i < count; i++)
        sum += (1.0 - (double)truth->sphere[i]) * (1.0 - (double)truth->sphere[i]);
    out->darkness = sqrt(sum / (double)count);
    return result;
}

static int write_picture(const relief_view *v, const char *name, int kind,
                         const char *where)
{
    crv_options o = relief_options(v->s, VAO, kind, 12);
    float *picture = NULL;
    char caption[128];
    int result;

    o.filter = crv_filter_find("box4");
    result = run_view(v, &o, &picture, NULL);
    snprintf(caption, sizeof caption, "%s: vao, 12 samples, %s", where, kinds[kind]);
    if (result == EXIT_DONE)
        page_picture(v->s->page, name, picture, v->width, v->height, caption);
    free(picture);
    return result;
}

static void write_numbers(study *s, const relief_numbers *n)
{
    static const char *const headers[] = {"characteristic function", "vao, RMSE",
                                          "containment, RMSE", "vao, time, ms"};
    double best[METHODS];
    char measured[512];

    page_table_begin(s->page,
                     "The floor under cobbles, 12 samples, interleaved, against rays "
                     "through the map: vao to the tangent sphere's visible share, "
                     "containment to the cosine integral with falloff cubic. Times are "
                     "without the filter.",
                     headers, 4);
    for (int kind = KINDS - 1; kind >= 0; kind--) {
        page_cell(s->page, "%s", kinds[kind]);
        page_cell(s->page, "%.4f", n->rmse[VAO][kind]);
        page_cell(s->page, "%.4f", n->rmse[CONTAINMENT][kind]);
        page_cell(s->page, "%.2f", n->ms[kind]);
    }
    page_table_end(s->page);
    for (int m = 0; m < METHODS; m++)
        best[m] = n->limit[m] / n->rmse[m][CRV_CHARACTERISTIC_DEPTH];
    snprintf(measured, sizeof measured,
             "RMSE on the relief with the depth buffer alone %.4f (vao) and %.4f "
             "(containment), with the height field %.4f and %.4f; with 256 samples %.4f "
             "and %.4f. vao then takes %.2f times as long.",
             n->rmse[VAO][CRV_CHARACTERISTIC_DEPTH],
             n->rmse[CONTAINMENT][CRV_CHARACTERISTIC_DEPTH],
             n->rmse[VAO][CRV_CHARACTERISTIC_PRODUCT],
             n->rmse[CONTAINMENT][CRV_CHARACTERISTIC_PRODUCT], n->limit[VAO],
             n->limit[CONTAINMENT],
             n->ms[CRV_CHARACTERISTIC_PRODUCT] / n->ms[CRV_CHARACTERISTIC_DEPTH]);
    /* Half of the error of doing nothing is a relief that is there; 2 % are noise. */
    measure_claim(
        s,
        (page_claim){.paper = "2010, Figure 12",
                     .statement = "The product of depth buffer and height field gives "
                                  "displacement-mapped surfaces their own occlusion, "
                                  "although the depth buffer does not know of it.",
                     .verdict = fmax(best[0], best[1]) < 0.5    ? PAGE_HOLDS
                                : fmin(best[0], best[1]) < 0.98 ? PAGE_PARTLY
                                                                : PAGE_FAILS,
                     .measured = measured,
                     .reason = "A pipe meets the relief to first order from its "
                               "middle, as if it were a plane there; a containment "
                               "test takes points behind a ridge for open. Both err in "
                               "narrow joints."});
}

static int write_results(study *s, cJSON *to, const relief_numbers *n)
{
    cJSON *json = measure_object(s, to, "relief");

    if (json == NULL)
        return EXIT_FAILED;
    study_add_number(json, "trace_error", n->trace_error);
    study_add_number(json, "darkness", n->darkness);
    return measure_array(s, json, "vao_rmse", n->rmse[VAO], KINDS)
                   && measure_array(s, json, "containment_rmse", n->rmse[CONTAINMENT],
                                    KINDS)
                   && measure_array(s, json, "limit_rmse", n->limit, METHODS)
                   && measure_array(s, json, "vao_ms", n->ms, KINDS)
               ? EXIT_DONE
               : EXIT_FAILED;
}

static int write_floor(study *s, const scene *model, const relief_map *map, cJSON *to)
{
    static const scene_view camera = {.projection = CRV_PERSPECTIVE,
                                      .eye = {6.0f, 2.4f, 6.6f},
                                      .target = {6.0f, 0.0f, 4.2f},
                                      .up = {0.0f, 1.0f, 0.0f},
                                      .vfov_rad = 0.6f};
    relief_view v;
    relief_numbers n = {.trace_error = relief_trace_error()};
    truths truth = {NULL, NULL};
    int result = open_view(&v, s, model, &camera, map);

    if (result == EXIT_DONE)
        result = trace_view(&v, map, &truth);
    if (result == EXIT_DONE)
        result = measure_floor(&v, &truth, &n);
    if (result == EXIT_DONE) {
        page_text(
            s->page,
            "A floor without relief of its own (`builtin:relief`) under a height map "
            "of cobbles, %.2g units high, R = %.2g. The truth are 100 rays for each "
            "pixel through the map; held to the closed forms of a V groove this "
            "tracer is off by %.4f at most.",
            map->scale, (double)RELIEF_RADIUS, n.trace_error);
        write_numbers(s, &n);
        page_grid_begin(s->page);
        result =
            write_picture(&v, "vao-relief-floor", CRV_CHARACTERISTIC_PRODUCT, "floor");
        page_picture(s->page, "vao-relief-floor-truth", truth.sphere, v.width, v.height,
                     "floor: rays through the map, the tangent sphere's visible share");
    }
    if (result == EXIT_DONE)
        result = write_results(s, to, &n);
    free(truth.cubic);
    free(truth.sphere);
    close_view(&v);
    return result;
}

/* As the paper's figure: what each characteristic function sees. */
static int write_scene(study *s, const scene *model, const relief_map *map)
{
    static const char *const names[KINDS] = {"vao-relief-both", "vao-relief-depth",
                                             "vao-relief-field"};
    scene_view camera;
    relief_view v;
    int result;

    scene_frame(model, 0.7f, (float)s->main->width / (float)s->main->height, &camera);
    result = open_view(&v, s, model, &camera, map);
    for (int kind = KINDS - 1; kind >= 0 && result == EXIT_DONE; kind--)
        result = write_picture(&v, names[kind], kind, "ball and wall");
    page_grid_end(s->page);
    close_view(&v);
    return result;
}

int claims_relief(study *s, cJSON *to)
{
    static relief_map map;
    scene *model = NULL;
    int result;

    study_progress(s, "vao: height field");
    if (scene_builtin("relief", &model, &s->r->logger) != 0)
        return EXIT_FAILED;
    relief_cobbles(&map, 2.0, RELIEF_HEIGHT);
    page_heading(s->page, 3, "vao-relief", "Height fields");
    result = write_floor(s, model, &map, to);
    if (result == EXIT_DONE)
        result = write_scene(s, model, &map);
    scene_free(model);
    return result;
}
