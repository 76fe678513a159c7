/* SPDX-License-Identifier: MIT */
/* methods/vo.c in the di structure. Lengths are in radii. */
#include "cpu/kernels/groups.h"

/* How far the surface is behind P's depth, at most the chord's half either way. */
CRV__INLINE vf behind(const crv__group_pixels *at, vf depth, vf half, vf unit,
                      int32_t orthographic)
{
    vf b;
    if (orthographic) {
        b = (depth - at->depth) * unit;
    } else {
        const vf ratio = depth * at->inverse;
        b = vf_fma(depth, at->inverse, vf_set(-1)) * vf_rcp_rough(ratio) * unit;
    }
    b = vf_min(vf_max(b, vf_zero() - half), half);
    return vf_select(vf_lt(depth, vf_set(at->di->background)), b, half);
}

CRV__INLINE vf sum_of_lines(const crv__group_pixels *at, const crv__list *list,
                            int32_t orthographic, int32_t paired, int32_t border)
{
    const crv__params *p = at->frame->params;
    const vf zero = vf_zero(), one = vf_set(1);
    /* Radii to the unit of the offsets. */
    const vf unit = vf_set(p->inv_radius) * (orthographic ? one : at->depth);
    const vf unit2 = unit * unit;
    vf sum = zero, total = zero;
    for (int32_t i = 0; i < list->counts[0]; i++) {
        const vf rest = vf_fma(vf_set(-list->samples[i].squared), unit2, one);
        const vf half = vf_where(vf_lt(zero, rest), rest * vf_rsqrt_fair(rest));
        const crv__sample_place *place = &list->places[i];
        for (int32_t side = 0; side < 1 + paired; side++) {
            const vf depth =
                crv__sample_depth(at, crv__sample_at(at, place, side, border));
            sum = sum + behind(at, depth, half, unit, orthographic);
        }
        total = total + half;
    }
    if (paired)
        total = total + total;
    return vf_select(vf_lt(zero, total), vf_min(one + sum / total, one), one);
}

CRV__NOINLINE vf common(const crv__group_pixels *at, const crv__list *list)
{
    return sum_of_lines(at, list, 0, 1, 0);
}

CRV__NOINLINE vf common_border(const crv__group_pixels *at, const crv__list *list)
{
    return sum_of_lines(at, list, 0, 1, 1);
}

CRV__NOINLINE vf general(const crv__group_pixels *at, const crv__list *list)
{
    return sum_of_lines(at, list, at->frame->params->orthographic, at->di->paired, 1);
}

CRV__INLINE vf accessibility(const crv__group_pixels *at, const crv__list *list)
{
    if (!at->di->paired || at->frame->params->orthographic)
        return general(at, list);
    return at->at_border ? common_border(at, list) : common(at, list);
}

CRV__DEINTERLEAVED_KERNEL(vo, .in_pairs = true, .is_rounded = true, .keeps_centre = true,
                          .fineness = 4)
