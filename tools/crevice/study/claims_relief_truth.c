/* SPDX-License-Identifier: MIT */
#include "claims_relief_truth.h"

#include <math.h>
#include <stddef.h>

#define PI 3.14159265358979323846

void relief_cobbles(relief_map *map, double size, double scale)
{
    enum { STONES = 4, EDGE = RELIEF_TEXELS / STONES };

    map->size = size;
    map->scale = scale;
    for (int row = 0; row < RELIEF_TEXELS; row++) {
        for (int column = 0; column < RELIEF_TEXELS; column++) {
            int shifted = column + (row / EDGE % 2) * EDGE / 2;
            double x = 2.0 * (shifted % EDGE + 0.5) / EDGE - 1.0;
            double y = 2.0 * (row % EDGE + 0.5) / EDGE - 1.0;
            double height = 1.0 - x * x * x * x - y * y * y * y;

            map->texels[row * RELIEF_TEXELS + column] = (float)fmax(0.0, height);
        }
    }
}

static double texel(const relief_map *map, int column, int row)
{
    /* The number of texels is a power of two. */
    return (double)map->texels[(row & (RELIEF_TEXELS - 1)) * RELIEF_TEXELS
                               + (column & (RELIEF_TEXELS - 1))];
}

/* Height at a point and its slopes, which may be NULL. */
static double height_at(const relief_map *map, double x, double y, double slope[2])
{
    double per_unit = RELIEF_TEXELS / map->size;
    double u = x * per_unit - 0.5, v = y * per_unit - 0.5;
    double s = u - floor(u), t = v - floor(v);
    int column = (int)floor(u), row = (int)floor(v);
    double a = texel(map, column, row), b = texel(map, column + 1, row);
    double c = texel(map, column, row + 1), d = texel(map, column + 1, row + 1);

    if (slope != NULL) {
        slope[0] = ((1.0 - t) * (b - a) + t * (d - c)) * per_unit * map->scale;
        slope[1] = ((1.0 - s) * (c - a) + s * (d - b)) * per_unit * map->scale;
    }
    return ((1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * c + s * d))
           * map->scale;
}

/* How far the ray gets, at most `most`. Heights lie in 0 to scale. */
static double free_length(const relief_map *map, const double from[3],
                          const double along[3], double most)
{
    enum { STEPS = 48 };
    double before = 0.0, step = most / STEPS;

    for (int i = 1; i <= STEPS; i++) {
        double t = step * i, z = from[2] + along[2] * t, above;

        if (z > map->scale && along[2] > 0.0)
            return most;
        above = z - height_at(map, from[0] + along[0] * t, from[1] + along[1] * t, NULL);
        if (above < 0.0)
            return step * (i - 1 + before / (before - above));
        before = above;
    }
    return most;
}

static double fraction(uint32_t seed)
{
    seed = (seed ^ 61u ^ (seed >> 16)) * 9u;
    seed = (seed ^ (seed >> 4)) * 0x27d4eb2du;
    return (double)(seed ^ (seed >> 15)) / 4294967296.0;
}

relief_value relief_trace(const relief_map *map, double x, double y, double radius,
                          int edge, uint32_t seed)
{
    relief_value sum = {0.0, 0.0, 0.0};
    double slope[2], from[3], n[3], t[3], b[3], length;
    double turn = fraction(2u * seed), shift = fraction(2u * seed + 1u);

    from[2] = height_at(map, x, y, slope) + 1e-4 * radius;
    from[0] = x;
    from[1] = y;
    length = sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
    n[0] = -slope[0] / length;
    n[1] = -slope[1] / length;
    n[2] = 1.0 / length;
    /* A tangent in the plane of x and z; the normal never points along y. */
    length = sqrt(n[0] * n[0] + n[2] * n[2]);
    t[0] = n[2] / length;
    t[1] = 0.0;
    t[2] = -n[0] / length;
    b[0] = n[1] * t[2] - n[2] * t[1];
    b[1] = n[2] * t[0] - n[0] * t[2];
    b[2] = n[0] * t[1] - n[1] * t[0];
    for (int i = 0; i < edge * edge; i++) {
        double squared =
            (i / edge + fmod(turn + i % edge * 0.6180339887498949, 1.0)) / edge;
        double angle = 2.0 * PI
                       * (i % edge + fmod(shift + i / edge * 0.6180339887498949, 1.0))
                       / edge;
        double sine = sqrt(squared), cosine = sqrt(1.0 - squared), along[3], d, inside;

        for (int k = 0; k < 3; k++)
            along[k] = cosine * n[k] + sine * (cos(angle) * t[k] + sin(angle) * b[k]);
        d = free_length(map, from, along, radius);
        /* The sphere reaches to R cos in this direction: its volume there is in
         * proportion to the cube of that, and directions have cosine density. */
        inside = fmin(d, radius * cosine) / radius;
        sum.none += d >= radius ? 1.0 : 0.0;
        sum.cubic += pow(d / radius, 3.0);
        sum.sphere += cosine > 1e-6 ? 2.0 * inside * inside * inside / cosine : 0.0;
    }
    sum.none /= edge * edge;
    sum.cubic /= edge * edge;
    sum.sphere /= edge * edge;
    return sum;
}

double relief_trace_error(void)
{
    static relief_map map;
    const double middle = (RELIEF_TEXELS / 2 + 0.5) / RELIEF_TEXELS, radius = 0.4;
    double largest = 0.0;

    /* The groove's bottom lies on a texel's centre, so that bilinear is exact. */
    map.size = 2.0;
    map.scale = 1.0;
    for (int i = 0; i < RELIEF_TEXELS * RELIEF_TEXELS; i++)
        map.texels[i] =
            (float)fabs(2.0 * ((i % RELIEF_TEXELS + 0.5) / RELIEF_TEXELS - middle));
    for (int k = 1; k < 10; k++) {
        double c = 0.1 * k, s = sqrt(1.0 - c * c), rho = 0.5, e = fmax(0.0, rho - c);
        double x = 2.0 * middle + c * radius * sqrt(0.5);
        relief_value v = relief_trace(&map, x, 0.0, radius, 64, (uint32_t)k);

        largest = fmax(largest, fabs(1.0 - v.none - (acos(c) - c * s) / PI));
        largest =
            fmax(largest, fabs(1.0 - v.sphere
                               - e * e * (3.0 * rho - e) / (4.0 * rho * rho * rho)));
    }
    return largest;
}
