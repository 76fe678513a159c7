/* SPDX-License-Identifier: MIT */
/* quadrature.h: the sums of alchemy and vo over the V groove, integrated in double
 * precision, independent of the library. */
#ifndef TESTS_QUADRATURE_H
#define TESTS_QUADRATURE_H

/* A point of the groove z = -depth + |x|, seen by an orthographic camera: on its right
 * wall, x to the right of the edge. */
typedef struct quadrature_site {
    double x, depth; /* depth of the edge */
    double radius;
} quadrature_site;

/* Alchemy's numbers, in scene units: sigma a length, eps an area; beta multiplies the
 * depth of the point. */
typedef struct quadrature_alchemy {
    double sigma, beta, eps;
} quadrature_alchemy;

/* 1 - 2 sigma / (pi R^2) Int max(0, v.n - d beta) / (v.v + eps) over the disk of the
 * radius around the point, parallel to the image; surface points farther than the radius
 * are dropped. Not clamped. */
double quadrature_of_alchemy(const quadrature_site *site,
                             const quadrature_alchemy *numbers);

/* min(1, 2 Int open / Int chord): lines along z through the sphere of the radius around
 * the point. */
double quadrature_of_vo(const quadrature_site *site);

#endif
