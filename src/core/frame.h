/* SPDX-License-Identifier: MIT */
/* What the scalar specification of a method or filter sees. */
#ifndef CRV_CORE_FRAME_H
#define CRV_CORE_FRAME_H

#include "core/image.h"
#include "shared/params.h"

#include "crevice/gbuffer.h"

#include <math.h>

typedef struct crv__frame {
    const crv__params *params;
    const crv__plane *depth;       /* params->layers planes; background INFINITY */
    const crv__plane *normal;      /* 3 planes, view space, facing the camera */
    const crv__noise_texel *noise; /* noise_size * noise_size */
    const float *directions;       /* (cos, sin) of 2 pi k / directions */
    const float *pattern;          /* the method's points, four floats each; NULL: none */
    const struct crv__field *field; /* NULL: none */
    const crv__plane *map;          /* of the method's crv__map; NULL: none */
} crv__frame;

typedef struct crv__vec3 {
    float x, y, z;
} crv__vec3;

/* What is computed of a pixel. */
typedef struct crv__estimate {
    float accessibility;
    crv__vec3 bent; /* the bent normal, if it is asked for */
} crv__estimate;

static inline crv__vec3 crv__sub(crv__vec3 a, crv__vec3 b)
{
    return (crv__vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline crv__vec3 crv__add_scaled(crv__vec3 a, crv__vec3 b, float scale)
{
    return (crv__vec3){a.x + b.x * scale, a.y + b.y * scale, a.z + b.z * scale};
}

static inline float crv__dot(crv__vec3 a, crv__vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* The view-space point at the centre of pixel (x, y) with planar depth d. */
static inline crv__vec3 crv__unproject(const crv__params *p, int32_t x, int32_t y,
                                       float d)
{
    float scale = p->orthographic ? 1.0f : d;
    return (crv__vec3){((float)x + 0.5f - p->cx) * p->inv_fx * scale,
                       -((float)y + 0.5f - p->cy) * p->inv_fy * scale, -d};
}

static inline crv__vec3 crv__vec3_at(const crv__plane planes[3], int32_t x, int32_t y)
{
    return (crv__vec3){*crv__plane_at(&planes[0], x, y), *crv__plane_at(&planes[1], x, y),
                       *crv__plane_at(&planes[2], x, y)};
}

static inline crv__vec3 crv__normal_at(const crv__frame *f, int32_t x, int32_t y)
{
    return crv__vec3_at(f->normal, x, y);
}

/* The method's map at a pixel; beyond the buffers the border's. */
static inline float crv__map_at(const crv__frame *f, int32_t x, int32_t y)
{
    const int32_t right = f->params->width - 1, bottom = f->params->height - 1;
    const int32_t u = x < 0 ? 0 : x > right ? right : x;
    const int32_t v = y < 0 ? 0 : y > bottom ? bottom : y;
    return *crv__plane_at(f->map, u, v);
}

/* A vector of the image or of a tangent plane. */
typedef struct crv__vec2 {
    float x, y;
} crv__vec2;

/* (x, y) turned by the texel's rotation. */
static inline crv__vec2 crv__turned(const crv__noise_texel *noise, float x, float y)
{
    return (crv__vec2){x * noise->cos_alpha - y * noise->sin_alpha,
                       x * noise->sin_alpha + y * noise->cos_alpha};
}

/* The k-th of the equally spaced directions, turned by the texel's rotation. */
static inline crv__vec2 crv__direction(const crv__frame *f, const crv__noise_texel *noise,
                                       int32_t k)
{
    return crv__turned(noise, f->directions[2 * k], f->directions[2 * k + 1]);
}

/* A jitter in [0, 1) for the k-th of several strata at one pixel: that of the noise texel
 * plus k times the golden ratio, modulo 1, so that all k of all texels cover the interval
 * evenly. */
static inline float crv__stratum(const crv__noise_texel *noise, int32_t k)
{
    const float x = 0.5f + 0.5f * noise->beta + 0.618034f * (float)k;
    return x - floorf(x);
}

static inline const crv__noise_texel *crv__noise_at(const crv__frame *f, int32_t x,
                                                    int32_t y)
{
    const crv__params *p = f->params;
    int32_t column = (x + p->noise_x) % p->noise_size,
            row = (y + p->noise_y) % p->noise_size;
    return &f->noise[row * p->noise_size + column];
}

#endif
