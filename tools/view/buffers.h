/* SPDX-License-Identifier: MIT */
/* buffers.h: a G-buffer that several threads read until the last of them lets it go. */
#ifndef VIEW_BUFFERS_H
#define VIEW_BUFFERS_H

#include "scene.h"

typedef struct buffers {
    scene_gbuffer g;
    int32_t width, height; /* px, inside the guard band */
    float *beauty;    /* owned; linear light, three floats for each pixel inside the guard
                      band; NULL: there is none */
    uint8_t *surface; /* 1 for each pixel inside the guard band that shows one */
    atomic_int holders;
} buffers;

/* Takes over *g, also on failure. NULL: no memory. The caller holds it. */
buffers *buffers_make(scene_gbuffer *g);

/* One more holder; returns b. NULL is fine for both. */
buffers *buffers_hold(buffers *b);
void buffers_release(buffers *b);

/* The point of a texel of the whole buffer, guard band included, view space (camera.h);
 * false: background. */
bool buffers_point(const buffers *b, int32_t x, int32_t y, double out[3]);

/* The index in the G-buffer's planes of a pixel inside the guard band. */
size_t buffers_index(const buffers *b, int32_t x, int32_t y);

#endif
