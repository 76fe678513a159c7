/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "gbuffer_image.h"
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

static int make_image(const scene_gbuffer *g, io_image *image, report *r)
{
    static const char *const surfaces[] = {"N.X",      "N.Y",      "N.Z",     "Z",
                                           "layer2.Z", "layer3.Z", "layer4.Z"};
    static const char *const solids[] = {"N.X",      "N.Y",      "N.Z",     "Z",
                                         "solid2.Z", "solid3.Z", "solid4.Z"};
    const char *const *names = g->desc.layer_kind == CRV_LAYERS_SOLID ? solids : surfaces;
    size_t count = (size_t)g->desc.width * (size_t)g->desc.height;
    float *normals[3];

    if (io_image_init(image, g->desc.width, g->desc.height, names, 3 + g->desc.layers,
                      &r->logger)
        != 0)
        return EXIT_FAILED;
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
        result = view_render(s, model, false, &g, r);
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
        "layer2.Z to layer4.Z (solid2.Z to solid4.Z with --layer-kind back, so that "
        "`crevice ao` knows), N.X N.Y N.Z (world space), all 32-bit floats. The "
        "camera is in worldToCamera and worldToNDC; the guard band is overscan: the "
        "data window is larger than the display window.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(view_settings),
    .run = run,
};
