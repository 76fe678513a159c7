/* SPDX-License-Identifier: MIT */
#include "radius.h"

#include <math.h>
#include <stdlib.h>

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;

    return (x > y) - (x < y);
}

/* The median of the finite depths, 0 where there is none. Depth has been converted by
 * then, whatever its encoding was. */
static int median_depth(estimator *e, double *out, report *r)
{
    size_t count = (size_t)e->desc.width * (size_t)e->desc.height, kept = 0;
    float *depth = malloc(count * sizeof *depth);
    crv_image view = crv_image_packed(depth, e->desc.width, e->desc.height, 1);

    if (depth == NULL)
        return report_no_memory(r);
    if (!report_ok(r, crv_gbuffer_get_depth(e->gbuffer, 0, &view), "depth")) {
        free(depth);
        return EXIT_FAILED;
    }
    for (size_t i = 0; i < count; i++)
        if (isfinite(depth[i]))
            depth[kept++] = depth[i];
    qsort(depth, kept, sizeof *depth, compare_floats);
    *out = kept > 0 ? (double)depth[kept / 2] : 0.0;
    free(depth);
    return EXIT_DONE;
}

static double two_digits(double value)
{
    double unit = pow(10.0, floor(log10(value)) - 1.0);

    return round(value / unit) * unit;
}

int radius_suggest(estimator *e, const io_frame *frame, float *out, report *r)
{
    double median = 0.0;
    int result = median_depth(e, &median, r);
    double height = frame->image.display_height / (double)frame->camera.fy_px;

    *out = 0.0f;
    if (result != EXIT_DONE || median <= 0.0)
        return result;
    if (frame->camera.projection == CRV_PERSPECTIVE)
        height *= median;
    *out = (float)two_digits(0.05 * height);
    return EXIT_DONE;
}
