/* SPDX-License-Identifier: MIT */
/*
 * camera_file.h: cameras of a shot from a file: JSON as `crevice gbuffer` writes it, or
 * Nuke's .chan. View space is right-handed in all of them: x right, y up, looking along
 * -z.
 */
#ifndef TOOL_CAMERA_FILE_H
#define TOOL_CAMERA_FILE_H

#include "report.h"
#include "scene.h"

typedef struct camera_entry {
    bool has_frame; /* else it is the camera of any frame */
    int32_t frame;
    bool has_pose;
    double to_view[9];       /* world to view: rows right, up, back */
    double eye[3];           /* world space, scene units */
    double target[3], up[3]; /* as given, or a unit before the eye */
    /* One of them, the others 0; all 0 if the file does not say. Full angles, and the
     * height of an orthographic view in scene units. */
    double vfov_rad, hfov_rad, view_height;
} camera_entry;

typedef struct camera_file {
    const char *path;
    uint64_t checksum;     /* of the file's bytes: tells whether it changed */
    camera_entry *entries; /* owned */
    int32_t count, capacity;
} camera_file;

/* In the order of the choices: the rotation that stands first is applied first. */
extern const char *const camera_file_orders[];
enum { CAMERA_FILE_ZXY = 0 }; /* Nuke's default */

/* Whether it is named as a file of cameras: .json or .chan. */
bool camera_file_is_named(const char *path);

/* order: index of camera_file_orders, for the angles of .chan, which do not say. `path`
 * must stay. Returns an exit code; camera_file_free() must follow EXIT_DONE. */
int camera_file_load(const char *path, int order, camera_file *out, report *r);
void camera_file_free(camera_file *file);

/* Writes one camera as JSON. Returns an exit code. */
int camera_file_write(const char *path, const scene_view *view, report *r);

/* The camera of a frame; has_frame: false if its number is not known, which is enough if
 * there is one camera only. NULL after an error line that names `of`, the frame's file;
 * without the line if r is NULL. */
const camera_entry *camera_file_find(const camera_file *file, bool has_frame,
                                     int32_t frame, const char *of, report *r);

#endif
