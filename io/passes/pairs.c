/* SPDX-License-Identifier: MIT */
/* pairs.c: given normals beside those that depth implies, where it is smooth. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pairs.h"

enum {
    LOOKED_AT = 40000, /* pixels, about */
    PLENTY = 400       /* of pairs: no need to be less strict */
};

static const double degree = 3.14159265358979323846 / 180.0;

double io__length(const float n[3])
{
    return sqrt((double)n[0] * (double)n[0] + (double)n[1] * (double)n[1]
                + (double)n[2] * (double)n[2]);
}

void io__load_normal(const crv_image *image, int32_t x, int32_t y, float n[3])
{
    for (int32_t c = 0; c < 3; c++)
        n[c] = *crv_image_at(image, x, y, c);
}

int32_t io__sampling_step(const io_frame *frame)
{
    const double pixels = (double)frame->desc.width * (double)frame->desc.height;
    const double step = ceil(sqrt(pixels / LOOKED_AT));
    return step > 1.0 ? (int32_t)step : 1;
}

static void position(const io_frame *frame, int32_t x, int32_t y, double p[3])
{
    const crv_camera *camera = &frame->camera;
    const double d = (double)*crv_image_at(&frame->depth[0], x, y, 0);
    const double scale = camera->projection == CRV_PERSPECTIVE ? d : 1.0;
    p[0] = (x + 0.5 - (double)camera->cx_px) / (double)camera->fx_px * scale;
    p[1] = -(y + 0.5 - (double)camera->cy_px) / (double)camera->fy_px * scale;
    p[2] = -d;
}

/* The normal that depth implies, by central differences: one-sided ones, as an estimator
 * takes them at edges, would belong to a point half a pixel away and bias the fit. */
static bool implied_normal(const io_frame *frame, int32_t x, int32_t y, float n[3])
{
    double left[3], right[3], above[3], below[3], normal[3];
    if (x < 1 || y < 1 || x >= frame->desc.width - 1 || y >= frame->desc.height - 1)
        return false;
    position(frame, x - 1, y, left);
    position(frame, x + 1, y, right);
    position(frame, x, y - 1, above);
    position(frame, x, y + 1, below);
    for (int c = 0; c < 3; c++) {
        right[c] -= left[c];
        above[c] -= below[c];
    }
    for (int c = 0; c < 3; c++)
        normal[c] = right[(c + 1) % 3] * above[(c + 2) % 3]
                    - right[(c + 2) % 3] * above[(c + 1) % 3];
    const double length =
        sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    if (!isfinite(length) || !(length > 0.0)) /* background is infinite */
        return false;
    for (int c = 0; c < 3; c++)
        n[c] = (float)(normal[c] / length);
    return true;
}

/* Depth says little about the normal at edges and in foliage: there, neighbours differ.
 * Two pixels away, because direct neighbours are made from the same differences. */
static bool smooth_normal(const io_frame *frame, int32_t x, int32_t y, double cosine,
                          float n[3])
{
    static const int32_t offsets[4][2] = {{-2, 0}, {2, 0}, {0, -2}, {0, 2}};
    if (!implied_normal(frame, x, y, n))
        return false;
    for (int i = 0; i < 4; i++) {
        float other[3];
        if (!implied_normal(frame, x + offsets[i][0], y + offsets[i][1], other))
            return false;
        double dot = 0.0;
        for (int c = 0; c < 3; c++)
            dot += (double)n[c] * (double)other[c];
        if (!(dot > cosine))
            return false;
    }
    return true;
}

static void collect(const io_frame *frame, double cosine, io__pair_list *pairs)
{
    const int32_t step = io__sampling_step(frame);
    pairs->count = 0;
    for (int32_t y = step / 2; y < frame->desc.height; y += step)
        for (int32_t x = step / 2; x < frame->desc.width; x += step) {
            float given[3];
            io__load_normal(&frame->normals, x, y, given);
            const double length = io__length(given);
            /* Averages over a silhouette are short. */
            if (!(length > 0.9 && length < 1.1) || pairs->count == pairs->capacity
                || !smooth_normal(frame, x, y, cosine, pairs->to[pairs->count]))
                continue;
            for (int c = 0; c < 3; c++)
                pairs->from[pairs->count][c] = (float)((double)given[c] / length);
            pairs->count++;
        }
}

void io__free_pairs(io__pair_list *pairs)
{
    free(pairs->from);
    free(pairs->to);
}

void io__find_pairs(const io_frame *frame, io__pair_list *pairs)
{
    const size_t step = (size_t)io__sampling_step(frame);
    const size_t capacity =
        ((size_t)frame->desc.width / step + 1) * ((size_t)frame->desc.height / step + 1);
    memset(pairs, 0, sizeof *pairs);
    pairs->from = malloc(capacity * sizeof *pairs->from);
    pairs->to = malloc(capacity * sizeof *pairs->to);
    if (pairs->from && pairs->to) {
        pairs->capacity = capacity;
        collect(frame, cos(8.0 * degree), pairs);
        if (pairs->count < PLENTY)
            collect(frame, cos(25.0 * degree), pairs);
    }
}
