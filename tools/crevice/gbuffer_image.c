/* SPDX-License-Identifier: MIT */
#include "gbuffer_image.h"

#include <stdio.h>
#include <string.h>

/* Row-vector matrices: p' = p * M, so M is the transpose of the matrix for column
 * vectors. */
void gbuffer_describe_camera(const scene_gbuffer *g, io_image *image)
{
    io_camera_metadata *out = &image->camera;
    const float *rotation = g->camera.world_to_view;
    double fx = (double)g->camera.fx_px / image->display_width;
    double fy = (double)g->camera.fy_px / image->display_height;
    double cx = ((double)g->camera.cx_px - g->desc.guard_left) / image->display_width;
    double cy = ((double)g->camera.cy_px - g->desc.guard_top) / image->display_height;
    bool ortho = g->camera.projection == CRV_ORTHOGRAPHIC;
    for (int row = 0; row < 4; row++) {
        double view[4] = {0.0, 0.0, 0.0, row == 3 ? 1.0 : 0.0};

        for (int k = 0; k < 3; k++) {
            if (row < 3)
                view[k] = (double)rotation[3 * k + row];
            for (int i = 0; i < 3 && row == 3; i++)
                view[k] -= (double)rotation[3 * k + i] * g->view.eye[i];
        }
        /* Depth d = -z divides x and y under perspective, and 1 does otherwise. The third
         * column has no meaning there; it only keeps the matrix invertible. */
        double w = ortho ? view[3] : -view[2];
        double ndc[4] = {fx * view[0] + cx * w, -fy * view[1] + cy * w,
                         -view[2] - (ortho ? 0.0 : view[3]), w};
        for (int k = 0; k < 4; k++) {
            out->world_to_camera[4 * row + k] = (float)view[k];
            out->world_to_ndc[4 * row + k] = (float)ndc[k];
        }
    }
    out->has_world_to_camera = true;
    out->has_world_to_ndc = true;
}

/* n_world = transpose(world_to_view) * n_view */
void gbuffer_to_world(const scene_gbuffer *g, const float *vectors, size_t count,
                      float *const out[3])
{
    const float *m = g->camera.world_to_view;
    for (size_t i = 0; i < count; i++) {
        const float *n = &vectors[3 * i];
        for (int k = 0; k < 3; k++)
            out[k][i] = m[k] * n[0] + m[3 + k] * n[1] + m[6 + k] * n[2];
    }
}

void gbuffer_world_normals(const scene_gbuffer *g, float *const out[3])
{
    gbuffer_to_world(g, g->normals, (size_t)g->desc.width * (size_t)g->desc.height, out);
}

int gbuffer_make_image(const scene_gbuffer *g, io_image *image, const crv_logger *log)
{
    static const char *const surfaces[] = {"N.X",      "N.Y",      "N.Z",     "Z",
                                           "layer2.Z", "layer3.Z", "layer4.Z"};
    static const char *const solids[] = {"N.X",      "N.Y",      "N.Z",     "Z",
                                         "solid2.Z", "solid3.Z", "solid4.Z"};
    const char *const *names = g->desc.layer_kind == CRV_LAYERS_SOLID ? solids : surfaces;
    size_t count = (size_t)g->desc.width * (size_t)g->desc.height;
    float *normals[3];
    if (io_image_init(image, g->desc.width, g->desc.height, names, 3 + g->desc.layers,
                      log)
        != 0)
        return -1;
    for (int k = 0; k < 3; k++)
        normals[k] = io_image_find(image, names[k])->data;
    gbuffer_world_normals(g, normals);
    for (int32_t layer = 0; layer < g->desc.layers; layer++)
        memcpy(io_image_find(image, names[3 + layer])->data, g->depth[layer],
               count * sizeof(float));
    image->data_x = -g->desc.guard_left;
    image->data_y = -g->desc.guard_top;
    image->display_width = g->desc.width - g->desc.guard_left - g->desc.guard_right;
    image->display_height = g->desc.height - g->desc.guard_top - g->desc.guard_bottom;
    gbuffer_describe_camera(g, image);
    /* `ao` knows by this that the overscan is a guard band. */
    snprintf(image->made, sizeof image->made, "crevice %s gbuffer", crv_version());
    return 0;
}
