/* SPDX-License-Identifier: MIT */
/* target.h: the integral that a method estimates: what its truth is. */
#ifndef TOOL_TARGET_H
#define TOOL_TARGET_H

#include "reference.h"

/* Their words, in the order of crv_weighting and crv_falloff; NULL ends them. */
extern const char *const target_weightings[], *const target_falloffs[];

/* Rays, error and seed are left 0. */
reference_options target_of(const crv_options *options);

/* Whether both ask for the same integral. */
bool target_equal(const reference_options *a, const reference_options *b);

/* As flags of `crevice reference`: " --weighting cosine ...". Returns out. */
const char *target_flags(const reference_options *o, char *out, size_t size);

#endif
