/* SPDX-License-Identifier: MIT */
/*
 * flip.h: the difference that a person sees when two pictures alternate. Andersson,
 * Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: FLIP: A Difference Evaluator for
 * Alternating Images, 2020, for low dynamic range.
 */
#ifndef TOOL_FLIP_H
#define TOOL_FLIP_H

#include <stdbool.h>
#include <stdint.h>

#define FLIP_PPD_MIN 1.0
#define FLIP_PPD_MAX 500.0

/* The paper's viewing conditions: 0.7 m before a screen 0.7 m wide of 3840 pixels, which
 * makes 3840 pi / 180. */
#define FLIP_PPD_TEXT "67.0206"

/* Told of the rows that are done, after each. */
typedef void (*flip_watch)(void *user, int32_t rows);

/*
 * The mean over the compared pixels, 0 (equal) to 1; NAN without one. Values are grey
 * levels as a screen shows them (sRGB), and are clamped to [0, 1]. a, b, mask: as in
 * metrics.h; what is not compared counts as white in both pictures, since filters read
 * into it. ppd: pixels per degree of the visual field. watch may be NULL. Returns false
 * where memory ran out.
 */
bool flip_compare(const float *a, const float *b, const uint8_t *mask, int32_t width,
                  int32_t height, double ppd, flip_watch watch, void *user, double *mean);

#endif
