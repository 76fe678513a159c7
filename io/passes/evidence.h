/* SPDX-License-Identifier: MIT */
/*
 * evidence.h: what a frame is taken for. Camera, encoding of depth and space of normals
 * are guesses until the normals that depth implies agree with those that are given; if
 * there are none, walls and floors must come out flat.
 */
#ifndef CREVICE_IO_PASSES_EVIDENCE_H
#define CREVICE_IO_PASSES_EVIDENCE_H

#include "camera.h"
#include "readings.h"

/* What a frame is taken for. */
typedef struct io__verdict {
    io__camera_guess camera;
    crv_depth_format format;
    bool encoding_told;  /* a warning named another one */
    bool zooms;          /* as io_frame.zooms */
    io__reading reading; /* id 0: no normals, or none that can be believed */
} io__verdict;

/*
 * Judges the cameras and encodings, and logs what was found and what contradicts. The
 * frame has its depth as it is in the file, and its normals decoded if has_normals.
 * Returns 0, or -1 after an error line.
 */
int io__judge(const char *path, const io_passes_request *request,
              const crv_depth_format *format, const io__camera_guess *cameras, int count,
              bool has_normals, const io_frame *frame, io__verdict *out,
              const crv_logger *log);

#endif
