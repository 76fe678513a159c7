/* SPDX-License-Identifier: MIT */
#include "plot.h"

#include <math.h>

void plot_pareto(const double *x, const double *y, int32_t count, bool *on_front)
{
    for (int32_t i = 0; i < count; i++) {
        on_front[i] = isfinite(x[i]) && isfinite(y[i]);
        for (int32_t j = 0; j < count && on_front[i]; j++)
            if (isfinite(x[j]) && isfinite(y[j]) && x[j] <= x[i] && y[j] <= y[i]
                && (x[j] < x[i] || y[j] < y[i]))
                on_front[i] = false;
    }
}
