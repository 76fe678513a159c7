/* SPDX-License-Identifier: MIT */
#include "viewer_args.h"

#include <math.h>

static const arg input_rows[] = {
    {.name = "INPUT",
     .required = true,
     ARG_INTO(ARG_TEXT, viewer_settings, view.model),
     .help = "mesh (glTF, OBJ, ...), scene made in code (builtin:courtyard, ...), or a "
             "frame with a depth pass (.exr, .png, .pfm); shot.####.exr with --frames"},
    VIEW_IMPORT_ROW,
    {.name = "--frames",
     .value = "A-B[xSTEP]",
     ARG_INTO(ARG_TEXT, viewer_settings, frames),
     .help = "frames of a shot, as for `crevice ao`"},
    {.name = "--tune",
     ARG_INTO(ARG_FLAG, viewer_settings, tune),
     .help = "begin with a fit of the left half's options to the truth, as the button "
             "\"Fit to truth\" makes it; `crevice tune` is that without a window"},
    {.name = "--script",
     .value = "FILE",
     ARG_INTO(ARG_TEXT, viewer_settings, script),
     .help = "do what FILE says, an action a line (docs/viewer.md), as a demonstration "
             "or a test"},
};
static const arg_table input_table = ARG_TABLE("Input", input_rows);

static const arg pass_rows[] = {PASS_ROWS(viewer_settings, passes)};
const arg_table viewer_passes = ARG_TABLE("Passes of frames", pass_rows);

static const arg camera_rows[] = {
    VIEW_CAMERA_ROWS(frame_camera_found, "45; of a frame: from the file's metadata",
                     "a camera of the model, by its name or its number from 1, or a file "
                     "of one camera, .json or .chan, instead of --eye, --target and "
                     "--up; of frames: a file of cameras by frame"),
    FRAME_CAMERA_ORDER_ROW(viewer_settings, lens),
    FRAME_CAMERA_LENS_ROWS(viewer_settings, lens),
};
const arg_table viewer_camera =
    ARG_TABLE("Camera (framed by itself without these)", camera_rows);

frame_camera_settings viewer_frame_camera(const viewer_settings *s)
{
    frame_camera_settings camera = s->lens;
    camera.file = s->view.camera;
    camera.vfov_deg = s->view.vfov_deg;
    camera.ortho = s->view.ortho;
    return camera;
}

static const char *mesh_mistake(const viewer_settings *s)
{
    const frame_camera_settings *lens = &s->lens;
    if (s->frames)
        return "--frames: is for .exr frames, not for a mesh; leave it out";
    if (lens->order.given || lens->hfov_deg.given || lens->lens_mm.given
        || lens->sensor_mm.given || isnan(s->view.vfov_deg.value))
        return "--hfov, --lens, --sensor, --camera-order and --vfov fit: are for frames; "
               "give a mesh's --vfov in degrees";
    return NULL;
}

static const char *frame_mistake(const viewer_settings *s)
{
    const view_settings *v = &s->view;
    const frame_camera_settings camera = viewer_frame_camera(s);
    const char *mistake = pass_mistake(&s->passes, camera.ortho.given);
    if (!mistake)
        mistake = frame_camera_mistake(&camera);
    if (!mistake && (v->eye.given || v->target.given || v->up.given))
        mistake =
            "--eye, --target and --up: are for meshes; a frame has the view that it "
            "was rendered with";
    if (!mistake && (v->layers.given || v->normals_from.given || v->guard_px.given))
        mistake = "--layers, --normals-from and --guard-px: are for meshes; leave them "
                  "out";
    return mistake;
}

const char *viewer_mistake(const viewer_settings *s)
{
    return pass_is_frame(s->view.model) ? frame_mistake(s) : mesh_mistake(s);
}

static const arg_table *const tables[] = {
    &input_table,  &viewer_passes, &viewer_camera,     &view_buffers,
    &args_threads, &args_device,   &args_output_lines, NULL};

static const char *const examples[] = {
    "a mesh, the default method beside the truth",
    "crevice view model.glb",
    "a renderer's frame",
    "crevice view frame.exr --vfov 40",
    "a shot to scrub through",
    "crevice view shot.####.exr --frames 1-240 --method gtao",
    NULL,
};

const command command_view = {
    .name = "view",
    .summary =
        "open a window: two methods side by side, sliders, the error against the truth",
    .synopsis = "INPUT [options]",
    .details =
        "Drag the line to compare the halves. Options given here are those that both "
        "begin with; --size is the picture's. The truth is traced in the background. For "
        "a frame it is traced through the surfaces that the depth pass holds.",
    .tables = tables,
    .library_options = true,
    .examples = examples,
    .settings_size = sizeof(viewer_settings),
    .program = "crevice-view",
};
