/* SPDX-License-Identifier: MIT */
#ifndef TOOL_HELP_CAMERA_H
#define TOOL_HELP_CAMERA_H

#include <stdio.h>

/* Writes what files of cameras may hold. */
void help_camera(FILE *out);

#endif
