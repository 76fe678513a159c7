/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "projection_parts.h"

double io__dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void io__view_of(const io__projection *c, const double p[3], double v[3])
{
    double from[3];
    for (int i = 0; i < 3; i++)
        from[i] = p[i] - c->eye[i];
    for (int i = 0; i < 3; i++)
        v[i] = io__dot3(c->to_view + 3 * i, from);
    v[2] = -v[2];
}

double io__projection_error_at(const io__projection *c, const double p[3],
                               const double pixel[2])
{
    double v[3];
    io__view_of(c, p, v);
    const double scale = c->orthographic ? 1.0 : v[2] > 0.0 ? 1.0 / v[2] : INFINITY;
    const double dx = c->cx_px + c->fx_px * v[0] * scale - pixel[0];
    const double dy = c->cy_px - c->fy_px * v[1] * scale - pixel[1];
    const double error = sqrt(dx * dx + dy * dy);
    return isnan(error) ? INFINITY : error;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double io__projection_error(const io__points *points, const io__projection *camera)
{
    double *errors = malloc((points->count + 1) * sizeof *errors);
    if (!errors || !points->count) {
        free(errors);
        return INFINITY;
    }
    for (size_t i = 0; i < points->count; i++)
        errors[i] =
            io__projection_error_at(camera, points->position[i], points->pixel[i]);
    qsort(errors, points->count, sizeof *errors, compare_doubles);
    const double median = errors[points->count / 2];
    free(errors);
    return median;
}

double io__weight_of(double error, double usual)
{
    const double share = error / (3.0 * usual + 1e-3);
    return isfinite(share) ? 1.0 / (1.0 + share * share) : 0.0;
}
