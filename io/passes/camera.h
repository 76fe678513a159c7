/* SPDX-License-Identifier: MIT */
/* camera.h: the cameras that may have made a frame. */
#ifndef CREVICE_IO_PASSES_CAMERA_H
#define CREVICE_IO_PASSES_CAMERA_H

#include "passes.h"

enum { IO__MAX_CAMERAS = 2 };

typedef struct io__camera_guess {
    crv_camera camera; /* pixels of the data window */
    bool needs_lens;   /* the focal length stands for one that is to be found */
    bool has_rotation;
    double to_view[9]; /* world to view space; a reflection if the world is left-handed */
    const char *text;  /* where it comes from */
} io__camera_guess;

/* The cameras, the likeliest first; one if the caller gives it. `image` has been read, so
 * that its metadata are those of the depth's part. Returns how many, 0 if nothing tells
 * of any: io__fail_camera() then says so and returns -1. */
int io__find_cameras(const char *path, const io_image *image,
                     const io_passes_request *request,
                     io__camera_guess out[IO__MAX_CAMERAS], const crv_logger *log);

int io__fail_camera(const char *path, const io_passes_request *request,
                    const crv_logger *log);

#endif
