/* SPDX-License-Identifier: MIT */
#include "groove.h"

#include "common/device.h"

#include <math.h>
#include <stdlib.h>

/* Where the first column is, in pixels from the edge, which lies inside a pixel rather
 * than on its centre or its border. */
static double first_column(int32_t px_per_radius)
{
    return ceil(0.1 * sqrt(0.5) * px_per_radius) + 0.25;
}

static int place_columns(study *s, groove *g, int32_t px_per_radius)
{
    double first = first_column(px_per_radius);
    double last = sqrt(0.5) * px_per_radius;

    g->columns = (int32_t)floor(last - first) + 1;
    g->c = malloc((size_t)g->columns * sizeof *g->c);
    g->x = malloc((size_t)g->columns * sizeof *g->x);
    g->accessibility =
        malloc((size_t)g->columns * GROOVE_ROWS * sizeof *g->accessibility);
    if (g->c == NULL || g->x == NULL || g->accessibility == NULL)
        return report_no_memory(s->r);
    for (int32_t i = 0; i < g->columns; i++) {
        g->x[i] = (first + i) / px_per_radius;
        g->c[i] = fmin(1.0, g->x[i] * sqrt(2.0));
    }
    return EXIT_DONE;
}

/* Row by row the same: depth, then normals. */
static void fill(const groove *g, const crv_camera *camera, float *depth, float *normals)
{
    const float leaning = (float)sqrt(0.5);

    for (int32_t y = 0; y < g->desc.height; y++) {
        for (int32_t x = 0; x < g->desc.width; x++) {
            size_t i = (size_t)y * (size_t)g->desc.width + (size_t)x;
            double at = (x + 0.5 - (double)camera->cx_px) / (double)camera->fx_px;
            depth[i] = (float)(GROOVE_DEPTH - fabs(at));
            normals[3 * i] = at > 0.0 ? -leaning : leaning;
            normals[3 * i + 1] = 0.0f;
            normals[3 * i + 2] = leaning;
        }
    }
}

static int upload(study *s, groove *g, const crv_camera *camera, float *planes)
{
    int32_t width = g->desc.width, height = g->desc.height;
    float *normals = planes + (size_t)width * (size_t)height;
    crv_const_image depth_image = crv_const_image_packed(planes, width, height, 1);
    crv_const_image normal_image = crv_const_image_packed(normals, width, height, 3);

    fill(g, camera, planes, normals);
    return report_ok(s->r, crv_gbuffer_set_camera(g->gbuffer, camera), "groove")
                   && report_ok(s->r,
                                crv_gbuffer_set_depth(g->gbuffer, 0, &depth_image, NULL),
                                "groove")
                   && report_ok(s->r,
                                crv_gbuffer_set_normals(g->gbuffer, &normal_image,
                                                        CRV_NORMAL_VIEW),
                                "groove")
               ? EXIT_DONE
               : EXIT_FAILED;
}

static int make_gbuffer(study *s, groove *g, int32_t px_per_radius)
{
    crv_camera camera;
    int32_t guard = px_per_radius + 2;
    float *planes;
    int code;

    crv_gbuffer_desc_init(&g->desc, sizeof g->desc, g->columns + 2 * guard,
                          GROOVE_ROWS + 2 * guard);
    g->desc.guard_left = g->desc.guard_right = guard;
    g->desc.guard_top = g->desc.guard_bottom = guard;
    code = device_context(s->common, &s->r->logger, s->r, &g->context);
    if (code != EXIT_DONE)
        return code;
    if (!report_ok(s->r, crv_gbuffer_create(g->context, &g->desc, &g->gbuffer), "groove"))
        return EXIT_FAILED;
    camera = crv_camera_orthographic(g->desc.width, g->desc.height,
                                     (float)g->desc.height / (float)px_per_radius);
    camera.cx_px = (float)(guard + 0.5 - first_column(px_per_radius));
    planes = malloc((size_t)g->desc.width * (size_t)g->desc.height * 4 * sizeof *planes);
    if (planes == NULL)
        return report_no_memory(s->r);
    code = upload(s, g, &camera, planes);
    free(planes);
    return code;
}

int groove_open(study *s, int32_t px_per_radius, groove *out)
{
    int code;

    *out = (groove){0};
    code = place_columns(s, out, px_per_radius);
    return code == EXIT_DONE ? make_gbuffer(s, out, px_per_radius) : code;
}

void groove_close(groove *g)
{
    crv_gbuffer_destroy(g->gbuffer);
    crv_context_destroy(g->context);
    free(g->c);
    free(g->x);
    free(g->accessibility);
    *g = (groove){0};
}

int groove_run(study *s, groove *g, const crv_options *options)
{
    crv_options o = *options;
    crv_plan *plan = NULL;
    crv_image result = crv_image_packed(g->accessibility, g->columns, GROOVE_ROWS, 1);
    bool done;

    o.radius = 1.0f;
    if (!report_ok(s->r, crv_plan_create(g->context, &o, &g->desc, &plan), "plan"))
        return EXIT_FAILED;
    done = report_ok(s->r, crv_plan_run(plan, g->gbuffer, &result), "estimation");
    crv_plan_destroy(plan);
    return done ? EXIT_DONE : EXIT_FAILED;
}
