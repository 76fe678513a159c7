/* SPDX-License-Identifier: MIT */
/* trial.c: how long a run will take, by one over a small part. */
#include "bench/bench.h"
#include "common/report.h"

enum { COLUMNS = 64, ROWS = 16, FEW_PIXELS = 128 * 128 };

#define ENOUGH_SECONDS 0.05

/* A part in the middle of the buffers, without a guard band. */
typedef struct part {
    int32_t x, y, width, height;
} part;

static part middle(const bench_scene *b, int32_t width, int32_t height)
{
    const crv_gbuffer_desc *d = &b->desc;
    return (part){(d->width - width) / 2, (d->height - height) / 2, width, height};
}

static crv_const_image cut(crv_const_image plane, const part *of)
{
    plane.data = crv_const_image_at(&plane, of->x, of->y, 0);
    plane.width = of->width;
    plane.height = of->height;
    return plane;
}

static crv_const_image plane_of(const bench_scene *b, const crv_image *of_frame,
                                const float *cast, int32_t channels, const part *of)
{
    return cut(b->is_frame ? crv_image_const(*of_frame)
                           : crv_const_image_packed(cast, b->desc.width, b->desc.height,
                                                    channels),
               of);
}

static bool fill(const bench_scene *b, const part *of, crv_gbuffer *g)
{
    const crv_camera *whole = b->is_frame ? &b->file.camera : &b->cast.camera;
    const crv_camera camera = crv_camera_crop(whole, of->x, of->y);
    if (crv_gbuffer_set_camera(g, &camera))
        return false;
    for (int32_t i = 0; i < b->desc.layers; i++) {
        const crv_const_image depth =
            plane_of(b, &b->file.depth[i], b->cast.depth[i], 1, of);
        if (crv_gbuffer_set_depth(g, i, &depth, NULL))
            return false;
    }
    if (b->is_frame && !b->file.has_normals)
        return !crv_gbuffer_set_normals(g, NULL, CRV_NORMAL_VIEW);
    const crv_const_image normals = plane_of(b, &b->file.normals, b->cast.normals, 3, of);
    return !crv_gbuffer_set_normals(g, &normals,
                                    b->is_frame ? b->file.normal_space : CRV_NORMAL_VIEW);
}

/* Seconds of a run over the part; 0: it failed. */
static double time_part(const bench_case *c, crv_context *context, const part *of,
                        float *pixels)
{
    const bench_scene *b = c->scene;
    crv_gbuffer *g = NULL;
    crv_plan *plan = NULL;
    crv_gbuffer_desc desc;
    double seconds = 0.0;
    crv_gbuffer_desc_init(&desc, sizeof desc, of->width, of->height);
    desc.layers = b->desc.layers;
    desc.layer_kind = b->desc.layer_kind;
    if (crv_gbuffer_create(context, &desc, &g) == CRV_OK
        && crv_plan_create(context, &c->options, &desc, &plan) == CRV_OK
        && fill(b, of, g)) {
        const crv_image image = crv_image_packed(pixels, of->width, of->height, 1);
        const crv_const_image estimate = crv_image_const(image);
        const double start = report_seconds();
        if ((c->filter_only ? crv_plan_filter(plan, g, &estimate, &image)
                            : crv_plan_run(plan, g, &image))
            == CRV_OK)
            seconds = report_seconds() - start;
    }
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(g);
    return seconds;
}

double bench_trial(const bench_case *c, crv_context *context, float *pixels)
{
    const bench_scene *b = c->scene;
    const double count = (double)b->desc.width * (double)b->desc.height;
    if (count < FEW_PIXELS || b->width < COLUMNS || b->height < ROWS)
        return 0.0;
    /* Ever larger parts: in small ones what plans prepare counts too much, of large ones
     * a method may take minutes. */
    const part parts[] = {middle(b, ROWS, 1), middle(b, COLUMNS, ROWS),
                          middle(b, b->width, ROWS)};
    double seconds = 0.0;
    int i = 0;
    for (; i < 3 && seconds < ENOUGH_SECONDS; i++)
        seconds = time_part(c, context, &parts[i], pixels);
    const part of = parts[i - 1];
    return seconds * count / ((double)of.width * (double)of.height);
}
