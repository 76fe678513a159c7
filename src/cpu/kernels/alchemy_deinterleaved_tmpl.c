/* SPDX-License-Identifier: MIT */
/* methods/alchemy.c in the di structure, in the units of hbao_deinterleaved_tmpl.c: with
 * k = 1 - ds/d, v.n = n.o - k (n.o + n.ray). Samples at P itself are left out: they add
 * nothing.
 */
#include "cpu/kernels/groups.h"

typedef struct view {
    vf scale, origin;  /* k = origin - scale * ds */
    vf ray2;           /* |ray|^2 */
    vf limit;          /* radius^2 */
    vf facing;         /* -n.ray */
    vf half_x, half_y; /* n / 2 */
    vf bias, eps;
} view;

CRV__INLINE view view_of(const crv__group_pixels *at, int32_t orthographic)
{
    const crv__params *p = at->frame->params;
    const vf one = vf_set(1), half = vf_set(0.5f), rx = at->ray_x, ry = at->ray_y;
    const vf inverse = orthographic ? one : at->inverse;
    const vf radius = vf_set(p->radius) * inverse;
    view w = {.scale = inverse, .origin = orthographic ? at->depth : one};
    w.limit = radius * radius;
    w.ray2 = vf_fma(rx, rx, vf_fma(ry, ry, one));
    w.facing = at->n.z - at->n.x * rx - at->n.y * ry;
    w.half_x = at->n.x * half;
    w.half_y = at->n.y * half;
    w.bias = vf_set(p->alchemy_bias) * (orthographic ? at->depth : one);
    w.eps = vf_set(p->alchemy_eps) * w.limit;
    return w;
}

/* sample_count() */
CRV__INLINE vf count_of(const crv__group_pixels *at, const view *w)
{
    const crv__params *p = at->frame->params;
    const float focal = p->fx > p->fy ? p->fx : p->fy;
    const vf bands = vf_set((float)p->bands), samples = vf_set((float)p->samples);
    const vf radius_px = vf_set(p->radius * focal) * w->scale;
    const vf up = vf_zero() - vf_floor(radius_px * vf_set(-(float)p->bands / p->band_px));
    const vf used = vf_min(vf_max(up, vf_set(1)), bands);
    /* Rounded up; the quotient of integers is at least 1/bands from the next. */
    return vf_floor((samples * used + bands - vf_set(0.5f)) / bands);
}

CRV__INLINE vf sum_of_points(const crv__group_pixels *at, const crv__list *list,
                             int32_t orthographic, int32_t layers, int32_t banded,
                             int32_t border)
{
    const crv__params *p = at->frame->params;
    const view w = view_of(at, orthographic);
    const vf count = banded ? count_of(at, &w) : vf_set((float)p->samples);
    vf sum = vf_zero();
    for (int32_t i = 0; i < list->counts[0]; i++) {
        const crv__sample *s = &list->samples[i];
        const vf x2 = vf_set(s->x2), y2 = vf_set(s->y2), squared2 = vf_set(s->squared);
        const float *from = crv__sample_at(at, &list->places[i], 0, border);
        const vf along = vf_fma(x2, at->ray_x, y2 * at->ray_y);
        const vf rise = vf_fma(x2, w.half_x, y2 * w.half_y);
        vm left = vf_le(w.scale, w.scale); /* lanes with no layer within the radius yet */
        for (int32_t layer = 0; layer < layers; layer++) {
            const vf depth = crv__sample_depth(at, from + layer * at->di->layer_pitch);
            const vf k = vf_fma(-depth, w.scale, w.origin);
            vf squared, over;
            if (orthographic) {
                squared = vf_fma(k, k, squared2);
                over = vf_fma(k, w.facing, rise);
            } else {
                squared = vf_fma(k,
                                 vf_fma(k, w.ray2 + squared2 + along,
                                        vf_set(s->minus_squared2) - along),
                                 squared2);
                over = vf_fma(k, w.facing - rise, rise);
            }
            vf above = over - w.bias;
            if (layers > 1 || banded) {
                vm valid = vm_and(vf_le(squared, w.limit), left);
                left = vm_and(left, vm_not(valid));
                if (banded)
                    valid =
                        vm_and(valid, vf_lt(vf_set((float)list->places[i].index), count));
                above = vf_where(valid, vf_max(above, vf_zero()));
            } else {
                above = vf_max_within(vf_zero(), above, squared, w.limit);
            }
            sum = vf_fma(above, vf_rcp_rough(squared + w.eps), sum);
        }
    }
    /* The points stand for the disk's area, which is the list's, not quite the pixel's.
     */
    const vf ratio = vf_set(list->radius * p->inv_radius * p->inv_fy)
                     * (orthographic ? vf_set(1) : at->depth);
    const vf share = banded ? vf_set(2 * p->radius) / count
                            : vf_set(2 * p->radius / (float)p->samples);
    return vf_set(1) - sum * w.scale * share * (ratio * ratio);
}

CRV__NOINLINE vf common(const crv__group_pixels *at, const crv__list *list)
{
    return sum_of_points(at, list, 0, 1, 0, 0);
}

CRV__NOINLINE vf common_border(const crv__group_pixels *at, const crv__list *list)
{
    return sum_of_points(at, list, 0, 1, 0, 1);
}

CRV__NOINLINE vf general(const crv__group_pixels *at, const crv__list *list)
{
    const crv__params *p = at->frame->params;
    return sum_of_points(at, list, p->orthographic, p->layers, p->bands > 1, 1);
}

CRV__INLINE vf accessibility(const crv__group_pixels *at, const crv__list *list)
{
    const crv__params *p = at->frame->params;
    if (p->layers > 1 || p->orthographic || p->bands > 1)
        return general(at, list);
    return at->at_border ? common_border(at, list) : common(at, list);
}

CRV__DEINTERLEAVED_KERNEL(alchemy, .far_on_grid = true, .fineness = 2)
