/* SPDX-License-Identifier: MIT */
#include "metrics_angles.h"

#include <math.h>
#include <stdlib.h>

#include "quantile.h"

static const double degrees = 180.0 / 3.14159265358979323846;

static void load(const float *const from[3], size_t i, double v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] = (double)from[k][i];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* By sine and cosine, which is exact for small angles, as the cosine alone is not. */
static double angle_deg(const double a[3], const double b[3])
{
    const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                             a[0] * b[1] - a[1] * b[0]};
    return degrees * atan2(sqrt(dot(cross, cross)), dot(a, b));
}

bool metrics_compare_angles(const float *const a[3], const float *const b[3],
                            const uint8_t *mask, size_t count, metrics_angles *out)
{
    double *angles = malloc((count > 0 ? count : 1) * sizeof *angles);
    size_t n = 0;
    if (!angles)
        return false;
    for (size_t i = 0; i < count; i++) {
        double va[3], vb[3];
        load(a, i, va);
        load(b, i, vb);
        if ((!mask || mask[i]) && dot(va, va) > 0.0 && dot(vb, vb) > 0.0)
            angles[n++] = angle_deg(va, vb);
    }
    quantile_sort(angles, n);
    out->pixels = (int64_t)n;
    out->median_deg = n > 0 ? quantile(angles, n, 0.5) : NAN;
    out->q95_deg = n > 0 ? quantile(angles, n, 0.95) : NAN;
    free(angles);
    return true;
}
