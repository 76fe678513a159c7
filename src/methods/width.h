/* SPDX-License-Identifier: MIT */
/*
 * The width of the surface at a pixel, in scene units. On each of four axes of the image
 * (rows, columns, diagonals) it is the sum of the distances to the nearest silhouettes on
 * both sides, times d/f. The smallest of the four counts; INFINITY if no axis has
 * silhouettes on both sides within 32 px.
 *
 * A silhouette lies half way to a neighbour that is more than 0.2 R behind the surface.
 * The surface is the plane through the pixel and its neighbour on the other side,
 * extrapolated in 1/d, if that plane recedes by less than 0.2 R; else it continues at the
 * pixel's own depth. A neighbour more than 0.2 R in front ends the search, because it
 * hides the end of the surface; so does the border.
 */
#ifndef CRV_METHODS_WIDTH_H
#define CRV_METHODS_WIDTH_H

#include "core/registry.h"

extern const crv__map crv__map_width;

#endif
