/* SPDX-License-Identifier: MIT */
/* paint.h: planes of floats to pixels of the screen, 0xFFRRGGBB, as Cairo has them. */
#ifndef VIEW_PAINT_H
#define VIEW_PAINT_H

#include <stddef.h>
#include <stdint.h>

/* Accessibility as the grey that a PNG of it has. */
void paint_grey(const float *accessibility, size_t count, uint32_t *out);

/* dark + accessibility (light - dark), linear light, as the sRGB that a PNG has: dark and
 * light are three floats a pixel; dark NULL: black. */
void paint_lit(const float *dark, const float *light, const float *accessibility,
               size_t count, uint32_t *out);

/* a - b as the heat map of `crevice compare`; grey if surface is 0. */
void paint_difference(const float *a, const float *b, const uint8_t *surface,
                      double scale, size_t count, uint32_t *out);

/* The pixels from `first` on, of which nothing is known yet: squares over `instead`, an
 * accessibility; NULL: over nothing. */
void paint_unknown(const float *instead, size_t first, size_t count, int32_t width,
                   uint32_t *out);

#endif
