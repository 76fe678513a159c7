/* SPDX-License-Identifier: MIT */
/* The deinterleaved structure, computed for one pixel after the other. */
#ifndef TESTS_DEINTERLEAVED_REFERENCE_H
#define TESTS_DEINTERLEAVED_REFERENCE_H

#include "simd.h"

/*
 * What the deinterleaved structure computes for a case without a filter: the scalar
 * methods with the projected radius that a pixel shares with its group. Packed like
 * simd_run()'s result; bent normals are NaN where there is no surface. The caller frees
 * it. *structured: how many pixels had a bucket; 0 where the structure is not used at
 * all, and everything is exact. NULL where memory is out.
 */
float *deinterleaved_reference(const simd_case *c, int32_t *structured);

#endif
