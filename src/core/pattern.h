/* SPDX-License-Identifier: MIT */
/*
 * Sample patterns, made when a plan is made. Points are four floats each; what they mean
 * is the method's affair. Every prefix of a pattern is well spread. `seed` makes another
 * pattern.
 */
#ifndef CRV_CORE_PATTERN_H
#define CRV_CORE_PATTERN_H

#include <stdint.h>

/* Poisson-disk points (x, y) in the unit disk, area-uniform; z = sqrt(1 - x^2 - y^2), w
 * = 1. */
void crv__pattern_disk(float *points, int32_t count, int32_t seed);

/* The same, with -p following each p, so that a plane through the centre is cut in half
 * by every pair. An odd count ends with the centre. */
void crv__pattern_disk_pairs(float *points, int32_t count, int32_t seed);

/* Points of a low-discrepancy sequence in the unit cube, in x, y, z; w = 1. */
void crv__pattern_cube(float *points, int32_t count, int32_t seed);

/* The point of the unit disk to which Shirley and Chiu's concentric map takes (u, v) in
 * the unit square: area is kept, neighbours stay neighbours. */
void crv__concentric(double u, double v, double *x, double *y);

#endif
