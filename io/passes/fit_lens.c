/* SPDX-License-Identifier: MIT */
/* fit_lens.c: pixels against slopes, for a camera whose place is known. */
#include <math.h>
#include <string.h>

#include "projection_parts.h"

/* pixel = c + f * slope: a line through all points. */
typedef struct line_sums {
    double n, x, y, xx, xy;
} line_sums;

static void add_to_line(line_sums *s, double weight, double x, double y)
{
    s->n += weight;
    s->x += weight * x;
    s->y += weight * y;
    s->xx += weight * x * x;
    s->xy += weight * x * y;
}

static bool solve_line(const line_sums *s, double *slope, double *offset)
{
    const double spread = s->n * s->xx - s->x * s->x;
    if (!(spread > 1e-10 * s->n * s->xx))
        return false;
    *slope = (s->n * s->xy - s->x * s->y) / spread;
    *offset = (s->y - *slope * s->x) / s->n;
    return isfinite(*slope) && isfinite(*offset) && *slope > 0.0;
}

int io__fit_lens(const io__points *points, bool orthographic, const double to_view[9],
                 const double eye[3], io__projection *out)
{
    io__projection c = {.orthographic = orthographic};
    memcpy(c.to_view, to_view, sizeof c.to_view);
    memcpy(c.eye, eye, sizeof c.eye);
    for (int round = 0; round < IO__FIT_ROUNDS; round++) {
        line_sums x = {0}, y = {0};
        for (size_t i = 0; i < points->count; i++) {
            double v[3];
            io__view_of(&c, points->position[i], v);
            if (!orthographic && !(v[2] > 0.0))
                continue;
            const double scale = orthographic ? 1.0 : 1.0 / v[2];
            const double weight =
                round ? io__weight_of(
                    io__projection_error_at(&c, points->position[i], points->pixel[i]),
                    c.error_px)
                      : 1.0;
            add_to_line(&x, weight, v[0] * scale, points->pixel[i][0]);
            add_to_line(&y, weight, -v[1] * scale, points->pixel[i][1]);
        }
        if (!(x.n > 0.0) || !solve_line(&x, &c.fx_px, &c.cx_px)
            || !solve_line(&y, &c.fy_px, &c.cy_px))
            return -1;
        c.error_px = io__projection_error(points, &c);
    }
    *out = c;
    return points->count >= IO__FEWEST_POINTS ? 0 : -1;
}
