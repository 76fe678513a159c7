/* SPDX-License-Identifier: MIT */
#include "stability.h"

#include <math.h>

/* A texel shows the same surface where it lies in the point's tangent plane, to within so
 * many pixels' footprints at its depth, and faces the same way. */
static const double PLANE_FOOTPRINTS = 1.0, COS_NORMALS = 0.9;

/* Points with less than this of their bilinear weight on their own surface are lost: what
 * is left would be a sample from beside the point. Rounding may put a little elsewhere.
 */
static const double LEAST_WEIGHT = 0.999;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Between world and view space; the matrix is a rotation. */
static void to_view(const crv_camera *c, const double world[3], double view[3])
{
    for (int i = 0; i < 3; i++)
        view[i] = (double)c->world_to_view[3 * i] * world[0]
                  + (double)c->world_to_view[3 * i + 1] * world[1]
                  + (double)c->world_to_view[3 * i + 2] * world[2];
}

static void to_world(const crv_camera *c, const double view[3], double world[3])
{
    for (int i = 0; i < 3; i++)
        world[i] = (double)c->world_to_view[i] * view[0]
                   + (double)c->world_to_view[3 + i] * view[1]
                   + (double)c->world_to_view[6 + i] * view[2];
}

static double unit_at(const crv_camera *c, double depth)
{
    return c->projection == CRV_PERSPECTIVE ? depth : 1.0;
}

static void unproject(const stability_frame *f, int32_t x, int32_t y, double out[3])
{
    const crv_camera *c = &f->camera;
    double depth = (double)f->depth[(size_t)y * (size_t)f->width + (size_t)x];
    double unit = unit_at(c, depth);

    out[0] = (x + 0.5 - (double)c->cx_px) / (double)c->fx_px * unit;
    out[1] = -(y + 0.5 - (double)c->cy_px) / (double)c->fy_px * unit;
    out[2] = -depth;
}

/* A point and its normal, in the view space of the frame at hand. */
typedef struct surface {
    double at[3], normal[3];
} surface;

/* What the latter frame shows at a pixel, in the former frame's view space. */
static surface carry(const stability_frame *former, const stability_frame *latter,
                     int32_t x, int32_t y)
{
    size_t i = (size_t)y * (size_t)latter->width + (size_t)x;
    double view[3], world[3], normal[3];
    surface s;

    unproject(latter, x, y, view);
    to_world(&latter->camera, view, world);
    for (int k = 0; k < 3; k++) {
        world[k] += latter->eye[k] - former->eye[k];
        normal[k] = (double)latter->normals[3 * i + (size_t)k];
    }
    to_view(&former->camera, world, s.at);
    to_world(&latter->camera, normal, world);
    to_view(&former->camera, world, s.normal);
    return s;
}

static bool is_same_surface(const stability_frame *f, const surface *s, int32_t x,
                            int32_t y)
{
    size_t i = (size_t)y * (size_t)f->width + (size_t)x;
    double at[3], normal[3], footprint;

    if (!isfinite(f->depth[i]) || !(f->depth[i] > 0.0f))
        return false;
    unproject(f, x, y, at);
    for (int k = 0; k < 3; k++) {
        at[k] -= s->at[k];
        normal[k] = (double)f->normals[3 * i + (size_t)k];
    }
    footprint = unit_at(&f->camera, -s->at[2])
                / fmin((double)f->camera.fx_px, (double)f->camera.fy_px);
    return fabs(dot(at, s->normal)) < PLANE_FOOTPRINTS * footprint
           && dot(normal, s->normal) > COS_NORMALS;
}

static void add_tap(const stability_frame *f, const surface *s, int32_t x, int32_t y,
                    double weight, stability_taps *out)
{
    if (!(weight > 0.0) || x < 0 || y < 0 || x >= f->width || y >= f->height
        || !is_same_surface(f, s, x, y))
        return;
    out->index[out->count] = y * f->width + x;
    out->weight[out->count++] = weight;
}

