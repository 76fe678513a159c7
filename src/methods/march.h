/* SPDX-License-Identifier: MIT */
/* Marching through view space: what the methods share that look points up in the depth
 * buffer. */
#ifndef CRV_METHODS_MARCH_H
#define CRV_METHODS_MARCH_H

#include "methods/bent.h"

static inline float crv__length(crv__vec3 v)
{
    return sqrtf(crv__dot(v, v));
}

/* Two unit vectors that span the plane of n, turned as little as possible from the
 * image's axes: neighbouring pixels of a smooth surface get neighbouring frames. n.z >
 * -1. */
static inline void crv__tangents(crv__vec3 n, crv__vec3 *t, crv__vec3 *b)
{
    const float scale = 1 / (1 + fmaxf(n.z, -0.9999f)), xy = -n.x * n.y * scale;
    *t = (crv__vec3){1 - n.x * n.x * scale, xy, -n.x};
    *b = (crv__vec3){xy, 1 - n.y * n.y * scale, -n.y};
}

/* The k-th of the Nd unit vectors equally spaced around n, in the plane of n. */
static inline crv__vec3 crv__slice_tangent(const crv__frame *f,
                                           const crv__noise_texel *noise, int32_t k,
                                           crv__vec3 t, crv__vec3 b)
{
    const crv__vec2 d = crv__direction(f, noise, k);
    return (crv__vec3){d.x * t.x + d.y * b.x, d.x * t.y + d.y * b.y,
                       d.x * t.z + d.y * b.z};
}

/* The unit vector over the tangent t whose cosine with n squares to z2. */
static inline crv__vec3 crv__raised(crv__vec3 n, crv__vec3 t, float z2)
{
    const float z = sqrtf(z2), xy = sqrtf(fmaxf(0, 1 - z2));
    return (crv__vec3){z * n.x + xy * t.x, z * n.y + xy * t.y, z * n.z + xy * t.z};
}

/*
 * P raised along n by one pixel's footprint at its depth: point-sampled depth of a
 * slanted surface is a staircase, and this is the height of its steps (2008a, eq. 13).
 */
static inline crv__vec3 crv__lift(const crv__params *p, crv__vec3 P, crv__vec3 n)
{
    const float focal = fminf(p->fx, p->fy);
    return crv__add_scaled(P, n, (p->orthographic ? 1 : -P.z) / focal);
}

/* The pixel that a view-space point falls on; 0 where it is behind the eye or off the
 * buffers. */
static inline int crv__texel_of(const crv__params *p, crv__vec3 Q, int32_t *u, int32_t *v)
{
    const float unit = p->orthographic ? 1 : -Q.z;
    if (!(unit > 0))
        return 0;
    const float inverse = 1 / unit;
    const float x = p->cx + p->fx * Q.x * inverse, y = p->cy - p->fy * Q.y * inverse;
    if (!(x >= 0 && x < (float)p->width && y >= 0 && y < (float)p->height))
        return 0;
    *u = (int32_t)x;
    *v = (int32_t)y;
    return 1;
}

/* The depth of the back of what has its front at depth d in this layer: where layers come
 * in pairs, the next one's; else `thickness` behind the front. */
static inline float crv__back_of(const crv__frame *f, int32_t layer, int32_t u, int32_t v,
                                 float d, float thickness)
{
    return f->params->layers_solid && layer + 1 < f->params->layers
               ? *crv__plane_at(&f->depth[layer + 1], u, v)
               : d + thickness;
}

/*
 * Whether something blocks the point Q as seen from `origin`: a surface less than the
 * radius away from the origin with Q behind it, but not behind its back. *I is the
 * surface point at Q's pixel, read at the texel's centre and never interpolated.
 */
static inline int crv__blocked(const crv__frame *f, crv__vec3 origin, crv__vec3 Q,
                               crv__vec3 *I)
{
    const crv__params *p = f->params;
    int32_t u, v;
    if (!crv__texel_of(p, Q, &u, &v))
        return 0;
    for (int32_t layer = 0; layer < p->layers; layer += 1 + p->layers_solid) {
        const float d = *crv__plane_at(&f->depth[layer], u, v);
        if (!(-Q.z > d)) /* in front of it, or background */
            continue;
        if (!(-Q.z < crv__back_of(f, layer, u, v, d, p->thickness)))
            continue;
        *I = crv__unproject(p, u, v, d);
        const crv__vec3 to = crv__sub(*I, origin);
        if (crv__dot(to, to) < p->radius * p->radius)
            return 1;
    }
    return 0;
}

/* Marches from `origin` along the unit vector `direction` in `steps` jittered steps over
 * the radius. Returns the falloff's weight of the first thing in the way; 0 where there
 * is none. */
float crv__march(const crv__frame *f, crv__vec3 origin, crv__vec3 direction, float beta);

#endif
