/* SPDX-License-Identifier: MIT */
/*
 * projection.h: the camera that sees known points at known pixels. Plain mathematics:
 * knows nothing of files or G-buffers.
 */
#ifndef CREVICE_IO_PASSES_PROJECTION_H
#define CREVICE_IO_PASSES_PROJECTION_H

#include <stdbool.h>
#include <stddef.h>

typedef struct io__points {
    const double (*position)[3];
    const double (*pixel)[2]; /* x to the right, y down */
    size_t count;
} io__points;

typedef struct io__projection {
    bool orthographic;
    double
        to_view[9]; /* rows right, up, back; a reflection if the space is left-handed */
    double eye[3];
    double fx_px, fy_px, cx_px, cy_px; /* as of crv_camera */
    double error_px; /* median distance of the points from where they are projected */
} io__projection;

/* A pose that is known: only the lens is fitted, perspective unless orthographic is set.
 * Points behind the eye are left out. Returns 0, or -1 if the points leave it open or
 * memory is missing. */
int io__fit_lens(const io__points *points, bool orthographic, const double to_view[9],
                 const double eye[3], io__projection *out);

/*
 * The whole camera, by least squares of the linear equations between points and pixels
 * (Abdel-Aziz and Karara 1971), weighted again until far-off points count for little. Of
 * an orthographic camera the handedness is free: it is right-handed. Returns 0, or -1 if
 * the points leave it open (all in a plane) or memory is missing.
 */
int io__fit_camera(const io__points *points, io__projection *out);

/* How far from its pixel a camera puts a point, in pixels; INFINITY behind the eye. */
double io__projection_error_at(const io__projection *camera, const double position[3],
                               const double pixel[2]);

/* The median distance in pixels between the points and where a camera puts them; INFINITY
 * if memory is missing. */
double io__projection_error(const io__points *points, const io__projection *camera);

#endif
