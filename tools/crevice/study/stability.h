/* SPDX-License-Identifier: MIT */
/*
 * stability.h: how much the accessibility of surface points changes from one frame to the
 * next. Each surface point of the latter frame is looked up in the former one; what was
 * hidden or outside there is left out.
 */
#ifndef TOOL_STUDY_STABILITY_H
#define TOOL_STUDY_STABILITY_H

#include <stdbool.h>

#include "crevice/crevice.h"

/* Packed planes of width * height. Not owned. */
typedef struct stability_frame {
    crv_camera camera; /* of these pixels; world_to_view set */
    double eye[3];     /* world space */
    int32_t width, height;
    const float *depth;   /* planar; background is not finite */
    const float *normals; /* view space, 3 for each pixel */
    const float *accessibility;
    /* The same, estimated again with other random numbers. The product of both changes is
     * free of what random numbers add to the square of one. NULL: accessibility. */
    const float *repetition;
    const uint8_t *mask; /* of the latter frame: nonzero to follow. NULL: all */
} stability_frame;

/* Where a point of the latter frame is found in the former: bilinear weights of the
 * texels that show the same surface. */
typedef struct stability_taps {
    int32_t count; /* 0: not found */
    int32_t index[4];
    double weight[4];              /* sum: 1 */
    double moved_x_px, moved_y_px; /* from the former to the latter */
} stability_taps;

/* The point at pixel (x, y) of the latter frame; count is 0 in the background, too. */
void stability_find(const stability_frame *former, const stability_frame *latter,
                    int32_t x, int32_t y, stability_taps *out);

/* How much the accessibility of that point changes. False where it is not found. */
bool stability_point(const stability_frame *former, const stability_frame *latter,
                     int32_t x, int32_t y, double *change, double *repetition);

typedef struct stability {
    int64_t points;    /* followed and found */
    int64_t lost;      /* followed, but hidden or outside before */
    double change2;    /* sum of change times the repetition's change */
    double motion2_px; /* sum of squared motion */
} stability;

/* Adds what changes between two frames. */
void stability_add(stability *sum, const stability_frame *former,
                   const stability_frame *latter);

#endif
