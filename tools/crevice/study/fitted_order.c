/* SPDX-License-Identifier: MIT */
#include "fitted_order.h"

#include <math.h>

/* How many points lead down to the floor of the error. */
static int32_t points_above_floor(const double *error, int32_t count)
{
    double smallest = INFINITY;
    int32_t used = 0;

    for (int32_t i = 0; i < count; i++)
        smallest = fmin(smallest, error[i]);
    while (used < count && error[used] > 2.0 * smallest)
        used++;
    return used < count ? used + 1 : count;
}

double fitted_order(const double *x, const double *error, int32_t count)
{
    int32_t end = points_above_floor(error, count);
    int32_t first = end > ORDER_POINTS ? end - ORDER_POINTS : 0, n = end - first;
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;

    for (int32_t i = first; i < end; i++) {
        double lx = log(x[i]), ly = log(error[i]);
        sx += lx;
        sy += ly;
        sxx += lx * lx;
        sxy += lx * ly;
    }
    return n < 2 ? NAN : -(n * sxy - sx * sy) / (n * sxx - sx * sx);
}
