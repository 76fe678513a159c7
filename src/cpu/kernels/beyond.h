/* SPDX-License-Identifier: MIT */
/*
 * What lies beyond the borders of the buffers (methods/slice.h), for a sample of a group.
 * The texels at the border nearest to it are a row of a phase's plane; to the left and
 * right of the buffers they are one texel for all lanes.
 */
#ifndef CRV_CPU_KERNELS_BEYOND_H
#define CRV_CPU_KERNELS_BEYOND_H

#include "cpu/kernels/groups.h"

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

/* The column in a phase's plane that holds the first lane's, none beyond the padding. */
CRV__INLINE int32_t crv__group_spot_column(const crv__deinterleaved *di,
                                           const crv__group_spot *spot, int32_t *phase)
{
    const int32_t column = spot->left + di->left;
    *phase = column & (CRV__PHASES - 1);
    const int32_t m = (column - *phase) / CRV__PHASES;
    return m < -CRV__ROW_PADDING ? -CRV__ROW_PADDING : m > di->columns ? di->columns : m;
}

/* The texels of a plane nearest to the lanes' samples. Its copy by phases is `skip`
 * floats behind that of the first layer's depth. */
CRV__INLINE vf crv__group_nearest(const crv__group_pixels *at, const crv__plane *plane,
                                  ptrdiff_t skip, const crv__group_spot *spot)
{
    const crv__deinterleaved *di = at->di;
    const int32_t y = spot->y;
    int32_t phase;
    const int32_t m = crv__group_spot_column(di, spot, &phase);
    const vf row = vf_load(di->depth + skip + crv__deinterleaved_index(di, y, phase, m));
    const vf first = vf_set(*crv__plane_at(plane, 0, y)),
             last = vf_set(*crv__plane_at(plane, plane->width - 1, y));
    return vf_select(spot->over_left, first, vf_select(spot->over_right, last, row));
}

/* What the left or right border's column changes by, on the lanes of `over`, which are
 * `count` columns away. */
CRV__INLINE vf crv__group_aside(const crv__deinterleaved *di, const crv__group_spot *spot,
                                int32_t is_right, vm over, vi count)
{
    const float slope = di->border[crv__border_column(di, is_right, 1, spot->y)];
    return vf_where(over, vf_set(slope) * vf_of(count));
}

/* crv__slice_beyond() of the lanes that are off the buffers; as far as the background
 * where there is no surface. */
CRV__INLINE vf crv__group_beyond(const crv__group_pixels *at, const crv__group_spot *spot)
{
    const crv__params *p = at->frame->params;
    const crv__deinterleaved *di = at->di;
    vf own, w;
    if (spot->y == spot->v) {
        const float left = di->border[crv__border_column(di, 0, 0, spot->y)],
                    right = di->border[crv__border_column(di, 1, 0, spot->y)];
        w = own = vf_select(spot->over_left, vf_set(left), vf_set(right));
    } else {
        const int32_t is_bottom = spot->v > 0;
        const int32_t away = is_bottom ? spot->v - spot->y : spot->y - spot->v;
        int32_t phase;
        const int32_t m = crv__group_spot_column(di, spot, &phase);
        own = vf_load(di->border + crv__border_row(di, is_bottom, 0, phase, m));
        w = vf_fma(vf_load(di->border + crv__border_row(di, is_bottom, 1, phase, m)),
                   vf_set((float)away), own);
    }
    if (vm_any(spot->over_left))
        w = w + crv__group_aside(di, spot, 0, spot->over_left, vi_set(0) - spot->u);
    if (vm_any(spot->over_right))
        w = w
            + crv__group_aside(di, spot, 1, spot->over_right,
                               spot->u - vi_set(p->width - 1));
    const vf third = own * vf_set(1.0f / 3), thrice = vf_set(3) * own;
    const vm near = p->orthographic ? vf_le(w, thrice) : vf_le(third, w);
    const vf background = vf_set(di->background);
    /* Estimates of a reciprocal end at tiny numbers. */
    const vf least = vf_set(1 / di->background);
    w = p->orthographic ? vf_max(w, third) : vf_rcp(vf_max(vf_min(w, thrice), least));
    return vf_select(near, vf_min(w, background), background);
}

#endif
