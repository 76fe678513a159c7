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

int32_t io__sampling_step(const crv_image *image)
{
    const double pixels = (double)image->width * (double)image->height;
    const double step = ceil(sqrt(pixels / LOOKED_AT));
    return step > 1.0 ? (int32_t)step : 1;
}

/* Planar depth and its camera. */
typedef struct surface {
    const crv_image *depth;
    const crv_camera *camera;
} surface;

static void position(const surface *s, int32_t x, int32_t y, double p[3])
{
    const crv_camera *camera = s->camera;
    const double d = (double)*crv_image_at(s->depth, x, y, 0);
    const double scale = camera->projection == CRV_PERSPECTIVE ? d : 1.0;
    p[0] = (x + 0.5 - (double)camera->cx_px) / (double)camera->fx_px * scale;
    p[1] = -(y + 0.5 - (double)camera->cy_px) / (double)camera->fy_px * scale;
    p[2] = -d;
}

/* The normal that depth implies, by central differences: one-sided ones, as an estimator
 * takes them at edges, would belong to a point half a pixel away and bias the fit. */
static bool implied_normal(const surface *s, int32_t x, int32_t y, float n[3])
{
    double left[3], right[3], above[3], below[3], normal[3];
    if (x < 1 || y < 1 || x >= s->depth->width - 1 || y >= s->depth->height - 1)
        return false;
    position(s, x - 1, y, left);
    position(s, x + 1, y, right);
    position(s, x, y - 1, above);
    position(s, x, y + 1, below);
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

static double cosine_of(const float a[3], const float b[3])
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1]
           + (double)a[2] * (double)b[2];
}

/* Depth says little about the normal at edges and in foliage: there, neighbours differ.
 * Two pixels away, because direct neighbours are made from the same differences. */
static bool smooth_normal(const surface *s, int32_t x, int32_t y, double cosine,
                          float n[3])
{
    static const int32_t offsets[4][2] = {{-2, 0}, {2, 0}, {0, -2}, {0, 2}};
    if (!implied_normal(s, x, y, n))
        return false;
    for (int i = 0; i < 4; i++) {
        float other[3];
        if (!implied_normal(s, x + offsets[i][0], y + offsets[i][1], other)
            || !(cosine_of(n, other) > cosine))
            return false;
    }
    return true;
}

static void collect(const surface *s, const crv_image *normals, double cosine,
                    io__pair_list *pairs)
{
    const int32_t step = io__sampling_step(normals);
    pairs->count = 0;
    for (int32_t y = step / 2; y < normals->height; y += step)
        for (int32_t x = step / 2; x < normals->width; x += step) {
            float given[3];
            io__load_normal(normals, x, y, given);
            const double length = io__length(given);
            /* Averages over a silhouette are short. */
            if (!(length > 0.9 && length < 1.1) || pairs->count == pairs->capacity
                || !smooth_normal(s, x, y, cosine, pairs->to[pairs->count]))
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

void io__find_pairs(const crv_image *depth, const crv_camera *camera,
                    const crv_image *normals, io__pair_list *pairs)
{
    const surface s = {depth, camera};
    const size_t step = (size_t)io__sampling_step(normals);
    const size_t capacity =
        ((size_t)normals->width / step + 1) * ((size_t)normals->height / step + 1);
    memset(pairs, 0, sizeof *pairs);
    pairs->from = malloc(capacity * sizeof *pairs->from);
    pairs->to = malloc(capacity * sizeof *pairs->to);
    if (!pairs->from || !pairs->to)
        return;
    pairs->capacity = capacity;
    collect(&s, normals, cos(8.0 * degree), pairs);
    if (pairs->count < PLENTY)
        collect(&s, normals, cos(25.0 * degree), pairs);
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Sky that holds one number is flat in every encoding. */
static bool is_constant(const surface *s, int32_t x, int32_t y)
{
    if (x < 1 || x >= s->depth->width - 1)
        return true;
    const float d = *crv_image_at(s->depth, x, y, 0);
    return *crv_image_at(s->depth, x - 1, y, 0) == d
           && *crv_image_at(s->depth, x + 1, y, 0) == d;
}

double io__surface_bend(const crv_image *depth, const crv_camera *camera)
{
    const surface s = {depth, camera};
    const int32_t step = io__sampling_step(depth);
    const int32_t apart = depth->width / 100 > 2 ? depth->width / 100 : 2;
    const size_t capacity = ((size_t)depth->width / (size_t)step + 1)
                            * ((size_t)depth->height / (size_t)step + 1);
    float *bends = malloc(capacity * sizeof *bends);
    size_t count = 0;
    if (!bends)
        return -1.0;
    for (int32_t y = step / 2; y < depth->height; y += step)
        for (int32_t x = step / 2; x < depth->width && count < capacity; x += step) {
            float here[3], there[3];
            if (is_constant(&s, x, y) || is_constant(&s, x + apart, y)
                || !implied_normal(&s, x, y, here)
                || !implied_normal(&s, x + apart, y, there))
                continue;
            double square = 0.0;
            for (int c = 0; c < 3; c++)
                square += ((double)here[c] - (double)there[c])
                          * ((double)here[c] - (double)there[c]);
            bends[count++] = (float)(sqrt(square) / degree);
        }
    qsort(bends, count, sizeof *bends, compare_floats);
    const double result = count >= PLENTY ? (double)bends[count * 3 / 10] : -1.0;
    free(bends);
    return result;
}

/* The second difference of the inverse depth along a row, as a share of it; NAN if a
 * neighbour is background. */
static float second_difference(const crv_image *depth, int32_t x, int32_t y,
                               int32_t apart)
{
    const float here = 1.0f / *crv_image_at(depth, x, y, 0);
    const float left = 1.0f / *crv_image_at(depth, x - apart, y, 0);
    const float right = 1.0f / *crv_image_at(depth, x + apart, y, 0);
    return here > 0.0f && left > 0.0f && right > 0.0f
               ? fabsf(left + right - 2.0f * here) / here
               : NAN;
}

double io__surface_noise(const crv_image *depth)
{
    const int32_t step = io__sampling_step(depth);
    const size_t capacity = ((size_t)depth->width / (size_t)step + 1)
                            * ((size_t)depth->height / (size_t)step + 1);
    float *near_by = malloc(2 * capacity * sizeof *near_by);
    size_t count = 0;
    if (!near_by)
        return 0.0;
    float *wider = near_by + capacity;
    for (int32_t y = step / 2; y < depth->height; y += step)
        for (int32_t x = step / 2 + 2; x < depth->width - 2; x += step) {
            near_by[count] = second_difference(depth, x, y, 1);
            wider[count] = second_difference(depth, x, y, 2);
            count += isfinite(near_by[count]) && isfinite(wider[count]);
        }
    qsort(near_by, count, sizeof *near_by, compare_floats);
    qsort(wider, count, sizeof *wider, compare_floats);
    /* Twice as far apart, a curved surface bends four times as much, noise as much. */
    const bool noise = count >= PLENTY && near_by[count / 2] > 0.6f * wider[count / 2];
    const double result = noise ? (double)near_by[count / 2] : 0.0;
    free(near_by);
    return result;
}
