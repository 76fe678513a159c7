/* SPDX-License-Identifier: MIT */
/*
 * heatmap.h: the signed error of two pictures as colours. White is no error; blue is
 * negative, orange positive, both darker the larger the error. Blue and orange stay apart
 * for every common kind of colour blindness, and the lightness alone gives the size.
 */
#ifndef TOOL_HEATMAP_H
#define TOOL_HEATMAP_H

#include "report.h"

/* The colour of an error of `t` scales, linear light, each in [0, 1]. Past -1 and 1 it is
 * that of the end. */
void heatmap_colour(double t, float linear[3]);

/* What pixels are painted that are not compared: a grey, which no error is. */
extern const float heatmap_background; /* linear light */

/* (a - b) / scale as colours, linear light, planes of `count` values each. mask: a byte
 * for each pixel, zero for background, or NULL. */
void heatmap_fill(const float *a, const float *b, const uint8_t *mask, size_t count,
                  double scale, float *red, float *green, float *blue);

/* What is painted: see heatmap_fill(). */
typedef struct heatmap_source {
    const float *a, *b;
    const uint8_t *mask;
    int32_t width, height;
    double scale;
} heatmap_source;

/* Whether a heat map could be written there, and would not replace one of the inputs.
 * Returns an exit code; meant for before the work. */
int heatmap_check(const char *path, const char *input_a, const char *input_b, report *r);

/* PNG: R, G, B. EXR: these in linear light, and the signed error itself in a channel
 * "error", 0 in the background. Returns an exit code. */
int heatmap_write(const char *path, const heatmap_source *source, report *r);

#endif
