/* SPDX-License-Identifier: MIT */
/*
 * mixed.c: planes are linear in the inverse of depth (orthographic: in depth), so that a
 * pixel on one surface with its neighbours lies on the line through two of them. A mixed
 * one lies on neither side's line, but in between.
 */
#include "mixed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pairs.h"

/* A normal shorter than this is an average; of those of one surface, only at outlines. */
static const double shortest = 0.99;

/* Of the gap between two surfaces: what still counts as lying on one of them. */
static const float near_share = 0.12f;

/* Of the value: what three pixels of a straight surface bend at most, and what two
 * surfaces are apart at least. */
static const float straight_share = 0.01f, gap_share = 0.1f;

enum { FARTHEST = 3 }; /* pixels to the next that is not mixed */

typedef struct plane {
    int32_t width, height;
    float *value;            /* linear on planes; NAN: background */
    unsigned char *averaged; /* the normal is too short */
} plane;

static const int32_t directions[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};

/* The pixel `distance` away, or -1 beyond the edge. */
static ptrdiff_t beside(const plane *p, int32_t x, int32_t y, int k, int distance)
{
    const int32_t nx = x + distance * directions[k][0];
    const int32_t ny = y + distance * directions[k][1];
    if (nx < 0 || ny < 0 || nx >= p->width || ny >= p->height)
        return -1;
    return (ptrdiff_t)ny * p->width + nx;
}

/* The line through two pixels of a side, `distance` and `distance + 1` away. */
typedef struct side {
    ptrdiff_t pixel;
    float value, predicted;
} side;

static bool find_side(const plane *p, int32_t x, int32_t y, int k, int distance,
                      side *out)
{
    const ptrdiff_t one = beside(p, x, y, k, distance);
    const ptrdiff_t two = beside(p, x, y, k, distance + 1);
    if (one < 0 || two < 0 || p->averaged[one] || p->averaged[two]
        || !isfinite(p->value[one]) || !isfinite(p->value[two]))
        return false;
    out->pixel = one;
    out->value = p->value[one];
    out->predicted = p->value[one] + (float)distance * (p->value[one] - p->value[two]);
    return true;
}

/* What lies along an axis: no two surfaces, two, or a pixel between them. */
enum { NO_EDGE, EDGE, BETWEEN };

static int edge_at(const plane *p, int32_t x, int32_t y, int k)
{
    side a, b;
    if (!find_side(p, x, y, k, 1, &a) || !find_side(p, x, y, k + 1, 1, &b))
        return NO_EDGE;
    const float here = p->value[(ptrdiff_t)y * p->width + x];
    const float gap = fabsf(a.value - b.value), margin = near_share * gap;
    /* Slopes are no gaps: the line of one side does not go on to the other. */
    const float beyond = 2.0f * a.predicted - a.value;
    if (!(gap > 0.02f * fabsf(here)) || fabsf(beyond - b.value) < 0.5f * gap)
        return NO_EDGE;
    return fabsf(here - a.predicted) > margin && fabsf(here - b.predicted) > margin
                   && here > fminf(a.value, b.value) + margin
                   && here < fmaxf(a.value, b.value) - margin
               ? BETWEEN
               : EDGE;
}

static bool is_between(const plane *p, int32_t x, int32_t y)
{
    const ptrdiff_t i = (ptrdiff_t)y * p->width + x;
    return isfinite(p->value[i])
           && (edge_at(p, x, y, 0) == BETWEEN || edge_at(p, x, y, 2) == BETWEEN);
}

/* The line through the three pixels of a side, if they lie on one; else NAN. */
static float straight_side(const plane *p, int32_t x, int32_t y, int k, float *slope)
{
    float v[3];
    for (int i = 0; i < 3; i++) {
        const ptrdiff_t at = beside(p, x, y, k, i + 1);
        v[i] = at < 0 ? NAN : p->value[at];
    }
    *slope = v[0] - v[1];
    const float bend = fabsf(v[0] - 2.0f * v[1] + v[2]);
    return bend < straight_share * fabsf(v[0]) ? v[0] + *slope : NAN;
}

/* Where two straight surfaces meet at a pixel, one before the other: whether the pixel
 * lies on one of them, or is mixed. */
static int silhouette_at(const plane *p, int32_t x, int32_t y, int k)
{
    const float here = p->value[(ptrdiff_t)y * p->width + x];
    float slope_a, slope_b;
    const float a = straight_side(p, x, y, k, &slope_a);
    const float b = straight_side(p, x, y, k + 1, &slope_b);
    const float gap = fabsf(a - b);
    /* Slopes are no gaps: neither line goes on to the other side. */
    if (!(gap > gap_share * fabsf(here)) || fabsf(a + slope_a - b + slope_b) < 0.5f * gap
        || fabsf(b + slope_b - a + slope_a) < 0.5f * gap)
        return NO_EDGE;
    const float share = (here - a) / (b - a);
    if (fabsf(share) < 0.1f || fabsf(share - 1.0f) < 0.1f)
        return EDGE;
    return share > 0.0f && share < 1.0f ? BETWEEN : NO_EDGE;
}

