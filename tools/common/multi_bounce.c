/* SPDX-License-Identifier: MIT */
#include "multi_bounce.h"

#include <math.h>

#include "args.h"

float multi_bounce(float accessibility, float albedo)
{
    const double a = (double)accessibility;
    const double rho = fmin(fmax((double)albedo, 0.0), 1.0);
    const double p = 2.0404 * rho - 0.3324;
    const double q = -4.7951 * rho + 0.6417;
    const double r = 2.7552 * rho + 0.6903;
    /* At 1 the fitted cubic is 1.0001 for a white surface. */
    return (float)fmin(fmax(a, ((p * a + q) * a + r) * a), 1.0);
}

void multi_bounce_plane(const float *accessibility, const float *albedo, size_t count,
                        float *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] = multi_bounce(accessibility[i], albedo[i]);
}

bool multi_bounce_parse(const char *text, double rgb[3])
{
    const int count = args_numbers(text, rgb, 3);
    if (count == 1)
        rgb[1] = rgb[2] = rgb[0];
    return count == 1 || count == 3;
}

bool multi_bounce_is_albedo(const double rgb[3])
{
    for (int i = 0; i < 3; i++)
        if (!(rgb[i] >= 0.0 && rgb[i] <= 1.0))
            return false;
    return true;
}
