/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "ao_settings.h"
#include "frame_copy.h"
#include "commands.h"
#include "common/estimate.h"
#include "shot.h"
#include "system/file.h"

/* In the order of crv_layers. */
static const char *const layer_kinds[] = {"surfaces", "solid", NULL};

static const arg file_rows[] = {
    {.name = "IN",
     .required = true,
     ARG_INTO(ARG_TEXT, ao_settings, input),
     .help =
         "frame with a depth pass, and normals if there are any: .exr, or a grey .png "
         "or .pfm of depth; with --frames shot.####.exr, shot.@@@@.exr, shot.%04d.exr, "
         "shot.$F4.exr or shot.<frame>.exr"},
    ARG_OUTPUT_ROW(ao_settings, output,
                   "picture to write: .exr (channel AO), .png (linear grey) or .pfm"),
    {.name = "--frames",
     .value = "A-B[xSTEP]",
     ARG_INTO(ARG_TEXT, ao_settings, frames),
     .help = "frames to compute, as 1-240, 1,3,10-20x2 or -5--1; one that fails is left "
             "out and listed at the end"},
    {.name = "--jobs",
     .value = "N",
     ARG_RANGE(1, 256),
     .initial = "1",
     ARG_INTO(ARG_INT, ao_settings, jobs),
     .help =
         "frames at a time, each with its share of the threads and memory of its own; "
         "faster on machines of many cores, with the same bits"},
    {.name = "--views",
     .value = "NAMES",
     ARG_INTO(ARG_TEXT, ao_settings, views),
     .help = "stereo: both eyes in one run, as left,right; in files for each, named with "
             "%V or %v (l, r), or as views of one .exr"},
    {.name = "--crop",
     ARG_INTO(ARG_FLAG, ao_settings, crop),
     .help = "only the display window gets a result; overscan still occludes"},
    {.name = "--aa",
     .value = "N",
     ARG_RANGE(1, 16),
     .initial = "1",
     ARG_INTO(ARG_INT, ao_settings, aa),
     .help = "antialiased, for frames rendered N times larger: a pixel of the result is "
             "the mean of those of NxN that show a surface"},
    {.name = "--skip-existing",
     ARG_INTO(ARG_FLAG, ao_settings, skip_existing),
     .help = "leave results that are whole and made with the same settings, and take "
             "their radius; .exr and .png"},
    {.name = "--radius-frame",
     .value = "N",
     ARG_RANGE(-99999999, 99999999),
     ARG_INTO(ARG_INT, ao_settings, radius_frame),
     .help = "the frame of the shot whose view chooses the radius for all parts of it"},
    {.name = "--bits",
     .value = "N",
     .choices = args_png_bits,
     .initial = "8",
     ARG_INTO(ARG_CHOICE, ao_settings, bits),
     .help = "depth of a PNG"},
    {.name = "--half",
     ARG_INTO(ARG_FLAG, ao_settings, half),
     .help = "half floats in an EXR"},
};
static const arg_table file_table = ARG_TABLE("Files", file_rows);

static const arg append_rows[] = {
    {.name = "--append",
     ARG_INTO(ARG_FLAG, ao_settings, append),
     .help =
         "write the frame with all that is in it, and AO as a further channel: of its "
         "part, or as a part if there are several; .exr"},
    {.name = "--channel",
     .value = "NAME",
     .computed = "AO",
     ARG_INTO(ARG_TEXT, ao_settings, channel),
     .help = "the name of that channel, such as \"View Layer.AO2\""},
    {.name = "--replace",
     ARG_INTO(ARG_FLAG, ao_settings, replace),
     .help = "replace a channel of that name"},
    {.name = "--apply",
     .value = "NAMES",
     ARG_INTO(ARG_TEXT, ao_settings, apply),
     .help = "write the frame with AO multiplied into these channels, or the red, green "
             "and blue of these layers; with commas in between"},
    {.name = "--tint",
     .value = "R,G,B",
     .initial = "0,0,0",
     ARG_INTO(ARG_VECTOR, ao_settings, tint),
     .help =
         "for --apply: what full occlusion leaves of a white surface, 0 to 1; colours "
         "become c (t + (1 - t) AO)"},
    {.name = "--albedo",
     .value = "ALBEDO",
     ARG_INTO(ARG_TEXT, ao_settings, albedo),
     .help = "for --apply: AO with the light that surfaces pass on to each other: their "
             "albedo RHO or R,G,B, 0 to 1, or a colour pass such as \"View "
             "Layer.DiffCol\""},
};
static const arg bent_rows[] = {
    BENT_ROWS(ao_settings, bent, "that of the frame's normals"),
    {.name = "--bent-channel",
     .value = "NAME",
     .computed = "bent, beside AO",
     ARG_INTO(ARG_TEXT, ao_settings, bent_channel),
     .help = "for --append: the name of their layer, such as \"View Layer.bent\""},
};
static const arg_table bent_table = ARG_TABLE("Bent normals", bent_rows);