/* A filter leaves a pixel in between at most silhouettes: eight in ten, were all of them
 * straight. Without one a few are there by chance, as thin surfaces. A silhouette without
 * one counts twice, from both of its sides. */
static bool is_filtered(const plane *p)
{
    int64_t sharp = 0, mixed = 0;
    for (int32_t y = 0; y < p->height; y++)
        for (int32_t x = 0; x < p->width; x++)
            for (int k = 0; k < 4; k += 2) {
                const int what = silhouette_at(p, x, y, k);
                sharp += what == EDGE;
                mixed += what == BETWEEN;
            }
    return mixed >= 8 && 2 * mixed > sharp;
}

/* The side that the pixel lies nearest to, not mixed itself. */
static bool find_nearest(const plane *p, int32_t x, int32_t y, side *out)
{
    const float here = p->value[(ptrdiff_t)y * p->width + x];
    float best = INFINITY;
    for (int distance = 1; distance <= FARTHEST && best == INFINITY; distance++)
        for (int k = 0; k < 4; k++) {
            side s = {0};
            if (!find_side(p, x, y, k, distance, &s))
                continue;
            const float off = fabsf(s.predicted - here);
            if (off < best) {
                best = off;
                *out = s;
            }
        }
    return best < INFINITY;
}

/* Marks are set when all are known, because marked pixels are no sides of others. */
static void mark_between(const plane *p, unsigned char *marks)
{
    for (int32_t y = 0; y < p->height; y++)
        for (int32_t x = 0; x < p->width; x++)
            marks[(ptrdiff_t)y * p->width + x] = is_between(p, x, y);
    memcpy(p->averaged, marks, (size_t)p->width * (size_t)p->height);
}

static void give(io_frame *frame, const plane *p, bool has_normals, int32_t x, int32_t y,
                 const side *s)
{
    const float here = p->value[(ptrdiff_t)y * p->width + x];
    const float to = s->predicted > 0.5f * s->value && s->predicted < 2.0f * s->value
                         ? s->predicted
                         : s->value;
    const bool perspective = frame->camera.projection == CRV_PERSPECTIVE;
    /* At a crease depth is right as it is. */
    if (fabsf(to - here) > 0.01f * fabsf(here))
        *crv_image_at(&frame->depth[0], x, y, 0) = perspective ? 1.0f / to : to;
    const int32_t from_x = (int32_t)(s->pixel % p->width);
    const int32_t from_y = (int32_t)(s->pixel / p->width);
    for (int32_t c = 0; has_normals && c < 3; c++)
        *crv_image_at(&frame->normals, x, y, c) =
            *crv_image_at(&frame->normals, from_x, from_y, c);
}

static void fill(const io_frame *frame, bool has_normals, const plane *p)
{
    const bool perspective = frame->camera.projection == CRV_PERSPECTIVE;
    for (int32_t y = 0; y < p->height; y++)
        for (int32_t x = 0; x < p->width; x++) {
            const ptrdiff_t i = (ptrdiff_t)y * p->width + x;
            const float d = *crv_image_at(&frame->depth[0], x, y, 0);
            float n[3] = {1.0f, 0.0f, 0.0f};
            if (has_normals)
                io__load_normal(&frame->normals, x, y, n);
            const double length = io__length(n);
            p->value[i] = !isfinite(d) ? NAN : perspective ? 1.0f / d : d;
            p->averaged[i] = length > 1e-3 && length < shortest;
        }
}

int64_t io__settle_mixed(io_frame *frame)
{
    const size_t count = (size_t)frame->desc.width * (size_t)frame->desc.height;
    const bool has_normals = frame->normals.data;
    plane p = {.width = frame->desc.width,
               .height = frame->desc.height,
               .value = malloc(count * sizeof(float)),
               .averaged = calloc(count, 1)};
    int64_t changed = p.value && p.averaged ? 0 : -1;
    if (!changed)
        fill(frame, has_normals, &p);
    /* Normals tell by their length; without them, or if depth alone was filtered, depth
     * must. */
    unsigned char *marks =
        !changed && !memchr(p.averaged, 1, count) ? malloc(count) : NULL;
    if (marks && is_filtered(&p))
        mark_between(&p, marks);
    free(marks);
    for (int32_t y = 0; changed >= 0 && y < p.height; y++)
        for (int32_t x = 0; x < p.width; x++) {
            const ptrdiff_t i = (ptrdiff_t)y * p.width + x;
            side s = {0};
            if (!isfinite(p.value[i]) || !p.averaged[i] || !find_nearest(&p, x, y, &s))
                continue;
            give(frame, &p, has_normals, x, y, &s);
            changed++;
        }
    free(p.value);
    free(p.averaged);
    return changed;
}
