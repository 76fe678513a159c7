/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "gbuffer_image.h"
#include "common/camera_file.h"
#include "common/output.h"
#include "common/view.h"

typedef struct gbuffer_settings {
    view_settings view;
    const char *camera_output;
} gbuffer_settings;

static const arg gbuffer_rows[] = {
    VIEW_MODEL_ROW,
    VIEW_IMPORT_ROW,
    ARG_OUTPUT_ROW(view_settings, output, "EXR file to write"),
    {.name = "--write-camera",
     .value = "FILE",
     ARG_INTO(ARG_TEXT, gbuffer_settings, camera_output),
     .help = "write the camera as JSON, for --camera of `crevice ao`, `render` and "
             "`gbuffer`"},
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

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), size = strlen(end);
    return length >= size && strcmp(text + length - size, end) == 0;
}

static int check(const gbuffer_settings *g, report *r)
{
    const view_settings *s = &g->view;
    int result = view_check(s, r);
    if (result != EXIT_DONE)
        return result;
    if (!ends_with(s->output, ".exr")) {
        report_error(r, "%s: cannot hold a G-buffer; name it with .exr at the end",
                     s->output);
        return EXIT_USAGE;
    }
    if (g->camera_output
        && (!ends_with(g->camera_output, ".json")
            || io_is_same_file(g->camera_output, s->model))) {
        report_error(r, "--write-camera: %s is not a new .json; name it so",
                     g->camera_output);
        return EXIT_USAGE;
    }
    return output_check(s->output, s->model, r);
}

static int run(const void *settings, report *r)
{
    const gbuffer_settings *given = settings;
    const view_settings *s = &given->view;
    scene *model = NULL;
    scene_gbuffer g = {0};
    io_image image = {0};
    int result = check(given, r);
    if (result == EXIT_DONE)
        result = view_load(s, &model, r);
    if (result == EXIT_DONE)
        result = view_render(s, model, false, &g, r);
    scene_free(model);
    if (result == EXIT_DONE)
        result =
            gbuffer_make_image(&g, &image, &r->logger) == 0 ? EXIT_DONE : EXIT_FAILED;
    if (result == EXIT_DONE && given->camera_output)
        result = camera_file_write(given->camera_output, &g.view, r);
    scene_gbuffer_free(&g);
    if (result == EXIT_DONE)
        result = output_write(s->output, &image, NULL, r);
    io_image_free(&image);
    return result;
}

const command command_gbuffer = {
    .name = "gbuffer",
    .summary = "write depth layers, normals and camera of a mesh to an EXR file",
    .synopsis = "MODEL -o FILE.exr [options]",
    .details =
        "Channels: Z (planar depth in scene units, infinite for the background), "
        "layer2.Z to layer4.Z (solid2.Z to solid4.Z with --layer-kind solid, so that "
        "`crevice ao` knows), N.X N.Y N.Z (world space), all 32-bit floats. The "
        "camera is in worldToCamera and worldToNDC; the guard band is overscan: the "
        "data window is larger than the display window.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(gbuffer_settings),
    .run = run,
};
