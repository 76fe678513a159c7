/* SPDX-License-Identifier: MIT */
/* camera_parse.h: the formats of camera_file.h. */
#ifndef TOOL_CAMERA_PARSE_H
#define TOOL_CAMERA_PARSE_H

#include "camera_file.h"

/* Adds the cameras of a text with a zero behind its `size` bytes. Return exit codes. */
int camera_parse_json(const char *text, size_t size, camera_file *out, report *r);
int camera_parse_chan(const char *text, int order, camera_file *out, report *r);

int camera_file_add(camera_file *file, const camera_entry *entry, report *r);

/* Fill the pose. Return what is wrong, or NULL. The matrix is row by row and may have its
 * translation in the last column or in the last row; its scale is dropped. */
const char *camera_pose_look_at(const double eye[3], const double target[3],
                                const double up[3], camera_entry *entry);
const char *camera_pose_matrix(double m[16], bool to_world, camera_entry *entry);

/* Fills the rest of a pose from to_view and eye. */
void camera_pose_aim(camera_entry *entry);

/* A frame's number, whole and of at most eight digits. */
bool camera_is_frame(double number);

#endif
