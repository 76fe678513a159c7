/* SPDX-License-Identifier: MIT */
/*
 * core/depth.c, a row at a time. Loops that the compiler turns into vectors: in double
 * precision as there, and to the bit the same. Conditions are joined with & rather than
 * &&, which would be branches.
 */
#include "core/conversions.h"
#include "core/frame.h"
#include "cpu/kernels/texels.h"

enum { CHUNK = 256 };

/* What crv__depth_map_apply() does last. */
CRV__INLINE float checked(double depth)
{
    const float d = (float)depth;
    return ((d > 0) & (d < INFINITY)) ? d : INFINITY;
}

static void planar(float background, const float *v, int32_t count, float *out)
{
    for (int32_t i = 0; i < count; i++)
        out[i] = ((v[i] < background) & (v[i] > 0) & (v[i] < INFINITY)) ? v[i] : INFINITY;
}

static void radial(const crv__depth_map *map, const float *v, int32_t x, int32_t y,
                   int32_t count, float *out)
{
    const double cx = (double)map->camera->cx_px, fx = (double)map->camera->fx_px;
    const double w = (y + 0.5 - (double)map->camera->cy_px) / (double)map->camera->fy_px;
    const float background = map->format.background;
    for (int32_t i = 0; i < count; i++) {
        const double u = (x + i + 0.5 - cx) / fx;
        const float d = checked((double)v[i] / sqrt(1 + u * u + w * w));
        out[i] = v[i] < background ? d : INFINITY;
    }
}

CRV__INLINE void between_planes(const crv__depth_map *map, const float *v, int32_t count,
                                float *out, bool linear)
{
    const float low = map->low, end = map->end;
    const double a = map->a, b = map->b;
    for (int32_t i = 0; i < count; i++) {
        const double affine = a + b * (double)v[i];
        const float d = checked(linear ? affine : 1 / affine);
        out[i] = ((v[i] != end) & (v[i] >= low) & (v[i] <= 1)) ? d : INFINITY;
    }
}

static void between_planes_inverse(const crv__depth_map *map, const float *v,
                                   int32_t count, float *out)
{
    between_planes(map, v, count, out, false);
}

static void between_planes_linear(const crv__depth_map *map, const float *v,
                                  int32_t count, float *out)
{
    between_planes(map, v, count, out, true);
}

static void logarithmic(const crv__depth_map *map, const float *v, int32_t count,
                        float *out)
{
    for (int32_t i = 0; i < count; i++)
        out[i] = v[i] < 1 ? checked(exp2(map->b * (double)v[i]) - 1) : INFINITY;
}

static void disparity(const float *v, int32_t count, float *out)
{
    for (int32_t i = 0; i < count; i++)
        out[i] = checked(1 / (double)v[i]);
}

static void convert(const crv__depth_map *map, const float *v, int32_t x, int32_t y,
                    int32_t count, float *out)
{
    const int orthographic = map->camera->projection == CRV_ORTHOGRAPHIC;
    switch (map->format.encoding) {
    case CRV_DEPTH_RADIAL:
        if (!orthographic) {
            radial(map, v, x, y, count, out);
            break;
        }
        /* fall through */
    case CRV_DEPTH_PLANAR:
        planar(map->format.background, v, count, out);
        break;
    case CRV_DEPTH_HARDWARE:
    case CRV_DEPTH_REVERSED:
    case CRV_DEPTH_NORMALISED:
    case CRV_DEPTH_NORMALISED_REVERSED:
    case CRV_DEPTH_GL:
        (map->is_linear ? between_planes_linear : between_planes_inverse)(map, v, count,
                                                                          out);
        break;
    case CRV_DEPTH_LOGARITHMIC:
        logarithmic(map, v, count, out);
        break;
    case CRV_DEPTH_DISPARITY:
        disparity(v, count, out);
        break;
    }
}

void CRV__NAME(depth_row)(const crv__depth_map *map, const crv__texel_row *from,
                          int32_t y, int32_t count, float *out);
void CRV__NAME(depth_row)(const crv__depth_map *map, const crv__texel_row *from,
                          int32_t y, int32_t count, float *out)
{
    const bool direct = crv__row_is_plain(from) && from->stride == sizeof(float);
    float chunk[CHUNK];
    for (int32_t x = 0; x < count; x += CHUNK) {
        const int32_t n = count - x < CHUNK ? count - x : CHUNK;
        const char *at = (const char *)from->at + x * from->stride;
        if (!direct) {
            crv__texels_take(at, from->type, from->stride, n, chunk, 1);
            crv__texels_scale(from, chunk, n);
        }
        convert(map, direct ? (const float *)(const void *)at : chunk, x, y, n, out + x);
    }
}