static const arg mask_rows[] = {
    {.name = "--receive",
     .value = "MATTE",
     .computed = "everything",
     ARG_INTO(ARG_TEXT, ao_settings, receive),
     .help = "what is darkened, the rest is 1: a matte CHANNEL; CHANNEL=ID,ID for object "
             "ids; crypto:NAME,NAME for objects of a Cryptomatte, with * and ?; not:... "
             "for everything else"},
    {.name = "--occlude",
     .value = "MATTE",
     .computed = "everything",
     ARG_INTO(ARG_TEXT, ao_settings, occlude),
     .help = "what darkens, in the same words; the rest is as if it were not there, and "
             "gets 1"},
};
static const arg_table mask_table = ARG_TABLE("Parts of the frame", mask_rows);

static const arg_table append_table = ARG_TABLE("In the frame itself", append_rows);

static const arg pass_rows[] = {
    PASS_ROWS(ao_settings, passes),
    {.name = "--layer-kind",
     .value = "KIND",
     .choices = layer_kinds,
     .computed = "surfaces; solid if they are solid2.Z ...",
     ARG_INTO(ARG_CHOICE, ao_settings, layer_kind),
     .help = "what the layers Z, layer2.Z ... are: surfaces that each may occlude, or in "
             "turn the front and the back of solids"},
};
static const arg_table pass_table = ARG_TABLE("Passes", pass_rows);

static const arg camera_rows[] = {
    FRAME_CAMERA_FILE_ROW(ao_settings, camera),
    FRAME_CAMERA_ORDER_ROW(ao_settings, camera),
    FRAME_CAMERA_VFOV_ROW(ao_settings, camera),
    FRAME_CAMERA_LENS_ROWS(ao_settings, camera),
    FRAME_CAMERA_ORTHO_ROW(ao_settings, camera),
};
static const arg_table camera_table = ARG_TABLE("Camera", camera_rows);

static const arg_table *const tables[] = {
    &file_table,   &append_table, &bent_table,  &mask_table,        &pass_table,
    &camera_table, &args_threads, &args_device, &args_output_lines, NULL};

static const char *const examples[] = {
    "a frame whose camera was 60 degrees high",
    "crevice ao frame.exr --vfov 60 -o ao.exr",
    "a whole shot",
    "crevice ao shot.####.exr --frames 1-240 --vfov 35 --radius 0.5 -o ao.####.exr",
    "a shot of Blender, with AO beside its passes",
    "crevice ao shot.####.exr --frames 1-240 --lens 35 --append --channel \"View "
    "Layer.AO2\" -o out.####.exr",
    "the set darkens the hero, and nothing else is darkened",
    "crevice ao frame.exr --vfov 35 --receive 'crypto:hero*' -o hero_ao.exr",
    "a zoom, its cameras exported as .chan",
    "crevice ao shot.####.exr --frames 1-240 --camera shot.chan -o ao.####.exr",
    "a depth buffer of a game, without normals",
    "crevice ao depth.pfm --depth-encoding reversed --near 0.1 --far inf --vfov 70 -o "
    "ao.png",
    NULL,
};

