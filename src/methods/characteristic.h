/* SPDX-License-Identifier: MIT */
/*
 * Characteristic functions (2010): what is outside. The depth buffer, a field (height
 * field or implicit surface), or the product of both: outside both.
 */
#ifndef CRV_METHODS_CHARACTERISTIC_H
#define CRV_METHODS_CHARACTERISTIC_H

#include "core/field.h"
#include "methods/pipe.h"

/* The shaded point. */
typedef struct crv__site {
    crv__vec3 P, n, lifted; /* lifted: the start of points that are tested one by one */
    crv__local_frame local;
} crv__site;

static inline crv__site crv__site_at(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    crv__site site = {.P = crv__unproject(p, x, y, *crv__plane_at(&f->depth[0], x, y)),
                      .n = crv__normal_at(f, x, y)};
    if (p->use_field && !f->field->implicit) {
        site.local = crv__local_frame_at(f->field, site.n, x, y);
        if (site.local.valid)
            site.n = (crv__vec3){*crv__plane_at(&f->field->relief_normal[0], x, y),
                                 *crv__plane_at(&f->field->relief_normal[1], x, y),
                                 *crv__plane_at(&f->field->relief_normal[2], x, y)};
    }
    site.lifted = crv__lift(p, site.P, site.n);
    return site;
}

/* Whether q is in front of the depth buffer's first surface or behind the back of every
 * surface in front of it: the next layer where layers come in pairs, else `thickness`
 * behind the front. Off the buffers is outside. */
static inline int crv__outside_depth(const crv__frame *f, crv__vec3 q, float thickness)
{
    const crv__params *p = f->params;
    int32_t u, v;
    if (!crv__texel_of(p, q, &u, &v))
        return 1;
    for (int32_t layer = 0; layer < p->layers; layer += 1 + p->layers_solid) {
        const float d = *crv__plane_at(&f->depth[layer], u, v);
        if (!(-q.z > d)) /* and in front of all further ones */
            return 1;
        if (-q.z < crv__back_of(f, layer, u, v, d, thickness))
            return 0;
    }
    return 1;
}

/*
 * Beside a height field the depth buffer stands for the other objects: the macro surface
 * that carries the relief is in it as well, and must not hide the relief's hollows.
 */
static inline int crv__is_own_surface(const crv__frame *f, const crv__site *site,
                                      int32_t u, int32_t v)
{
    if (!site->local.valid || !crv__plane_holds(&f->depth[0], u, v))
        return 0;
    const float d = *crv__plane_at(&f->depth[0], u, v);
    if (!(d < INFINITY))
        return 0;
    const crv__vec3 to = crv__sub(crv__unproject(f->params, u, v, d), site->P);
    const float footprint = crv__dot(crv__sub(site->lifted, site->P), site->n);
    return crv__dot(to, site->local.normal) < footprint + 0.02f * crv__length(to);
}

/* Whether q, a point near the site, is outside. */
static inline int crv__outside(const crv__frame *f, const crv__site *site, crv__vec3 q)
{
    const crv__params *p = f->params;
    if (p->use_field) {
        crv__vec3 gradient;
        if (!(crv__field_value(f->field, &site->local, site->P, q, &gradient) >= 0))
            return 0;
    }
    if (!p->use_depth || crv__outside_depth(f, q, p->thickness))
        return 1;
    int32_t u, v;
    return crv__texel_of(p, q, &u, &v) && crv__is_own_surface(f, site, u, v);
}

/* The length of the part of the pipe that is outside. On a field the surface is found to
 * first order from the pipe's middle: -f / (df/dz). */
static inline float crv__pipe_outside(const crv__frame *f, const crv__site *site,
                                      const crv__pipe *pipe)
{
    const crv__params *p = f->params;
    crv__pipe rest = *pipe;
    if (p->use_field) {
        const float middle = 0.5f * (pipe->entry + pipe->exit);
        crv__vec3 gradient;
        const float value = crv__field_value(f->field, &site->local, site->P,
                                             crv__pipe_at(pipe, middle), &gradient);
        const float slope = crv__dot(gradient, pipe->ray);
        const float surface = middle - value / slope;
        if (slope < 0)
            rest.exit = fminf(rest.exit, surface);
        else if (slope > 0)
            rest.entry = fmaxf(rest.entry, surface);
        else if (value < 0)
            return 0;
        if (!(rest.exit > rest.entry))
            return 0;
    }
    if (!p->use_depth || crv__is_own_surface(f, site, pipe->u, pipe->v))
        return rest.exit - rest.entry;
    /* The sphere touches its own surface: far away the rounding of depth would cut it. */
    const float nearer = 1 - 2e-6f;
    return crv__open_length(f, pipe->u, pipe->v, pipe->depth * nearer, rest.entry,
                            rest.exit);
}

#endif
