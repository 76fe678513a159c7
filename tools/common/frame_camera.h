/* SPDX-License-Identifier: MIT */
/* frame_camera.h: how ao and view are told the camera of frames: by a lens for all of
 * them, or by a file with the camera of each. */
#ifndef TOOL_FRAME_CAMERA_H
#define TOOL_FRAME_CAMERA_H

#include "args.h"
#include "camera_file.h"
#include "passes/passes.h"

typedef struct frame_camera_settings {
    const char *file;                                         /* of cameras */
    arg_int order;                                            /* of a .chan's rotations */
    arg_number vfov_deg, hfov_deg, lens_mm, sensor_mm, ortho; /* vfov_deg NAN: fit */
} frame_camera_settings;

/* The one word that may stand for a vertical field of view: find it. */
extern const char *const frame_camera_found[];

/* A frame of the shot: its number, if it has one, and its file. */
typedef struct camera_frame {
    bool has_number;
    int32_t number;
    const char *path;
} camera_frame;

/* What is wrong with them, and what to do; NULL: nothing. */
const char *frame_camera_mistake(const frame_camera_settings *s);
/* Warns of angles that look like radians. */
void frame_camera_doubt(const frame_camera_settings *s, report *r);

/* Puts what all frames share into the request. */
void frame_camera_share(const frame_camera_settings *s, io_passes_request *request);

/* Puts the frame's camera into the request. Returns an exit code: EXIT_USAGE if it
 * contradicts the flags. r NULL: without an error line. */
int frame_camera_set(const frame_camera_settings *s, const camera_file *file,
                     const camera_frame *frame, io_passes_request *request, report *r);

/* The last number in a file's name, its extension apart; false if there is none. */
bool frame_camera_number(const char *path, int32_t *number);

/* The rows, for a table of settings that have them as `member_`. */
#define FRAME_CAMERA_FILE_ROW(settings_, member_)                                        \
    {                                                                                    \
        .name = "--camera", .value = "FILE",                                             \
        ARG_INTO(ARG_TEXT, settings_, member_.file),                                     \
        .help = "cameras by frame: .json, as `crevice gbuffer` writes it, or Nuke's "    \
                ".chan; `crevice help camera` says what may stand in them"               \
    }
#define FRAME_CAMERA_VFOV_ROW(settings_, member_)                                        \
    {                                                                                    \
        .name = "--vfov", .value = "DEG", .choices = frame_camera_found,                 \
        ARG_RANGE(0.1, 179.0), .unit = "degrees",                                        \
        ARG_INTO(ARG_NUMBER, settings_, member_.vfov_deg),                               \
        .computed = "from the file's metadata",                                          \
        .help = "full vertical field of view; fit: find the one at which normals and "   \
                "depth agree, for all frames of a shot"                                  \
    }
#define FRAME_CAMERA_ORTHO_ROW(settings_, member_)                                       \
    {                                                                                    \
        .name = "--ortho", .value = "HEIGHT", ARG_RANGE(1e-9, 1e9),                      \
        .unit = "scene units", ARG_INTO(ARG_NUMBER, settings_, member_.ortho),           \
        .help = "orthographic view of this height, instead of --vfov"                    \
    }
#define FRAME_CAMERA_ORDER_ROW(settings_, member_)                                       \
    {                                                                                    \
        .name = "--camera-order", .value = "ORDER", .choices = camera_file_orders,       \
        .initial = "zxy", ARG_INTO(ARG_CHOICE, settings_, member_.order),                \
        .help = "the order in which a .chan's rotations are applied"                     \
    }
#define FRAME_CAMERA_LENS_ROWS(settings_, member_)                                       \
    {.name = "--hfov",                                                                   \
     .value = "DEG",                                                                     \
     ARG_RANGE(0.1, 179.0),                                                              \
     .unit = "degrees",                                                                  \
     ARG_INTO(ARG_NUMBER, settings_, member_.hfov_deg),                                  \
     .help = "full horizontal field of view, instead of --vfov"},                        \
        {.name = "--lens",                                                               \
         .value = "MM",                                                                  \
         ARG_RANGE(1e-3, 1e6),                                                           \
         .unit = "mm",                                                                   \
         ARG_INTO(ARG_NUMBER, settings_, member_.lens_mm),                               \
         .help = "focal length, instead of --vfov; with --sensor"},                      \
    {                                                                                    \
        .name = "--sensor", .value = "MM", ARG_RANGE(1e-3, 1e6), .unit = "mm",           \
        .initial = "36", ARG_INTO(ARG_NUMBER, settings_, member_.sensor_mm),             \
        .help = "width of the sensor that --lens belongs to"                             \
    }

#endif
