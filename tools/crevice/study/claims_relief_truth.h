/* SPDX-License-Identifier: MIT */
/* claims_relief_truth.h: ambient occlusion of a height field by rays, in double
 * precision, from the map itself: independent of the library and of the ray caster. */
#ifndef TOOL_STUDY_CLAIMS_RELIEF_TRUTH_H
#define TOOL_STUDY_CLAIMS_RELIEF_TRUTH_H

#include <stdint.h>

enum { RELIEF_TEXELS = 128 };

/* A square map that repeats, bilinear between texel centres at half-integers. */
typedef struct relief_map {
    float texels[RELIEF_TEXELS * RELIEF_TEXELS];
    double size;  /* scene units of its edge */
    double scale; /* scene units of a height of 1 */
} relief_map;

/* Cobbles of a quarter of the map's edge, in courses that are shifted by half. */
void relief_cobbles(relief_map *map, double size, double scale);

typedef struct relief_value {
    double none, cubic; /* cosine weighting, these falloffs */
    double sphere;      /* the tangent sphere's visible share */
} relief_value;

/* Accessibility of the surface at (x, y), scene units to the right and down over the map,
 * with edge * edge rays; seed turns the set. */
relief_value relief_trace(const relief_map *map, double x, double y, double radius,
                          int edge, uint32_t seed);

/* The largest difference from the closed forms of a V groove, falloff none and tangent
 * sphere. */
double relief_trace_error(void);

#endif
