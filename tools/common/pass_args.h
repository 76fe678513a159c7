/* SPDX-License-Identifier: MIT */
/* pass_args.h: the arguments that say where a frame's depth and normals are and what
 * their numbers mean, as ao and view have them. */
#ifndef TOOL_PASS_ARGS_H
#define TOOL_PASS_ARGS_H

#include "args.h"
#include "passes/passes.h"

typedef struct pass_settings {
    const char *depth, *normal, *normal_flip;
    arg_int depth_encoding, normal_space;
    arg_number z_near, z_far, background;
} pass_settings;

const char *pass_encoding(int32_t index); /* of a crv_depth_encoding */
extern const char *const pass_spaces[];   /* in the order of io_normal_space */

/* What is wrong with them, and what to do; NULL: nothing. ortho: the camera is
 * orthographic. */
const char *pass_mistake(const pass_settings *p, bool ortho);

/* A request that says so; the camera and the rest are left to be found. */
io_passes_request pass_request(const pass_settings *p);

/* Whether an input is a frame, by its extension: .exr, .png, .pfm; else a mesh. */
bool pass_is_frame(const char *input);

/* The rows, for a table of settings that have them as `member_`. */
#define PASS_ROWS(settings_, member_)                                                    \
    {.name = "--depth",                                                                  \
     .value = "NAME",                                                                    \
     .computed = "found by its name",                                                    \
     ARG_INTO(ARG_TEXT, settings_, member_.depth),                                       \
     .help = "the depth channel, or positions without .X .Y .Z"},                        \
        {.name = "--normal",                                                             \
         .value = "NAME",                                                                \
         .computed = "found by its name",                                                \
         ARG_INTO(ARG_TEXT, settings_, member_.normal),                                  \
         .help = "the normals, without .X .Y .Z; none: take them from depth"},           \
        {.name = "--normal-space",                                                       \
         .value = "SPACE",                                                               \
         .choices = pass_spaces,                                                         \
         .initial = "find",                                                              \
         ARG_INTO(ARG_CHOICE, settings_, member_.normal_space),                          \
         .help = "the space of the normals"},                                            \
        {.name = "--normal-flip",                                                        \
         .value = "AXES",                                                                \
         ARG_INTO(ARG_TEXT, settings_, member_.normal_flip),                             \
         .help = "axes of the normals to negate, of x, y and z: y for a green that "     \
                 "points down, z for normals that look into the picture"},               \
        {.name = "--depth-encoding",                                                     \
         .value = "KIND",                                                                \
         .choice_name = pass_encoding,                                                   \
         .computed = "planar, or radial if the normals fit that",                        \
         ARG_INTO(ARG_CHOICE, settings_, member_.depth_encoding),                        \
         .help = "planar: distance along the viewing axis; radial: from the eye; "       \
                 "hardware: depth buffer, 0 at near; reversed: 1 at near; disparity: "   \
                 "1/planar; normalised: planar, 0 at near and 1 at far; "                \
                 "normalised-reversed: 1 at near; gl: depth buffer from -1 to 1; "       \
                 "logarithmic: log(1 + planar)/log(1 + far)"},                           \
        {.name = "--near",                                                               \
         .value = "D",                                                                   \
         ARG_RANGE(-1e9, 1e9),                                                           \
         .unit = "scene units",                                                          \
         ARG_INTO(ARG_NUMBER, settings_, member_.z_near),                                \
         .help = "near plane of a depth between planes"},                                \
        {.name = "--far",                                                                \
         .value = "D",                                                                   \
         ARG_RANGE(-1e9, INFINITY),                                                      \
         .unit = "scene units",                                                          \
         ARG_INTO(ARG_NUMBER, settings_, member_.z_far),                                 \
         .help = "its far plane; inf for an infinite projection"},                       \
    {                                                                                    \
        .name = "--background", .value = "D", ARG_RANGE(1e-30, INFINITY),                \
        .unit = "scene units", ARG_INTO(ARG_NUMBER, settings_, member_.background),      \
        .computed = "1e10",                                                              \
        .help = "planar or radial depth from which on there is nothing"                  \
    }

#endif
