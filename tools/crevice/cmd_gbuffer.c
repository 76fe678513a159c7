/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "gbuffer_image.h"
#include "common/output.h"
#include "common/view.h"

static const arg gbuffer_rows[] = {
    VIEW_MODEL_ROW,
    VIEW_IMPORT_ROW,
    ARG_OUTPUT_ROW(view_settings, output, "EXR file to write"),
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
        result =
            gbuffer_make_image(&g, &image, &r->logger) == 0 ? EXIT_DONE : EXIT_FAILED;
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
        "Channels: Z (planar depth in scene units, infinite for the background), "
        "layer2.Z to layer4.Z (solid2.Z to solid4.Z with --layer-kind solid, so that "
        "`crevice ao` knows), N.X N.Y N.Z (world space), all 32-bit floats. The "
        "camera is in worldToCamera and worldToNDC; the guard band is overscan: the "
        "data window is larger than the display window.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(view_settings),
    .run = run,
};
