/* SPDX-License-Identifier: MIT */
#include "buffers.h"

#include <math.h>
#include <stdlib.h>

size_t buffers_index(const buffers *b, int32_t x, int32_t y)
{
    const crv_gbuffer_desc *d = &b->g.desc;
    return (size_t)(y + d->guard_top) * (size_t)d->width + (size_t)(x + d->guard_left);
}

buffers *buffers_make(scene_gbuffer *g)
{
    const crv_gbuffer_desc *d = &g->desc;
    buffers *b = calloc(1, sizeof *b);
    if (b) {
        b->width = d->width - d->guard_left - d->guard_right;
        b->height = d->height - d->guard_top - d->guard_bottom;
        b->surface = malloc((size_t)b->width * (size_t)b->height);
    }
    if (!b || !b->surface) {
        free(b);
        scene_gbuffer_free(g);
        return NULL;
    }
    b->g = *g;
    atomic_init(&b->holders, 1);
    uint8_t *out = b->surface;
    for (int32_t y = 0; y < b->height; y++)
        for (int32_t x = 0; x < b->width; x++) {
            const float depth = g->depth[0][buffers_index(b, x, y)];
            *out++ = depth > 0.0f && isfinite(depth);
        }
    *g = (scene_gbuffer){0};
    return b;
}

buffers *buffers_hold(buffers *b)
{
    if (b)
        atomic_fetch_add(&b->holders, 1);
    return b;
}

void buffers_release(buffers *b)
{
    if (!b || atomic_fetch_sub(&b->holders, 1) > 1)
        return;
    scene_gbuffer_free(&b->g);
    free(b->surface);
    free(b->beauty);
    free(b);
}

bool buffers_point(const buffers *b, int32_t x, int32_t y, double out[3])
{
    const crv_camera *c = &b->g.camera;
    const size_t i = (size_t)y * (size_t)b->g.desc.width + (size_t)x;
    const double d = (double)b->g.depth[0][i];
    if (!(d > 0.0 && isfinite(d)))
        return false;
    const double spread = c->projection == CRV_PERSPECTIVE ? d : 1.0;
    out[0] = (x + 0.5 - (double)c->cx_px) / (double)c->fx_px * spread;
    out[1] = -(y + 0.5 - (double)c->cy_px) / (double)c->fy_px * spread;
    out[2] = -d;
    return true;
}
