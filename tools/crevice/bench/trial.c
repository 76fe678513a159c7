/* SPDX-License-Identifier: MIT */
/* trial.c: how long a run will take, by one over a few rows. */
#include "bench/bench.h"
#include "common/report.h"

enum { ROWS = 16, FEW_ROWS = 8 * ROWS };

/* Rows in the middle of a plane. */
static crv_const_image middle(crv_const_image plane)
{
    plane.data = crv_const_image_at(&plane, 0, (plane.height - ROWS) / 2, 0);
    plane.height = ROWS;
    return plane;
}

static crv_const_image plane_of(const bench_scene *b, const crv_image *of_frame,
                                const float *cast, int32_t channels)
{
    return middle(b->is_frame ? crv_image_const(*of_frame)
                              : crv_const_image_packed(cast, b->desc.width,
                                                       b->desc.height, channels));
}

static bool fill(const bench_scene *b, crv_gbuffer *g)
{
    const crv_camera *whole = b->is_frame ? &b->file.camera : &b->cast.camera;
    const crv_camera camera = crv_camera_crop(whole, 0, (b->desc.height - ROWS) / 2);
    if (crv_gbuffer_set_camera(g, &camera))
        return false;
    for (int32_t i = 0; i < b->desc.layers; i++) {
        const crv_const_image depth = plane_of(b, &b->file.depth[i], b->cast.depth[i], 1);
        if (crv_gbuffer_set_depth(g, i, &depth, NULL))
            return false;
    }
    if (b->is_frame && !b->file.has_normals)
        return !crv_gbuffer_set_normals(g, NULL, CRV_NORMAL_VIEW);
    const crv_const_image normals = plane_of(b, &b->file.normals, b->cast.normals, 3);
    return !crv_gbuffer_set_normals(g, &normals,
                                    b->is_frame ? b->file.normal_space : CRV_NORMAL_VIEW);
}

double bench_trial(const bench_case *c, crv_context *context, float *pixels)
{
    const bench_scene *b = c->scene;
    crv_gbuffer *g = NULL;
    crv_plan *plan = NULL;
    crv_gbuffer_desc desc;
    double seconds = 0.0;
    crv_gbuffer_desc_init(&desc, sizeof desc, b->desc.width, ROWS);
    desc.layers = b->desc.layers;
    desc.layer_kind = b->desc.layer_kind;
    desc.guard_left = b->desc.guard_left;
    desc.guard_right = b->desc.guard_right;
    if (b->desc.height >= FEW_ROWS && b->height >= ROWS
        && crv_gbuffer_create(context, &desc, &g) == CRV_OK
        && crv_plan_create(context, &c->options, &desc, &plan) == CRV_OK && fill(b, g)) {
        const crv_image image = crv_image_packed(pixels, b->width, ROWS, 1);
        const crv_const_image estimate = crv_image_const(image);
        const double start = report_seconds();
        if ((c->filter_only ? crv_plan_filter(plan, g, &estimate, &image)
                            : crv_plan_run(plan, g, &image))
            == CRV_OK)
            seconds = (report_seconds() - start) * b->desc.height / ROWS;
    }
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(g);
    return seconds;
}
