/* SPDX-License-Identifier: MIT */
/*
 * vec.h: three doubles. Geometry is computed in double and stored in float.
 */
#ifndef CREVICE_SCENE_VEC_H
#define CREVICE_SCENE_VEC_H

#include <math.h>

#define SCENE_PI 3.14159265358979323846

typedef struct vec3 {
    double x, y, z;
} vec3;

static inline vec3 v3(double x, double y, double z)
{
    return (vec3){x, y, z};
}

static inline vec3 v3_from(const float p[3])
{
    return (vec3){(double)p[0], (double)p[1], (double)p[2]};
}

static inline vec3 v3_from_double(const double p[3])
{
    return (vec3){p[0], p[1], p[2]};
}

static inline void v3_store_double(vec3 v, double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

static inline void v3_store(vec3 v, float out[3])
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

static inline vec3 v3_add(vec3 a, vec3 b)
{
    return (vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec3 v3_sub(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec3 v3_scale(vec3 a, double s)
{
    return (vec3){a.x * s, a.y * s, a.z * s};
}

/* a + b * s */
static inline vec3 v3_along(vec3 a, vec3 b, double s)
{
    return (vec3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}

static inline double v3_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3 v3_cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Grows bounds by a point; one that is not finite is passed over. */
static inline void v3_bound(vec3 p, vec3 *lower, vec3 *upper)
{
    if (!isfinite(p.x + p.y + p.z))
        return;
    *lower = v3(fmin(lower->x, p.x), fmin(lower->y, p.y), fmin(lower->z, p.z));
    *upper = v3(fmax(upper->x, p.x), fmax(upper->y, p.y), fmax(upper->z, p.z));
}

static inline double v3_length(vec3 a)
{
    return sqrt(v3_dot(a, a));
}

/* Zero stays zero. */
static inline vec3 v3_normalise(vec3 a)
{
    double length = v3_length(a);
    return length > 0.0 ? v3_scale(a, 1.0 / length) : a;
}

#endif
