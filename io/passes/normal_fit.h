/* SPDX-License-Identifier: MIT */
/*
 * normal_fit.h: the rotation between two sets of directions that belong together pair by
 * pair, some of the pairs wrong. Plain mathematics: knows nothing of files or G-buffers.
 */
#ifndef CREVICE_IO_PASSES_NORMAL_FIT_H
#define CREVICE_IO_PASSES_NORMAL_FIT_H

#include <stdbool.h>
#include <stddef.h>

/* Unit vectors, count of each. */
typedef struct io__normal_pairs {
    const float (*from)[3];
    const float (*to)[3];
    size_t count;
} io__normal_pairs;

/*
 * The rotation that takes `from` to `to` with the smallest robust error; mirrored: after
 * the z of `from` is negated. Row-major, to = rotation * from. Any minimiser if
 * several are as good (all directions parallel, or in a plane). Returns 0, or -1 if
 * count is 0 or memory is missing. Deterministic.
 */
int io__normal_fit(const io__normal_pairs *pairs, bool mirrored, double rotation[9]);

/* The median angle in radians between rotation * from and to; -1 if count is 0 or
 * memory is missing. */
double io__normal_deviation(const io__normal_pairs *pairs, bool mirrored,
                            const double rotation[9]);

#endif
