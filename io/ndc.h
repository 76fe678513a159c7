/* SPDX-License-Identifier: MIT */
/* ndc.h: cameras from EXR metadata. */
#ifndef CREVICE_IO_NDC_H
#define CREVICE_IO_NDC_H

#include "io.h"

typedef struct io__ndc_camera {
    crv_camera camera; /* pixels of the display window; world_to_view is not set */
    /* World to view space, row-major; a reflection if the world is left-handed. */
    double to_view[9];
    bool is_signed; /* the matrix maps to -1 to 1 rather than to 0 to 1 */
} io__ndc_camera;

/*
 * The cameras that worldToNDC may describe, the likeliest first: OpenEXR defines 0 to 1
 * with y down; renderers write clip coordinates in its place, -1 to 1 with y up. Returns
 * how many there are, 0 to 2; none if the matrix is missing, the identity or no
 * projection.
 */
int io__cameras_from_ndc(const io_camera_metadata *metadata, int32_t display_width,
                         int32_t display_height, io__ndc_camera out[2]);

/* Whether a matrix is the identity, which programs write that know of no camera. */
bool io__is_identity(const float m[16]);

/* The rotation in worldToCamera, turned to look down -Z. Returns 0 or -1. */
int io__rotation_from_world_to_camera(const float world_to_camera[16], float rotation[9]);

#endif
