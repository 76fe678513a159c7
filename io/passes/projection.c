/* SPDX-License-Identifier: MIT */
#include "projection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear.h"

enum { ROUNDS = 6, FEWEST_POINTS = 30 };

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* View space of a point: x right, y up, and depth. */
static void view_of(const io__projection *c, const double p[3], double v[3])
{
    double from[3];
    for (int i = 0; i < 3; i++)
        from[i] = p[i] - c->eye[i];
    for (int i = 0; i < 3; i++)
        v[i] = dot3(c->to_view + 3 * i, from);
    v[2] = -v[2];
}

double io__projection_error_at(const io__projection *c, const double p[3],
                               const double pixel[2])
{
    double v[3];
    view_of(c, p, v);
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

/* How much a point counts that lies this far off, others lying `usual` off. */
static double weight_of(double error, double usual)
{
    const double share = error / (3.0 * usual + 1e-3);
    return isfinite(share) ? 1.0 / (1.0 + share * share) : 0.0;
}

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
    for (int round = 0; round < ROUNDS; round++) {
        line_sums x = {0}, y = {0};
        for (size_t i = 0; i < points->count; i++) {
            double v[3];
            view_of(&c, points->position[i], v);
            if (!orthographic && !(v[2] > 0.0))
                continue;
            const double scale = orthographic ? 1.0 : 1.0 / v[2];
            const double weight =
                round ? weight_of(
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
    return points->count >= FEWEST_POINTS ? 0 : -1;
}

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

/* A camera of real points and pixels from its rows; false if there is none. */
static bool camera_of(const io__points *points, const scaling *s, const matrix34 *rows,
                      bool orthographic, io__projection *out)
{
    double m[3][4];
    io__projection c = {.orthographic = orthographic};
    /* Undo the scaling of pixels, then that of points. */
    for (int k = 0; k < 4; k++) {
        m[2][k] = rows->m[2][k];
        for (int r = 0; r < 2; r++)
            m[r][k] = s->pixels * rows->m[r][k] + s->middle[r] * rows->m[2][k];
    }
    for (int r = 0; r < 3; r++) {
        for (int k = 0; k < 3; k++)
            m[r][k] /= s->size;
        m[r][3] -= dot3(m[r], s->centre);
    }
    double *right = c.to_view, *up = c.to_view + 3, *back = c.to_view + 6;
    if (orthographic) {
        for (int k = 0; k < 3; k++)
            back[k] = m[0][(k + 2) % 3] * m[1][(k + 1) % 3]
                      - m[0][(k + 1) % 3] * m[1][(k + 2) % 3];
    } else {
        double ahead = 0.0; /* points lie before the eye */
        for (size_t i = 0; i < points->count; i++)
            ahead += dot3(m[2], points->position[i]) + m[2][3] > 0.0 ? 1.0 : -1.0;
        for (int k = 0; k < 3; k++)
            back[k] = ahead > 0.0 ? -m[2][k] : m[2][k];
    }
    const double length = sqrt(dot3(back, back));
    /* Of an orthographic camera the third row is 0, 0, 0, 1. */
    const double scale = orthographic ? m[2][3] : -dot3(m[2], back) / length;
    for (int k = 0; k < 3; k++)
        back[k] /= length;
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 4; k++)
            m[r][k] /= scale;
    c.cx_px = orthographic ? 0.0 : -dot3(m[0], back);
    c.cy_px = orthographic ? 0.0 : -dot3(m[1], back);
    for (int k = 0; k < 3; k++) {
        right[k] = m[0][k] + c.cx_px * back[k];
        up[k] = -m[1][k] - c.cy_px * back[k];
    }
    c.fx_px = sqrt(dot3(right, right));
    for (int k = 0; k < 3; k++)
        right[k] /= c.fx_px;
    const double skew = dot3(up, right);
    for (int k = 0; k < 3; k++)
        up[k] -= skew * right[k];
    c.fy_px = sqrt(dot3(up, up));
    for (int k = 0; k < 3; k++)
        up[k] /= c.fy_px;
    const double z = orthographic ? 1.0 : m[2][3];
    const double x = (m[0][3] - c.cx_px * z) / c.fx_px;
    const double y = -(m[1][3] - c.cy_px * z) / c.fy_px;
    if (orthographic) { /* the eye anywhere on the axis through pixel (0, 0) */
        for (int k = 0; k < 3; k++)
            c.eye[k] = -x * right[k] - y * up[k];
    } else {
        for (int k = 0; k < 3; k++)
            c.eye[k] = -x * right[k] - y * up[k] + z * back[k];
    }
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
    for (int round = 0; round < ROUNDS; round++) {
        if (!solve_rows(points, s, weights, round == ROUNDS - 1, &rows)
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
                fabs(w) > 1e-12 ? weight_of(error, out->error_px) / (w * w) : 0.0;
        }
    }
    return true;
}

int io__fit_camera(const io__points *points, io__projection *out)
{
    static const double exact_px = 0.02; /* an affine view by chance is worse */
    if (points->count < FEWEST_POINTS)
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
