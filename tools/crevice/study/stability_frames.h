/* SPDX-License-Identifier: MIT */
/* stability_frames.h: the frames of a camera that moves slowly
 * sideways, so that all points move in the picture, the near ones farther. */
#ifndef TOOL_STUDY_STABILITY_FRAMES_H
#define TOOL_STUDY_STABILITY_FRAMES_H

#include "stability.h"
#include "study.h"

enum { MOVE_FRAMES = 4 };

typedef struct camera_move {
    study_view base; /* the main view, half its size */
    study_view views[MOVE_FRAMES];
    const scene_gbuffer *gbuffers[MOVE_FRAMES]; /* kept by the views */
    float *planes[MOVE_FRAMES];          /* depth and normals of the frame below; owned */
    stability_frame frames[MOVE_FRAMES]; /* accessibility is the caller's */
    double step;                         /* scene units, from frame to frame */
    double motion_px;                    /* RMS, from frame to frame */
} camera_move;

/* Finds the step at which points move by motion_px (RMS), and makes the frames. Close it,
 * also after a failure. Returns an exit code. */
int camera_move_open(study *s, double motion_px, camera_move *out);
void camera_move_close(camera_move *o);

#endif
