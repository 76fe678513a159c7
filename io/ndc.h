/* SPDX-License-Identifier: MIT */
/* ndc.h: cameras from EXR metadata. */
#ifndef CREVICE_IO_NDC_H
#define CREVICE_IO_NDC_H

#include "io.h"

/*
 * The camera that worldToNDC describes, in pixels of the display window, world_to_view
 * included. World space is taken to be right-handed. Both worldToNDC as OpenEXR defines
 * it (0 to 1, y down) and clip coordinates as renderers write them in its place (-1 to 1,
 * y up or down) are understood. Returns 0, or -1 if the matrix is no such projection.
 */
int io__camera_from_ndc(const io_camera_metadata *metadata, int32_t display_width,
                        int32_t display_height, crv_camera *camera);

/* The rotation in worldToCamera, turned to look down -Z. Returns 0 or -1. */
int io__rotation_from_world_to_camera(const float world_to_camera[16], float rotation[9]);

#endif