static const char *frames_mistake(const ao_settings *s, frame_list *list)
{
    if (!s->frames) {
        if (frames_places(s->input) > 0 && !file_exists(s->input))
            return "--frames: is missing for a name with a frame number in it; add "
                   "--frames A-B";
        return NULL;
    }
    if (!frames_parse(s->frames, list))
        return "--frames: is not a range; give A-B or A-BxSTEP, such as 1-240, or "
               "several with commas";
    if (frames_places(s->input) != 1)
        return "IN: needs one place for the frame's number; write shot.####.exr";
    if (frames_places(s->output) != 1)
        return "-o: needs one place for the frame's number; write ao.####.exr";
    if (s->bent.output && frames_places(s->bent.output) != 1)
        return "--bent-output: needs one place for the frame's number; write "
               "bent.####.png";
    return NULL;
}

static const char *shot_mistake(const ao_settings *s)
{
    if (s->radius_frame.given && s->common.radius_given)
        return "--radius-frame: contradicts --radius; give one of them";
    if (s->radius_frame.given && !s->frames)
        return "--radius-frame: is for --frames; leave it out";
    if (s->jobs.given && !s->frames)
        return "--jobs: is for --frames; leave it out";
    if (s->skip_existing && !io_keeps_made(s->output))
        return "--skip-existing: a .pfm cannot say how it was made; write .exr or .png";
    return NULL;
}

/* Whether bent normals get to any file. */
static const char *bent_place_mistake(const ao_settings *s)
{
    const bool wanted = s->common.options.bent_normal;
    if (s->bent_channel && !(wanted && s->append))
        return "--bent-channel: is for --append with --bent-normal on; add them";
    if (!wanted || s->bent.output)
        return NULL;
    if (append_is_wanted(s) && !s->append)
        return "--bent-normal: has no place beside --apply; add --append or "
               "--bent-output FILE";
    if (!io_keeps_windows(s->output))
        return "--bent-normal: only an .exr holds them beside AO; write .exr, or add "
               "--bent-output FILE";
    return NULL;
}

static int check(const ao_settings *s, frame_list *list, view_list *views, report *r)
{
    const char *mistake = pass_mistake(&s->passes, s->camera.ortho.given);
    if (!mistake && estimate_is_of_relief(&s->common.options))
        mistake = "--characteristic field: frames have no relief; leave it out";
    if (!mistake)
        mistake = frame_camera_mistake(&s->camera);
    if (!mistake)
        mistake = shot_mistake(s);
    if (!mistake)
        mistake = append_mistake(s);
    if (!mistake)
        mistake = bent_place_mistake(s);
    if (!mistake)
        mistake = views_mistake(s, views);
    if (!mistake)
        mistake = frames_mistake(s, list);
    if (mistake) {
        report_error(r, "%s", mistake);
        return EXIT_USAGE;
    }
    return bent_check(&s->bent, &s->common.options, s->output, r);
}

static io_passes_request make_request(const ao_settings *s)
{
    io_passes_request request = pass_request(&s->passes);
    request.keep_overscan = !s->crop;
    frame_camera_share(&s->camera, &request);
    return request;
}

static int run(const void *settings, report *r)
{
    const ao_settings *s = settings;
    frame_list list;
    view_list views;
    const int result = check(s, &list, &views, r);
    if (result != EXIT_DONE)
        return result;
    frame_camera_doubt(&s->camera, r);
    const io_passes_request request = make_request(s);
    return shot_run(s, &request, s->frames ? &list : NULL, &views, r);
}

const command command_ao = {
    .name = "ao",
    .summary =
        "compute ambient occlusion from depth and normal passes, also of whole shots",
    .synopsis = "IN.exr -o OUT.exr [options]",
    .details =
        "The result has the frame's data window, overscan included. Without --radius the "
        "radius is 5 % of the view's height at the median depth; a range of frames keeps "
        "that of its first. Metadata of results say how they were made. `crevice help "
        "passes` lists the passes that are known by name.",
    .tables = tables,
    .library_options = true,
    .examples = examples,
    .settings_size = sizeof(ao_settings),
    .run = run,
};
