/* SPDX-License-Identifier: MIT */
/*
 * The fast way through a filter: blocks of two rows of a vector each, whose windows lie
 * within the input. What the rows read at one offset is loaded once for both, and
 * nothing is tested: the depth of background is infinite, which brings any weight to 0.
 */
#ifndef CRV_CPU_KERNELS_BLOCK_H
#define CRV_CPU_KERNELS_BLOCK_H

#include "cpu/kernels/window.h"

enum { CRV__BLOCK_ROWS = 2 }; /* four would need more registers than there are */

/* From here on the likeness is a matter of rounding: left to the general way. */
#define CRV__SHARPEST 1000.0f

/* What filters weigh neighbours by. */
typedef struct crv__limits {
    vf depth, inv_depth;
    vf normal, likeness_base; /* likeness = normal * cosine + base */
} crv__limits;

/* A centre of each lane; `turned` is its normal times limits.normal. */
typedef struct crv__centre {
    vf depth, slope_x, slope_y;
    crv__v3 turned;
} crv__centre;

/* A tap, as it was read. */
typedef struct crv__texel {
    vf depth, value;
    crv__v3 normal;
} crv__texel;

CRV__INLINE crv__limits crv__limits_of(const crv__params *p)
{
    return (crv__limits){vf_set(p->filter_depth), vf_set(1 / p->filter_depth),
                         vf_set(p->filter_normal), vf_set(1 - p->filter_normal)};
}

/* crv__slope() from both neighbours. */
CRV__INLINE vf crv__block_slope(vf before, vf d, vf after)
{
    const vf backward = d - before, forward = after - d;
    const vf slope =
        vf_select(vf_lt(vf_abs(forward), vf_abs(backward)), forward, backward);
    return vf_where(vf_lt(vf_abs(slope), vf_set(INFINITY)), slope);
}

/* With the slopes along x, y or both. */
CRV__INLINE crv__centre crv__block_centre(const crv__frame *f, const crv__limits *limits,
                                          int32_t x, int32_t y, int with_x, int with_y)
{
    const crv__plane *plane = &f->depth[0];
    const float *depth = crv__plane_at(plane, x, y);
    crv__centre c = {.depth = vf_load(depth)};
    c.turned = (crv__v3){vf_load(crv__plane_at(&f->normal[0], x, y)) * limits->normal,
                         vf_load(crv__plane_at(&f->normal[1], x, y)) * limits->normal,
                         vf_load(crv__plane_at(&f->normal[2], x, y)) * limits->normal};
    c.slope_x = c.slope_y = vf_zero();
    if (f->params->filter_slope && with_x)
        c.slope_x = crv__block_slope(vf_load(depth - 1), c.depth, vf_load(depth + 1));
    if (f->params->filter_slope && with_y)
        c.slope_y = crv__block_slope(vf_load(depth - plane->pitch), c.depth,
                                     vf_load(depth + plane->pitch));
    return c;
}

CRV__INLINE crv__texel crv__block_texel(const crv__frame *f, const crv__plane *input,
                                        int32_t x, int32_t y)
{
    return (crv__texel){vf_load(crv__plane_at(&f->depth[0], x, y)),
                        vf_load(crv__plane_at(input, x, y)),
                        {vf_load(crv__plane_at(&f->normal[0], x, y)),
                         vf_load(crv__plane_at(&f->normal[1], x, y)),
                         vf_load(crv__plane_at(&f->normal[2], x, y))}};
}

/* The cosine's part of the likeness: not cut off at 0 yet; above 1 by rounding only. */
CRV__INLINE vf crv__block_likeness(const crv__limits *limits, const crv__centre *c,
                                   const crv__texel *tap)
{
    return vf_fma(tap->normal.x, c->turned.x,
                  vf_fma(tap->normal.y, c->turned.y,
                         vf_fma(tap->normal.z, c->turned.z, limits->likeness_base)));
}

/* a + steps * slope; the product is the same number for as many steps either way. */
CRV__INLINE vf crv__block_step(vf a, vf slope, int32_t steps)
{
    const vf change = vf_set((float)(steps < 0 ? -steps : steps)) * slope;
    return steps == 0 ? a : steps < 0 ? a - change : a + change;
}

/* Whether the window of a block of `rows` rows at (x, y) lies within the input. */
CRV__INLINE int crv__block_is_free(const crv__plane *input, int32_t x, int32_t y,
                                   int32_t rows, int32_t reach_x, int32_t reach_y)
{
    return x - reach_x >= input->x0 && y - reach_y >= input->y0
           && x + reach_x + CRV__LANES <= input->x0 + input->width
           && y + reach_y + rows <= input->y0 + input->height;
}

/* Background is 1. */
CRV__INLINE void crv__block_store(const crv__plane *out, int32_t x, int32_t y, vf depth,
                                  vf result)
{
    const vm surface = vf_lt(depth, vf_set(INFINITY));
    vf_store(crv__plane_at(out, x, y), vf_select(surface, vf_clamp01(result), vf_set(1)));
}

CRV__INLINE int crv__block_is_empty(const crv__frame *f, int32_t x, int32_t y,
                                    int32_t rows)
{
    vf nearest = vf_set(INFINITY);
    for (int32_t i = 0; i < rows; i++)
        nearest = vf_min(nearest, vf_load(crv__plane_at(&f->depth[0], x, y + i)));
    return !vm_any(vf_lt(nearest, vf_set(INFINITY)));
}

typedef void (*crv__block_filter)(const crv__frame *, const crv__plane *,
                                  const crv__plane *, int32_t, int32_t);

/* Defines the block filter `name` as function(..., with_normals), compiled for both. */
#define CRV__BLOCK_FILTER(name, function)                                                \
    CRV__NOINLINE void name(const crv__frame *f, const crv__plane *input,                \
                            const crv__plane *out, int32_t x, int32_t y)                 \
    {                                                                                    \
        if (f->params->filter_normal > 0)                                                \
            function(f, input, out, x, y, 1);                                            \
        else                                                                             \
            function(f, input, out, x, y, 0);                                            \
    }

/* One pass over a rectangle: `fast` for blocks of `rows` rows whose window reaches so
 * far, `slow` for the pixels that are left. */
CRV__INLINE void crv__filter_pass(const crv__frame *f, const crv__plane *input,
                                  const crv__plane *out, crv__tile r, int32_t rows,
                                  int32_t reach_x, int32_t reach_y,
                                  crv__block_filter fast,
                                  void (*slow)(const crv__frame *, const crv__plane *,
                                               int32_t, int32_t, int32_t, float *))
{
    const int careful = f->params->filter_normal > CRV__SHARPEST;
    for (int32_t y = r.y0; y < r.y1; y += rows) {
        const int32_t end = r.y1 - y < rows ? r.y1 - y : rows;
        for (int32_t x = r.x0; x < r.x1; x += CRV__LANES) {
            const int32_t count = r.x1 - x < CRV__LANES ? r.x1 - x : CRV__LANES;
            const int whole = end == rows && count == CRV__LANES && !careful
                              && crv__block_is_free(input, x, y, rows, reach_x, reach_y);
            if (whole && crv__block_is_empty(f, x, y, rows)) {
                for (int32_t i = 0; i < rows; i++)
                    vf_store(crv__plane_at(out, x, y + i), vf_set(1));
            } else if (whole) {
                fast(f, input, out, x, y);
            } else {
                for (int32_t i = 0; i < end; i++)
                    slow(f, input, x, y + i, count, crv__plane_at(out, x, y + i));
            }
        }
    }
}

#endif
