/* SPDX-License-Identifier: MIT */
/* view.h: the arguments and steps that render and gbuffer share: model, camera, layers.
 */
#ifndef TOOL_VIEW_H
#define TOOL_VIEW_H

#include "args.h"
#include "scene.h"

/* The settings of both commands begin with this. */
typedef struct view_settings {
    common_settings common;
    const char *model;
    const char *output;
    arg_size size;
    arg_vector eye, target, up;
    arg_number vfov_deg, ortho;
    const char *camera; /* of the model, by name or number; or a file of cameras */
    arg_int layers, layer_kind, normals_from, guard_px;
    arg_number import_timeout_s;
} view_settings;

extern const arg_table view_camera;  /* --size, --eye ... */
extern const arg_table view_buffers; /* --layers ... */

/* How long a model may take to be read. */
#define VIEW_IMPORT_ROW                                                                  \
    {                                                                                    \
        .name = "--import-timeout", .value = "S", .type = ARG_NUMBER, .min = 0.01,       \
        .max = 1e6, .unit = "seconds", .initial = "600",                                 \
        .offset = offsetof(view_settings, import_timeout_s),                             \
        .help = "give up a model file whose reader takes longer"                         \
    }

/* The rows of the camera, of settings that begin with view_settings. found_: the word
 * that may stand for --vfov, or NULL; vfov_: its default; help_: of --camera. */
#define VIEW_CAMERA_ROWS(found_, vfov_, help_)                                           \
    {.name = "--size",                                                                   \
     .value = "WxH",                                                                     \
     .initial = "1280x720",                                                              \
     ARG_INTO(ARG_SIZE, view_settings, size),                                            \
     .help = "size of the picture"},                                                     \
        {.name = "--camera",                                                             \
         .value = "NAME",                                                                \
         ARG_INTO(ARG_TEXT, view_settings, camera),                                      \
         .help = help_},                                                                 \
        {.name = "--eye",                                                                \
         .value = "X,Y,Z",                                                               \
         .unit = "in scene units",                                                       \
         ARG_INTO(ARG_VECTOR, view_settings, eye),                                       \
         .computed = "framed",                                                           \
         .help = "where the camera is"},                                                 \
        {.name = "--target",                                                             \
         .value = "X,Y,Z",                                                               \
         .unit = "in scene units",                                                       \
         ARG_INTO(ARG_VECTOR, view_settings, target),                                    \
         .computed = "the scene's centre",                                               \
         .help = "the point that it looks at"},                                          \
        {.name = "--up",                                                                 \
         .value = "X,Y,Z",                                                               \
         ARG_INTO(ARG_VECTOR, view_settings, up),                                        \
         .computed = "0,1,0",                                                            \
         .help = "the direction that is up in the picture"},                             \
        {.name = "--vfov",                                                               \
         .value = "DEG",                                                                 \
         .choices = found_,                                                              \
         ARG_RANGE(0.1, 179.0),                                                          \
         .unit = "degrees",                                                              \
         ARG_INTO(ARG_NUMBER, view_settings, vfov_deg),                                  \
         .computed = vfov_,                                                              \
         .help = "full vertical field of view"},                                         \
    {                                                                                    \
        .name = "--ortho", .value = "HEIGHT", ARG_RANGE(1e-9, 1e9),                      \
        .unit = "scene units", ARG_INTO(ARG_NUMBER, view_settings, ortho),               \
        .help = "orthographic view of this height, instead of --vfov"                    \
    }

#define VIEW_MODEL_ROW                                                                   \
    {                                                                                    \
        .name = "MODEL", .type = ARG_TEXT, .required = true,                             \
        .offset = offsetof(view_settings, model),                                        \
        .help = "mesh file (glTF, OBJ, PLY, STL, FBX, ...), or a scene made in code: "   \
                "builtin:courtyard, ... (see `crevice help scenes`)"                     \
    }

/* What can be known to be wrong before anything is loaded. Returns an exit code. */
int view_check(const view_settings *s, report *r);

/* Loads the model, or makes the built-in one. */
int view_load(const view_settings *s, scene **out, report *r);

/* The framed view, changed as the user says. An eye alone looks at the scene's centre; a
 * target alone is seen from the framed direction and distance. */
int view_choose(const view_settings *s, const scene *model, scene_view *v, report *r);

/* Chooses the camera and ray-casts the G-buffer, texture frames included if they are
 * wanted. */
int view_render(const view_settings *s, const scene *model, bool texture_frames,
                scene_gbuffer *out, report *r);

/* The width of the guard band: as given, or a tenth of the height. */
int32_t view_guard_px(const view_settings *s);

/* Whether any pixel inside the guard band shows a surface. */
bool view_shows_something(const scene_gbuffer *g);

/* sin^2 of the angle between the view's direction and its up; NAN if the view is a
 * point. */
double view_up_slant(const scene_view *v);

/* The cross product. */
void view_cross(const double a[3], const double b[3], double out[3]);

#endif
