/* SPDX-License-Identifier: MIT */
/*
 * What lies beyond the borders of the buffers (methods/slice.h), for a sample of a group.
 * The texels at the border nearest to it are a row of a phase's plane; to the left and
 * right of the buffers they are one texel for all lanes.
 */
#ifndef CRV_CPU_KERNELS_BEYOND_H
#define CRV_CPU_KERNELS_BEYOND_H

#include "cpu/kernels/groups.h"
#include "cpu/kernels/slice.h"

/* Where the lanes have a sample. */
typedef struct crv__group_spot {
    vi u;
    int32_t left, v; /* column of the first lane; row */
    int32_t y;       /* of the buffers, nearest to the row */
    vm over_left, over_right, off;
} crv__group_spot;

CRV__INLINE crv__group_spot crv__group_spot_at(const crv__group_pixels *at,
                                               const crv__sample_place *place)
{
    const crv__params *p = at->frame->params;
    const int32_t v = at->y + place->dv, bottom = p->height - 1;
    crv__group_spot spot = {.u = at->x + vi_set(place->du),
                            .left = at->left + place->du,
                            .v = v,
                            .y = v < 0        ? 0
                                 : v > bottom ? bottom
                                              : v};
    spot.over_left = vi_lt(spot.u, vi_set(0));
    spot.over_right = vi_lt(vi_set(p->width - 1), spot.u);
    spot.off = vm_or(spot.over_left, spot.over_right);
    if (spot.y != v)
        spot.off = vm_not(vm_none());
    return spot;
}

/* The texels of row y nearest to the lanes' samples. The plane's copy by phases is `skip`
 * floats behind that of the first layer's depth. */
CRV__INLINE vf crv__group_nearest(const crv__group_pixels *at, const crv__plane *plane,
                                  ptrdiff_t skip, const crv__group_spot *spot, int32_t y)
{
    const crv__deinterleaved *di = at->di;
    const int32_t column = spot->left + di->left, phase = column & (CRV__PHASES - 1);
    int32_t m = (column - phase) / CRV__PHASES; /* none of a row beyond its padding */
    m = m < -CRV__ROW_PADDING ? -CRV__ROW_PADDING : m;
    m = m > di->columns ? di->columns : m;
    const vf row = vf_load(di->depth + skip + crv__deinterleaved_index(di, y, phase, m));
    const vf first = vf_set(*crv__plane_at(plane, 0, y)),
             last = vf_set(*crv__plane_at(plane, plane->width - 1, y));
    return vf_select(spot->over_left, first, vf_select(spot->over_right, last, row));
}

/* What is linear over the image of a plane; 0 where there is no surface. */
CRV__INLINE vf crv__group_linear(const crv__group_pixels *at, vf depth)
{
    if (at->frame->params->orthographic)
        return depth;
    return vf_where(vf_lt(depth, vf_set(at->di->background)), vf_rcp(depth));
}

/* Its change from the column at the border to those on the left or right, on the lanes
 * of `over`, which are `count` columns away; in: 1 if the border is the left one, else
 * -1. */
CRV__INLINE vf crv__group_aside(const crv__group_pixels *at, const crv__group_spot *spot,
                                vf own, vm over, vi count, int32_t in)
{
    const crv__plane *plane = &at->frame->depth[0];
    const float *border = crv__plane_at(plane, in > 0 ? 0 : plane->width - 1, spot->y);
    const vf middle = crv__group_linear(at, vf_set(border[2 * in])),
             inner = crv__group_linear(at, vf_set(border[4 * in]));
    return vf_where(over, crv__lanes_slope(own, middle, inner) * vf_of(count));
}

/* crv__slice_beyond() of the lanes that are off the buffers; as far as the background
 * where there is no surface. */
CRV__NOINLINE vf crv__group_beyond(const crv__group_pixels *at,
                                   const crv__group_spot *spot)
{
    const crv__params *p = at->frame->params;
    const crv__plane *plane = &at->frame->depth[0];
    const vf background = vf_set(at->di->background);
    const vf d = crv__group_nearest(at, plane, 0, spot, spot->y),
             own = crv__group_linear(at, d);
    vf w = own;
    if (p->width > 4 && vm_any(spot->over_left))
        w = w + crv__group_aside(at, spot, own, spot->over_left, vi_set(0) - spot->u, 1);
    if (p->width > 4 && vm_any(spot->over_right))
        w = w
            + crv__group_aside(at, spot, own, spot->over_right,
                               spot->u - vi_set(p->width - 1), -1);
    if (p->height > 4 && spot->y != spot->v) {
        const int32_t in = spot->v < 0 ? 1 : -1, away = (spot->y - spot->v) * in;
        const vf middle = crv__group_linear(
                     at, crv__group_nearest(at, plane, 0, spot, spot->y + 2 * in)),
                 inner = crv__group_linear(
                     at, crv__group_nearest(at, plane, 0, spot, spot->y + 4 * in));
        w = w + crv__lanes_slope(own, middle, inner) * vf_set((float)away);
    }
    const vf third = own * vf_set(1.0f / 3), thrice = vf_set(3) * own;
    const vm near = p->orthographic ? vf_le(w, thrice) : vf_le(third, w);
    w = p->orthographic ? vf_max(w, third) : vf_rcp(vf_min(w, thrice));
    return vf_select(vm_and(vf_lt(d, background), near), vf_min(w, background),
                     background);
}

#endif
