/* SPDX-License-Identifier: MIT */
/* Pipes: the part of a view ray inside a sphere, and how much of it is open. */
#ifndef CRV_METHODS_PIPE_H
#define CRV_METHODS_PIPE_H

#include "methods/march.h"

/*
 * A pipe goes along z of clip space (2010, the depth buffer's own direction): the view
 * ray of a texel's centre. On it the depth buffer is exact, so that a plane never enters
 * a sphere that only touches it.
 */
typedef struct crv__pipe {
    int32_t u, v;         /* the texel; may lie outside the buffers */
    float entry, exit;    /* where the ray enters and leaves the sphere: planar depth less
                             that of P */
    crv__vec3 start, ray; /* the ray: start + (depth - .depth) * ray, ray.z = -1 */
    float depth;          /* of start, P's */
} crv__pipe;

/*
 * The pipe through the sphere's centre + radius * the pattern's disk point, turned by the
 * noise, snapped to the nearest texel. The centre is P + `offset`, P the point of pixel
 * (x, y). All is relative to P, because far from the eye a sphere is smaller than the
 * rounding of its distance. 0 if the snapped ray misses the sphere, or a part of the
 * sphere lies behind the eye.
 */
static inline int crv__pipe_through(const crv__params *p, int32_t x, int32_t y,
                                    crv__vec3 P, crv__vec3 offset, float radius,
                                    const float *point, const crv__noise_texel *noise,
                                    crv__pipe *pipe)
{
    const crv__vec2 disk = crv__turned(noise, point[0], point[1]);
    const float d = -P.z, unit = p->orthographic ? 1 : d - offset.z;
    if (!(unit > 0))
        return 0;
    /* Pixels from P's: the centre, and the disk point beside it. */
    const float inverse = 1 / unit;
    const float scale_x = p->fx * inverse, scale_y = p->fy * inverse;
    const float centre_x = p->cx + (P.x + offset.x) * scale_x - (float)x;
    const float centre_y = p->cy - (P.y + offset.y) * scale_y - (float)y;
    const float right = floorf(centre_x + disk.x * radius * scale_x);
    const float down = floorf(centre_y - disk.y * radius * scale_y);
    /* Pixels this far out are background anyway, and no longer fit an integer. */
    if (!(fabsf(right) < 1e9f && fabsf(down) < 1e9f))
        return 0;
    pipe->u = x + (int32_t)right;
    pipe->v = y + (int32_t)down;
    /* The ray's point at P's depth, from P. */
    const float scale = p->orthographic ? 1 : d;
    const crv__vec3 aside = {right * p->inv_fx * scale, -down * p->inv_fy * scale, 0};
    pipe->start = (crv__vec3){P.x + aside.x, P.y + aside.y, P.z};
    pipe->ray = p->orthographic ? (crv__vec3){0, 0, -1}
                                : (crv__vec3){pipe->start.x / d, pipe->start.y / d, -1};
    pipe->depth = d;
    /* |aside + t ray - offset|^2 = radius^2, about the point nearest to the centre. */
    const crv__vec3 to = crv__sub(offset, aside);
    const float squared = crv__dot(pipe->ray, pipe->ray);
    const float middle = crv__dot(to, pipe->ray) / squared;
    const crv__vec3 miss = crv__add_scaled(to, pipe->ray, -middle);
    const float rest = radius * radius - crv__dot(miss, miss);
    if (!(rest > 0))
        return 0;
    const float half = sqrtf(rest / squared);
    pipe->entry = middle - half;
    pipe->exit = middle + half;
    return p->orthographic || d + pipe->entry > 0;
}

/* Its point at a depth, less that of P. */
static inline crv__vec3 crv__pipe_at(const crv__pipe *pipe, float depth)
{
    return crv__add_scaled(pipe->start, pipe->ray, depth);
}

/* The length between two depths, `from` to `to` behind `origin`, that lies outside the
 * surfaces of the depth buffer at a texel: in front of the first layer, and in between
 * where layers come in pairs. */
static inline float crv__open_length(const crv__frame *f, int32_t u, int32_t v,
                                     float origin, float from, float to)
{
    const crv__params *p = f->params;
    if (!crv__plane_holds(&f->depth[0], u, v))
        return to - from;
    float open = 0;
    for (int32_t layer = 0; layer < p->layers && from < to; layer += 2) {
        const float front = *crv__plane_at(&f->depth[layer], u, v) - origin;
        if (front > from)
            open += fminf(front, to) - from;
        if (!p->layers_solid || layer + 1 >= p->layers || front >= to)
            return open;
        from = fmaxf(from, *crv__plane_at(&f->depth[layer + 1], u, v) - origin);
    }
    return from < to ? open + (to - from) : open;
}

#endif
