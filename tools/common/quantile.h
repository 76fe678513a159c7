/* SPDX-License-Identifier: MIT */
/* quantile.h: medians and other quantiles. */
#ifndef TOOL_QUANTILE_H
#define TOOL_QUANTILE_H

#include <stddef.h>

/* In ascending order; no value may be NAN. */
void quantile_sort(double *values, size_t count);

/* Of sorted values, count >= 1: the first is at 0, the last at 1, the others evenly
 * between; between two values in a line. */
double quantile(const double *sorted, size_t count, double share);

#endif