static void normalise(stability_taps *taps)
{
    double sum = 0.0;

    for (int32_t k = 0; k < taps->count; k++)
        sum += taps->weight[k];
    if (sum < LEAST_WEIGHT)
        taps->count = 0;
    for (int32_t k = 0; k < taps->count; k++)
        taps->weight[k] /= sum;
}

void stability_find(const stability_frame *former, const stability_frame *latter,
                    int32_t x, int32_t y, stability_taps *out)
{
    const crv_camera *c = &former->camera;
    float depth = latter->depth[(size_t)y * (size_t)latter->width + (size_t)x];
    double unit, px, py, fx, fy;
    surface s;
    int32_t left, top;

    *out = (stability_taps){0};
    if (!isfinite(depth) || !(depth > 0.0f))
        return;
    s = carry(former, latter, x, y);
    if (!(s.at[2] < 0.0))
        return;
    unit = unit_at(c, -s.at[2]);
    /* In texel centres: the integers are centres. */
    px = s.at[0] / unit * (double)c->fx_px + (double)c->cx_px - 0.5;
    py = -s.at[1] / unit * (double)c->fy_px + (double)c->cy_px - 0.5;
    if (!(px > -1.0 && py > -1.0 && px < former->width && py < former->height))
        return;
    out->moved_x_px = x - px;
    out->moved_y_px = y - py;
    left = (int32_t)floor(px);
    top = (int32_t)floor(py);
    fx = px - left;
    fy = py - top;
    add_tap(former, &s, left, top, (1.0 - fx) * (1.0 - fy), out);
    add_tap(former, &s, left + 1, top, fx * (1.0 - fy), out);
    add_tap(former, &s, left, top + 1, (1.0 - fx) * fy, out);
    add_tap(former, &s, left + 1, top + 1, fx * fy, out);
    normalise(out);
}

static double sample(const float *plane, const stability_taps *taps)
{
    double sum = 0.0;

    for (int32_t k = 0; k < taps->count; k++)
        sum += taps->weight[k] * (double)plane[taps->index[k]];
    return sum;
}

/* The change of accessibility and of its repetition. */
static void change_at(const stability_frame *former, const stability_frame *latter,
                      size_t i, const stability_taps *taps, double change[2])
{
    change[0] = (double)latter->accessibility[i] - sample(former->accessibility, taps);
    change[1] = change[0];
    if (former->repetition != NULL && latter->repetition != NULL)
        change[1] = (double)latter->repetition[i] - sample(former->repetition, taps);
}

bool stability_point(const stability_frame *former, const stability_frame *latter,
                     int32_t x, int32_t y, double *change, double *repetition)
{
    stability_taps taps;
    double both[2];

    stability_find(former, latter, x, y, &taps);
    if (taps.count == 0)
        return false;
    change_at(former, latter, (size_t)y * (size_t)latter->width + (size_t)x, &taps, both);
    *change = both[0];
    *repetition = both[1];
    return true;
}

static void add_point(stability *sum, const stability_frame *former,
                      const stability_frame *latter, int32_t x, int32_t y)
{
    size_t i = (size_t)y * (size_t)latter->width + (size_t)x;
    stability_taps taps;
    double both[2];

    stability_find(former, latter, x, y, &taps);
    if (taps.count == 0) {
        sum->lost += isfinite(latter->depth[i]) && latter->depth[i] > 0.0f;
        return;
    }
    change_at(former, latter, i, &taps, both);
    sum->points++;
    sum->change2 += both[0] * both[1];
    sum->motion2_px +=
        taps.moved_x_px * taps.moved_x_px + taps.moved_y_px * taps.moved_y_px;
}

void stability_add(stability *sum, const stability_frame *former,
                   const stability_frame *latter)
{
    for (int32_t y = 0; y < latter->height; y++)
        for (int32_t x = 0; x < latter->width; x++)
            if (latter->mask == NULL
                || latter->mask[(size_t)y * (size_t)latter->width + (size_t)x] != 0)
                add_point(sum, former, latter, x, y);
}
