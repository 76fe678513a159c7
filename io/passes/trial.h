/* SPDX-License-Identifier: MIT */
/* trial.h: ways to take a frame, and how well each goes. */
#ifndef CREVICE_IO_PASSES_TRIAL_H
#define CREVICE_IO_PASSES_TRIAL_H

#include "camera.h"
#include "readings.h"

/* What is at hand while a frame is judged. */
typedef struct io__court {
    const char *path;
    const crv_logger *log;
    const io_passes_request *request;
    const io_frame *frame;
    bool has_normals;
    float *memory; /* planar depth of the trial; owned */
    crv_image planar;
} io__court;

/* One way to take the frame, and how well it goes. */
typedef struct trial {
    crv_camera camera;
    const io__camera_guess *guess;
    crv_depth_format format;
    char text[128]; /* what is different from the first, for messages */
    io__reading reading;
    size_t pairs;
    double bend;
} io__trial;

/* Degrees. From the first on, others are tried; from the second on, normals and depth
 * contradict each other; beyond the third, the normals are noise. */
#define IO__DOUBTFUL   2.0
#define IO__SUSPICIOUS 4.0
#define IO__WORST      20.0

/* Fills what a trial comes to. Returns 0, or -1 after an error line. */
int io__try(const io__court *c, io__trial *t);

/* Whether a trial contradicts the first one by far. */
bool io__is_better(const io__court *c, const io__trial *t, const io__trial *first);

/* Tries t; better keeps the best of those that contradict `first`, and found tells
 * whether there is one. Return 0, or -1 after an error line. */
int io__compare_trials(const io__court *c, const io__trial *first, io__trial *t,
                       io__trial *better, bool *found);
int io__try_encodings(const io__court *c, const io__trial *first, io__trial *better,
                      bool *found);
/* Other cameras of the file, then other focal lengths. */
int io__try_cameras(const io__court *c, const io__camera_guess *cameras, int count,
                    const io__trial *first, io__trial *better, bool *found);

/* Fits the focal length: normals and depth agree best at the right one. Returns 0, or -1
 * after an error line if the frame leaves it open. */
int io__fit_focal_length(const io__court *c, io__trial *t);

#endif
