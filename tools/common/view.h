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
