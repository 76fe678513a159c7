/* SPDX-License-Identifier: MIT */
/* ao_camera.h: the camera of each frame, from --camera FILE. */
#ifndef TOOL_AO_CAMERA_H
#define TOOL_AO_CAMERA_H

#include "ao_settings.h"
#include "common/camera_file.h"
#include "passes/passes.h"

/* A frame of the shot: its number, if it has one, and its file. */
typedef struct ao_frame {
    bool has_number;
    int32_t number;
    const char *path;
} ao_frame;

/* Puts the frame's camera into the request. Returns an exit code: EXIT_USAGE if it
 * contradicts the flags. r NULL: without an error line. */
int ao_camera_set(const ao_settings *s, const camera_file *file, const ao_frame *frame,
                  io_passes_request *request, report *r);

/* The last number in a file's name, its extension apart; false if there is none. */
bool ao_camera_number(const char *path, int32_t *number);

#endif
