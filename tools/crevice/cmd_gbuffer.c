/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "output.h"
#include "view.h"

static const arg gbuffer_rows[] = {
    VIEW_MODEL_ROW,
    {.name = "--output",
     .short_name = 'o',
     .value = "FILE",
     .type = ARG_TEXT,
     .required = true,
     .offset = offsetof(view_settings, output),
     .help = "EXR file to write"},
};
static const arg_table gbuffer_table = ARG_TABLE("Files", gbuffer_rows);

static const arg_table *const tables[] = {
    &gbuffer_table, &view_camera, &view_buffers, &args_threads, &args_output_lines, NULL};

static const char *const examples[] = {
    "depth and normals of a mesh, then their ambient occlusion",
    "crevice gbuffer model.glb -o passes.exr && crevice ao passes.exr -o ao.exr",
    "four layers of depth, no overscan",
    "crevice gbuffer model.glb -o layers.exr --layers 4 --guard-px 0",
    NULL,
};

static int check(const view_settings *s, report *r)
{
    size_t length = strlen(s->output);
    int result = view_check(s, r);

    if (result != EXIT_DONE)
        return result;
    if (length < 4 || strcmp(s->output + length - 4, ".exr") != 0) {
        report_error(r, "%s: cannot hold a G-buffer; name it with .exr at the end",
                     s->output);
        return EXIT_USAGE;
    }
    return output_check(s->output, s->model, r);
}

/* Row-vector matrices: p' = p * M, so M is the transpose of the matrix for column
 * vectors. */
static void describe_camera(const scene_gbuffer *g, io_image *image)
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
                view[k] -= (double)rotation[3 * k + i] * (double)g->view.eye[i];
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
static void copy_normals(const scene_gbuffer *g, float *const out[3])
{
    size_t count = (size_t)g->desc.width * (size_t)g->desc.height;
    const float *m = g->camera.world_to_view;

    for (size_t i = 0; i < count; i++) {
        const float *n = &g->normals[3 * i];
        for (int k = 0; k < 3; k++)
            out[k][i] = m[k] * n[0] + m[3 + k] * n[1] + m[6 + k] * n[2];
    }
}

static int make_image(const scene_gbuffer *g, io_image *image, report *r)
{
    static const char *const names[] = {"N.X",      "N.Y",      "N.Z",     "Z",
                                        "layer2.Z", "layer3.Z", "layer4.Z"};
    size_t count = (size_t)g->desc.width * (size_t)g->desc.height;
    float *normals[3];

    if (io_image_init(image, g->desc.width, g->desc.height, names, 3 + g->desc.layers,
                      &r->logger)
        != 0)
        return EXIT_FAILED;
    for (int k = 0; k < 3; k++)
        normals[k] = io_image_find(image, names[k])->data;
    copy_normals(g, normals);
    for (int32_t layer = 0; layer < g->desc.layers; layer++)
        memcpy(io_image_find(image, names[3 + layer])->data, g->depth[layer],
               count * sizeof(float));
    image->data_x = -g->desc.guard_left;
    image->data_y = -g->desc.guard_top;
    image->display_width = g->desc.width - g->desc.guard_left - g->desc.guard_right;
    image->display_height = g->desc.height - g->desc.guard_top - g->desc.guard_bottom;
    describe_camera(g, image);
    return EXIT_DONE;
}

static int run(const void *settings, report *r)
{
    const view_settings *s = settings;
    scene *model = NULL;
    scene_gbuffer g = {0};
    io_image image = {0};
    int result = check(s, r);

    if (result == EXIT_DONE)
        result = view_load(s, &model, r);
    if (result == EXIT_DONE)
        result = view_render(s, model, &g, r);
    scene_free(model);
    if (result == EXIT_DONE)
        result = make_image(&g, &image, r);
    scene_gbuffer_free(&g);
    if (result == EXIT_DONE)
        result = output_write(s->output, &image, NULL, r);
    io_image_free(&image);
    return result;
}

const command command_gbuffer = {
    .name = "gbuffer",
    .summary = "depth layers, normals and camera of a mesh as an EXR file",
    .synopsis = "MODEL -o FILE.exr [options]",
    .details =
        "Channels: Z (planar depth in scene units, infinite where there is nothing), "
        "layer2.Z to layer4.Z, N.X N.Y N.Z (world space), all 32-bit floats. The "
        "camera is in worldToCamera and worldToNDC; the guard band is overscan: the "
        "data window is larger than the display window.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(view_settings),
    .run = run,
};
