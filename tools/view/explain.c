/* SPDX-License-Identifier: MIT */
#include "explain.h"

#include <math.h>

/* Half a degree: what rises less is the rounding of a flat surface. */
#define LEAST_SINE 0.01

static const double full_turn = 2.0 * 3.14159265358979323846;

/* What a texel tells of the slice: taken over if it rises more. */
static void look_at(const double p[3], const float n[3], const double s[3], double radius,
                    int32_t x, int32_t y, explain_horizon *h)
{
    double square = 0.0, rise = 0.0;
    for (int i = 0; i < 3; i++) {
        square += (s[i] - p[i]) * (s[i] - p[i]);
        rise += (s[i] - p[i]) * (double)n[i];
    }
    const double distance = sqrt(square);
    if (!(distance > 0.0 && distance <= radius) || rise / distance <= h->sine)
        return;
    *h = (explain_horizon){
        .found = true, .x = x, .y = y, .sine = rise / distance, .distance = distance};
}

static explain_horizon march(const buffers *b, int32_t x, int32_t y, double radius,
                             double radius_px, double angle)
{
    const crv_gbuffer_desc *d = &b->g.desc;
    const float *n = b->g.normals + 3 * buffers_index(b, x, y);
    explain_horizon h = {.sine = LEAST_SINE};
    double p[3], s[3];
    if (!buffers_point(b, x + d->guard_left, y + d->guard_top, p))
        return h;
    for (double t = 1.0; t <= radius_px + 1.0; t += 1.0) {
        const int32_t column = (int32_t)lround(x + t * cos(angle));
        const int32_t row = (int32_t)lround(y - t * sin(angle));
        const int32_t i = column + d->guard_left, j = row + d->guard_top;
        if (i < 0 || j < 0 || i >= d->width || j >= d->height)
            break;
        if (buffers_point(b, i, j, s))
            look_at(p, n, s, radius, column, row, &h);
    }
    return h;
}

bool explain_pixel(const buffers *b, int32_t x, int32_t y, double radius,
                   explanation *out)
{
    const crv_camera *c = &b->g.camera;
    if (x < 0 || y < 0 || x >= b->width || y >= b->height
        || !b->surface[(size_t)y * (size_t)b->width + (size_t)x])
        return false;
    const double depth = (double)b->g.depth[0][buffers_index(b, x, y)];
    const double spread = c->projection == CRV_PERSPECTIVE ? depth : 1.0;
    *out = (explanation){.x = x, .y = y, .radius_px = radius * (double)c->fy_px / spread};
    for (int i = 0; i < EXPLAIN_DIRECTIONS; i++)
        out->horizon[i] =
            march(b, x, y, radius, out->radius_px, full_turn * i / EXPLAIN_DIRECTIONS);
    return true;
}
