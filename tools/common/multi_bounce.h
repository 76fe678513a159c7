/* SPDX-License-Identifier: MIT */
/*
 * multi_bounce.h: light that surfaces pass on to each other, which accessibility leaves
 * out. Jimenez, Wu, Pesce and Jarabo, "Practical Real-Time Strategies for Accurate
 * Indirect Occlusion" (2016): accessibility A of a surface whose surroundings have the
 * albedo rho becomes
 *
 *     max(A, ((p A + q) A + r) A)
 *
 *     p = 2.0404 rho - 0.3324    q = -4.7951 rho + 0.6417    r = 2.7552 rho + 0.6903
 *
 * Nothing changes at A = 0, at A = 1, and (but for 2e-6) at rho = 0.
 */
#ifndef TOOL_MULTI_BOUNCE_H
#define TOOL_MULTI_BOUNCE_H

#include <stdbool.h>
#include <stddef.h>

/* accessibility: 0 to 1, as the result. An albedo outside of that counts as the nearer
 * end, NaN as 0. */
float multi_bounce(float accessibility, float albedo);

/* The same for planes of pixels; out may be one of them. */
void multi_bounce_plane(const float *accessibility, const float *albedo, size_t count,
                        float *out);

/* Reads "RHO" or "R,G,B"; false for any other text. */
bool multi_bounce_parse(const char *text, double rgb[3]);

/* Whether all three are 0 to 1. */
bool multi_bounce_is_albedo(const double rgb[3]);

#endif
