/* SPDX-License-Identifier: MIT */
/* fitted_order.h: how fast an error falls. */
#ifndef TOOL_STUDY_FITTED_ORDER_H
#define TOOL_STUDY_FITTED_ORDER_H

#include <stdint.h>

/*
 * The order p of an error that falls like x^-p: the slope of a line through the last
 * ORDER_POINTS points in log x and log error, least squares. Points after the first that
 * is within twice the smallest error are left out, since there something else than x
 * limits the error. NAN with fewer than two points.
 */
#define ORDER_POINTS 4
double fitted_order(const double *x, const double *error, int32_t count);

#endif
