/* SPDX-License-Identifier: MIT */
/* stability_reference.h: the first two frames of a camera's move, ray traced. */
#ifndef TOOL_STUDY_STABILITY_REFERENCE_H
#define TOOL_STUDY_STABILITY_REFERENCE_H

#include "stability_frames.h"

/* Rays for each pixel and repetition. */
enum { STABILITY_RAYS = 64 };

/* A point is steady where the reference changes by less than this. The noise of the rays
 * makes a change of about 0.02, of which this is several times as much. */
#define STABILITY_STEADY 0.1

typedef struct stability_truth {
    study_target target;
    float *planes;   /* both repetitions of the first frame, then of the second; owned */
    uint8_t *steady; /* points of the second frame; owned */
    double all2;     /* mean squared change of all points, free of the rays' noise */
    double steady2;  /* of the steady points */
    double share;    /* of points that are steady */
} stability_truth;

/* Both frames are traced twice, with other rays. Free it, also after a failure. Returns
 * an exit code. */
int stability_truth_trace(study *s, const camera_move *move, const study_target *target,
                          stability_truth *out);
void stability_truth_free(stability_truth *t);

/* Of the steady points of estimates of both frames: the mean squared change, and that of
 * their error, free of the rays' noise. Returns an exit code. */
int stability_truth_compare(study *s, const camera_move *move, const stability_truth *t,
                            float *const estimates[2], double *change2, double *error2);

#endif
