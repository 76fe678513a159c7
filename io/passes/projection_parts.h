/* SPDX-License-Identifier: MIT */
/* projection_parts.h: what the fits of projection.h share. */
#ifndef CREVICE_IO_PASSES_PROJECTION_PARTS_H
#define CREVICE_IO_PASSES_PROJECTION_PARTS_H

#include "projection.h"

enum { IO__FIT_ROUNDS = 6, IO__FEWEST_POINTS = 30 };

double io__dot3(const double a[3], const double b[3]);

/* View space of a point: x right, y up, and depth. */
void io__view_of(const io__projection *c, const double p[3], double v[3]);

/* How much a point counts that lies this far off, others lying `usual` off. */
double io__weight_of(double error, double usual);

#endif
