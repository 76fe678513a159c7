/* SPDX-License-Identifier: MIT */
/*
 * heatmap.h: the signed error of two pictures as colours. White is no error; blue is
 * negative, orange positive, both darker the larger the error. Blue and orange stay apart
 * for every common kind of colour blindness, and the lightness alone gives the size.
 */
#ifndef TOOL_HEATMAP_H
#define TOOL_HEATMAP_H

#include <stddef.h>
#include <stdint.h>

/* The colour of an error of `t` scales, linear light, each in [0, 1]. Past -1 and 1 it is
 * that of the end. */
void heatmap_colour(double t, float linear[3]);

/* What pixels are painted that are not compared: a grey, which no error is. */
extern const float heatmap_background; /* linear light */

/* (a - b) / scale as colours, linear light, planes of `count` values each. mask: a byte
 * for each pixel, zero for background, or NULL. */
void heatmap_fill(const float *a, const float *b, const uint8_t *mask, size_t count,
                  double scale, float *red, float *green, float *blue);

#endif
