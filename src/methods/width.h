/* SPDX-License-Identifier: MIT */
/*
 * The width of what is seen at a pixel, in scene units: over the four axes of the image
 * the distance to the nearest silhouette on both sides; their sum times d/f; the
 * smallest. INFINITY where no axis has silhouettes on both sides within 32 px.
 *
 * A silhouette lies half way to a neighbour that is more than 0.2 R behind the surface:
 * the plane through the pixel and the one on the other side, which 1/d extrapolates. It
 * is used if it recedes, and by less than 0.2 R; else the surface goes on at the pixel's
 * own depth. A neighbour more than 0.2 R in front ends the search, because it hides where
 * the surface ends; so does the border.
 */
#ifndef CRV_METHODS_WIDTH_H
#define CRV_METHODS_WIDTH_H

#include "core/registry.h"

extern const crv__map crv__map_width;

#endif
