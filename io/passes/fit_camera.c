/* SPDX-License-Identifier: MIT */
/* fit_camera.c: place, turn and lens of a camera at once. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear.h"
#include "projection_parts.h"

/* What brings coordinates to about 1: equations of unlike size lose digits. */
typedef struct scaling {
    double centre[3], size;   /* of positions */
    double middle[2], pixels; /* of pixels */
} scaling;

static scaling scaling_of(const io__points *points)
{
    scaling s = {0};
    const double share = 1.0 / (double)points->count;
    for (size_t i = 0; i < points->count; i++) {
        for (int c = 0; c < 3; c++)
            s.centre[c] += share * points->position[i][c];
        for (int c = 0; c < 2; c++)
            s.middle[c] += share * points->pixel[i][c];
    }
    for (size_t i = 0; i < points->count; i++) {
        for (int c = 0; c < 3; c++)
            s.size += share * fabs(points->position[i][c] - s.centre[c]);
        for (int c = 0; c < 2; c++)
            s.pixels += share * fabs(points->pixel[i][c] - s.middle[c]);
    }
    return s;
}

/* A point and its pixel, scaled; the fourth coordinate is 1. */
static void scaled(const io__points *points, size_t i, const scaling *s, double p[4],
                   double pixel[2])
{
    for (int c = 0; c < 3; c++)
        p[c] = (points->position[i][c] - s->centre[c]) / s->size;
    p[3] = 1.0;
    for (int c = 0; c < 2; c++)
        pixel[c] = (points->pixel[i][c] - s->middle[c]) / s->pixels;
}

/* Points of one plane, or of a line, are seen alike by many cameras. */
static bool are_in_a_plane(const io__points *points, const scaling *s)
{
    double moments[LINEAR_MAX * LINEAR_MAX] = {0}, values[LINEAR_MAX];
    double vectors[LINEAR_MAX * LINEAR_MAX];
    for (size_t i = 0; i < points->count; i++) {
        double p[4], pixel[2];
        scaled(points, i, s, p, pixel);
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++)
                moments[4 * r + c] += p[r] * p[c] / (double)points->count;
    }
    io__eigenvectors(moments, 4, values, vectors);
    return !(values[0] > 1e-8);
}

/* The rows of a projection, of scaled points to scaled pixels. */
typedef struct matrix34 {
    double m[3][4];
} matrix34;

static double dot4(const double a[4], const double b[4])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* The smallest solution of pixel * (row 3 . p) = row . p, for both coordinates. */
static bool solve_rows(const io__points *points, const scaling *s, const double *weights,
                       bool is_last, matrix34 *out)
{
    double moments[LINEAR_MAX * LINEAR_MAX] = {0}, values[LINEAR_MAX];
    double vectors[LINEAR_MAX * LINEAR_MAX];
    for (size_t i = 0; i < points->count; i++) {
        double p[4], pixel[2];
        if (!(weights[i] > 0.0))
            continue;
        scaled(points, i, s, p, pixel);
        for (int k = 0; k < 2; k++) {
            double row[12] = {0};
            for (int c = 0; c < 4; c++) {
                row[4 * k + c] = p[c];
                row[8 + c] = -pixel[k] * p[c];
            }
            for (int r = 0; r < 12; r++)
                for (int c = 0; c < 12; c++)
                    moments[12 * r + c] += weights[i] * row[r] * row[c];
        }
    }
    io__eigenvectors(moments, 12, values, vectors);
    memcpy(out->m, vectors, sizeof out->m);
    /* As many solutions as values that are next to nothing, or not above the noise. */
    return values[1] > 1e-9 * values[11] && (!is_last || values[1] > 4.0 * values[0]);
}

/* The rows for real points and pixels: undoes the scaling of pixels, then of points. */
static void unscale(const matrix34 *rows, const scaling *s, double m[3][4])
{
    for (int k = 0; k < 4; k++) {
        m[2][k] = rows->m[2][k];
        for (int r = 0; r < 2; r++)
            m[r][k] = s->pixels * rows->m[r][k] + s->middle[r] * rows->m[2][k];
    }
    for (int r = 0; r < 3; r++) {
        for (int k = 0; k < 3; k++)
            m[r][k] /= s->size;
        m[r][3] -= io__dot3(m[r], s->centre);
    }
}

/* The direction backwards, and by it the length of the rows, which is free: the third
 * coordinate is depth, or 1 for an orthographic camera. */
static void find_back(const io__points *points, bool orthographic, double m[3][4],
                      double back[3])
{
    double ahead = 0.0; /* points lie before the eye */
    for (size_t i = 0; i < points->count && !orthographic; i++)
        ahead += io__dot3(m[2], points->position[i]) + m[2][3] > 0.0 ? 1.0 : -1.0;
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        back[k] = orthographic  ? m[0][b] * m[1][a] - m[0][a] * m[1][b]
                  : ahead > 0.0 ? -m[2][k]
                                : m[2][k];
    }
    const double length = sqrt(io__dot3(back, back));
    const double scale = orthographic ? m[2][3] : -io__dot3(m[2], back) / length;
    for (int k = 0; k < 3; k++)
        back[k] /= length;
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 4; k++)
            m[r][k] /= scale;
}

/* Makes a vector unit and returns how long it was. */
static double normalise(double v[3])
{
    const double length = sqrt(io__dot3(v, v));
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return length;
}

/* A camera of real points and pixels from its rows; false if there is none. */
static bool camera_of(const io__points *points, const scaling *s, const matrix34 *rows,
                      bool orthographic, io__projection *out)
{
    double m[3][4];
    io__projection c = {.orthographic = orthographic};
    double *right = c.to_view, *up = c.to_view + 3, *back = c.to_view + 6;
    unscale(rows, s, m);
    find_back(points, orthographic, m, back);
    c.cx_px = orthographic ? 0.0 : -io__dot3(m[0], back);
    c.cy_px = orthographic ? 0.0 : -io__dot3(m[1], back);
    for (int k = 0; k < 3; k++) {
        right[k] = m[0][k] + c.cx_px * back[k];
        up[k] = -m[1][k] - c.cy_px * back[k];
    }
    c.fx_px = normalise(right);
    const double skew = io__dot3(up, right);
    for (int k = 0; k < 3; k++)
        up[k] -= skew * right[k];
    c.fy_px = normalise(up);
    /* An orthographic eye stands anywhere on the axis through pixel (0, 0). */
    const double z = orthographic ? 0.0 : m[2][3], w = orthographic ? 1.0 : m[2][3];
    const double x = (m[0][3] - c.cx_px * w) / c.fx_px;
    const double y = -(m[1][3] - c.cy_px * w) / c.fy_px;
    for (int k = 0; k < 3; k++)
        c.eye[k] = -x * right[k] - y * up[k] + z * back[k];
    c.error_px = io__projection_error(points, &c);
    *out = c;
    return isfinite(c.error_px) && isfinite(c.fx_px + c.fy_px) && c.fx_px > 0.0
           && c.fy_px > 0.0 && fabs(skew) < 0.02 * c.fx_px;
}

/* Least squares for one affine row after the other. */
static bool fit_affine(const io__points *points, const scaling *s, io__projection *out)
{
    double moments[4 * 5], rows[2][4];
    for (int k = 0; k < 2; k++) {
        memset(moments, 0, sizeof moments);
        for (size_t i = 0; i < points->count; i++) {
            double p[4], pixel[2];
            scaled(points, i, s, p, pixel);
            for (int r = 0; r < 4; r++) {
                for (int c = 0; c < 4; c++)
                    moments[5 * r + c] += p[r] * p[c];
                moments[5 * r + 4] += p[r] * pixel[k];
            }
        }
        if (!io__solve(moments, 4, rows[k]))
            return false;
    }
    matrix34 all = {{{0}}};
    memcpy(all.m, rows, sizeof rows);
    all.m[2][3] = 1.0;
    return camera_of(points, s, &all, true, out);
}

static bool fit_perspective(const io__points *points, const scaling *s, double *weights,
                            io__projection *out)
{
    matrix34 rows;
    for (size_t i = 0; i < points->count; i++)
        weights[i] = 1.0;
    for (int round = 0; round < IO__FIT_ROUNDS; round++) {
        if (!solve_rows(points, s, weights, round == IO__FIT_ROUNDS - 1, &rows)
            || !camera_of(points, s, &rows, false, out))
            return false;
        /* The equations are those of pixels times depth. */
        for (size_t i = 0; i < points->count; i++) {
            double p[4], pixel[2];
            scaled(points, i, s, p, pixel);
            const double w = dot4(rows.m[2], p);
            const double error =
                io__projection_error_at(out, points->position[i], points->pixel[i]);
            weights[i] =
                fabs(w) > 1e-12 ? io__weight_of(error, out->error_px) / (w * w) : 0.0;
        }
    }
    return true;
}

int io__fit_camera(const io__points *points, io__projection *out)
{
    static const double exact_px = 0.02; /* an affine view by chance is worse */
    if (points->count < IO__FEWEST_POINTS)
        return -1;
    const scaling s = scaling_of(points);
    if (!(s.size > 0.0) || !(s.pixels > 0.0) || are_in_a_plane(points, &s))
        return -1;
    if (fit_affine(points, &s, out) && out->error_px < exact_px)
        return 0;
    double *weights = malloc(points->count * sizeof *weights);
    const bool found = weights && fit_perspective(points, &s, weights, out);
    free(weights);
    return found ? 0 : -1;
}
