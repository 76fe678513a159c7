/* SPDX-License-Identifier: MIT */
/* Walks the groups of a row for a method's kernel in the fast structure (fast.h). */
#ifndef CRV_CPU_KERNELS_GROUPS_H
#define CRV_CPU_KERNELS_GROUPS_H

#include "cpu/kernels/fast.h"
#include "cpu/kernels/lanes.h"

typedef struct crv__fast_list {
    const crv__fast_sample *samples;
    const crv__fast_place *places;
    const uint16_t *counts;
    float radius;
} crv__fast_list;

/* Some lanes of a group, a vector of them. */
typedef struct crv__fast_pixels {
    const crv__frame *frame;
    const crv__fast *fast;
    const float *own;  /* their place in segment 0 of layer 0 */
    vf depth, inverse; /* planar depth, and 1 over it */
    vf ray_x, ray_y;   /* the view ray (x, y, -1), or (0, 0, -1) */
    crv__v3 n;
} crv__fast_pixels;

/* CRV__FAST_SPAN floats of a plane's row from x on, which may leave the plane; `fill`
 * there. Lands in `room` or is read where it is. */
CRV__INLINE const float *crv__span_read(const crv__plane *plane, int32_t x, int32_t y,
                                        float fill, float *room)
{
    const float *row = crv__plane_at(plane, plane->x0, y);
    const int32_t at = x - plane->x0;
    if (at >= 0 && at + CRV__FAST_SPAN <= plane->width) {
        for (int32_t i = 0; i < CRV__FAST_SPAN; i += CRV__FAST_GROUP)
            __builtin_prefetch(row + at + CRV__FAST_SPAN + i); /* the next one */
        return row + at;
    }
    for (int32_t i = 0; i < CRV__FAST_SPAN; i++)
        room[i] = at + i >= 0 && at + i < plane->width ? row[at + i] : fill;
    return room;
}

/* Splits a span into its four phases of a group each. */
CRV__INLINE void crv__span_split(const float *span, float (*phases)[CRV__FAST_GROUP])
{
    for (int32_t i = 0; i < CRV__FAST_GROUP; i += CRV__LANES) {
        vf parts[4];
        vf_split4(span + 4 * i, parts);
        for (int32_t k = 0; k < 4; k++)
            vf_store(phases[k] + i, parts[k]);
    }
}

/* The list of a bucket for a phase, with samples off the picture sent to background where
 * the group is near the border; `room` holds such places. */
CRV__INLINE crv__fast_list crv__fast_list_at(const crv__fast *fast, const crv__frame *f,
                                             int32_t bucket, int32_t phase, int32_t y,
                                             int32_t m, crv__fast_place *room)
{
    const int32_t index = bucket * CRV__FAST_PHASES * CRV__FAST_PHASES + phase;
    const int32_t most = fast->walks * fast->steps, height = f->params->height;
    const ptrdiff_t first = (ptrdiff_t)index * most;
    const crv__fast_reach reach = fast->reaches[index];
    crv__fast_list list = {fast->samples + first, fast->places + first,
                           fast->counts + (ptrdiff_t)index * fast->walks, reach.radius};
    if (y - reach.rows >= 0 && y + reach.rows < height
        && m + reach.shift_min > -CRV__FAST_GROUP && m + reach.shift_max < fast->columns)
        return list;
    const int32_t background = (int32_t) - (y * fast->pitch + CRV__FAST_PADDING + m);
    for (int32_t i = 0; i < most; i++) {
        room[i] = list.places[i];
        for (int32_t side = 0; side < 2; side++) {
            const int32_t v = y + (side ? -room[i].dv : room[i].dv);
            const int32_t u = m + room[i].shift[side];
            if (v < 0 || v >= height || u <= -CRV__FAST_GROUP || u >= fast->columns)
                room[i].offset[side] = background;
        }
    }
    list.places = room;
    return list;
}

/* A bucket for the lanes from bucket `low` on, which is the lowest of those left, and how
 * high its lanes may be: three buckets share the middle one, two the one that has more
 * lanes. *next: the lowest bucket beyond, INT32_MAX where there is none. */
CRV__INLINE int32_t crv__fast_choose(const int32_t *buckets, int32_t low, int32_t *high,
                                     int32_t *next)
{
    int32_t lowest = 0, above = 0, third = 0, beyond = INT32_MAX;
    for (int32_t i = 0; i < CRV__FAST_GROUP; i++) {
        lowest += buckets[i] == low;
        above += buckets[i] == low + 1;
        third |= buckets[i] == low + 2;
        beyond = buckets[i] > low + 2 && buckets[i] < beyond ? buckets[i] : beyond;
    }
    *high = low + 2;
    *next = beyond;
    return third || above > lowest ? low + 1 : low;
}

/* Lanes' depths of a sample. The next group of the phase will read the line after those
 * that this one reads: asking for it now hides the second level's misses. */
CRV__INLINE vf crv__fast_read(const float *from)
{
    __builtin_prefetch(from + 2 * CRV__FAST_GROUP);
    return vf_load(from);
}

typedef vf (*crv__fast_method)(const crv__fast_pixels *pixels,
                               const crv__fast_list *list);

/* Buckets and reciprocal depths of a group. Lanes without a surface are in no bucket
 * (-1), nor are those beyond the table; returns whether there is one of these. */
CRV__INLINE int crv__fast_buckets(const crv__fast *fast, const crv__params *p,
                                  const float *depth, int32_t phase, int32_t *buckets,
                                  float *inverses, int32_t *low, int32_t *high)
{
    const vf radius = vf_set(p->radius * p->fy), background = vf_set(fast->background);
    const vf cap = vf_set(fast->cap);
    vm far = vm_first(0);
    for (int32_t i = 0; i < CRV__FAST_GROUP; i += CRV__LANES) {
        const vf d = vf_load(depth + i), inverse = vf_set(1) / d;
        const vf r = p->orthographic ? radius : radius * inverse;
        const vf capped = vf_max(vf_min(r, cap) * vf_set(fast->scale[phase]),
                                 vf_set(CRV__FAST_SMALLEST));
        const vm surface = vf_lt(d, background);
        const vm within = vf_lt(r, vf_set(fast->largest));
        far = vm_or(far, vm_and(surface, vm_not(within)));
        const vi bucket =
            (vf_bits(capped) - vi_set(CRV__FAST_SMALLEST_BITS)) >> fast->shift;
        const vi own = vi_select(vm_and(surface, within), bucket, vi_set(-1));
        vf_store(inverses + i, inverse);
        __builtin_memcpy(buckets + i, &own, sizeof own);
    }
    *low = INT32_MAX;
    *high = -1;
    for (int32_t i = 0; i < CRV__FAST_GROUP; i++) {
        const int32_t b = buckets[i] < 0 ? INT32_MAX : buckets[i];
        *low = b < *low ? b : *low;
        *high = buckets[i] > *high ? buckets[i] : *high;
    }
    return vm_any(far);
}

/* One pass over a group: the lanes whose bucket is from low to high, with one list. */
CRV__INLINE void crv__fast_pass(crv__fast_pixels *at, const crv__fast_list *list,
                                const float *depth, const float *inverses,
                                const int32_t *buckets, int32_t low, int32_t high,
                                int32_t x, const float *const n[3], const float *own,
                                float *result, crv__fast_method method)
{
    const crv__params *p = at->frame->params;
    const vf one = vf_set(1), intensity = vf_set(p->intensity);
    for (int32_t i = 0; i < CRV__FAST_GROUP; i += CRV__LANES) {
        const vi bucket = vi_load(buckets + i);
        const vm mine =
            vm_and(vi_lt(vi_set(low - 1), bucket), vi_lt(bucket, vi_set(high + 1)));
        if (!vm_any(mine))
            continue;
        at->own = own + i;
        at->depth = vf_load(depth + i);
        at->inverse = vf_load(inverses + i);
        at->n = (crv__v3){vf_load(n[0] + i), vf_load(n[1] + i), vf_load(n[2] + i)};
        const vf column = vf_of(vi_set(x + 4 * i) + vi_iota() * vi_set(4));
        at->ray_x = p->orthographic ? vf_zero()
                                    : (column + vf_set(0.5f - p->cx)) * vf_set(p->inv_fx);
        const vf a = method(at, list);
        const vf shown = vf_clamp01(one - intensity * (one - a));
        vf_store(result + i, vf_select(mine, shown, vf_load(result + i)));
    }
}

/* All four phases of a span. Returns whether some radius is beyond the table. */
CRV__INLINE int crv__fast_span(const crv__frame *f, const crv__fast *fast, int32_t y,
                               int32_t group, float *span, crv__fast_method method)
{
    const crv__params *p = f->params;
    const int32_t m = group * CRV__FAST_GROUP, x = group * CRV__FAST_SPAN - fast->left;
    float room[CRV__FAST_SPAN], normal[3][4][CRV__FAST_GROUP], result[4][CRV__FAST_GROUP];
    crv__fast_place places[CRV__FAST_MOST_SAMPLES];
    for (int32_t i = 0; i < 3; i++)
        crv__span_split(crv__span_read(&f->normal[i], x, y, 0, room), normal[i]);
    crv__fast_pixels at = {.frame = f, .fast = fast};
    at.ray_y = vf_set(p->orthographic ? 0 : -((float)y + 0.5f - p->cy) * p->inv_fy);
    int far = 0;
    for (int32_t px = 0; px < CRV__FAST_PHASES; px++) {
        const float *row = fast->depth + y * fast->pitch + CRV__FAST_PADDING + m;
        const float *depth = row + px * fast->segment;
        const float *const n[3] = {normal[0][px], normal[1][px], normal[2][px]};
        const int32_t phase = ((y + fast->top) & 3) * CRV__FAST_PHASES + px;
        int32_t buckets[CRV__FAST_GROUP], low, high;
        float inverses[CRV__FAST_GROUP];
        for (int32_t i = 0; i < CRV__FAST_GROUP; i += CRV__LANES)
            vf_store(result[px] + i, vf_set(1));
        far |= crv__fast_buckets(fast, p, depth, phase, buckets, inverses, &low, &high);
        while (low <= high) {
            int32_t chosen = low, top = low, next = INT32_MAX;
            if (high > low)
                chosen = crv__fast_choose(buckets, low, &top, &next);
            const crv__fast_list list =
                crv__fast_list_at(fast, f, chosen, phase, y, m, places);
            crv__fast_pass(&at, &list, depth, inverses, buckets, low, top, x + px, n, row,
                           result[px], method);
            low = next;
        }
    }
    for (int32_t i = 0; i < CRV__FAST_GROUP; i += CRV__LANES) {
        const vf parts[4] = {vf_load(result[0] + i), vf_load(result[1] + i),
                             vf_load(result[2] + i), vf_load(result[3] + i)};
        vf_join4(span + 4 * i, parts);
    }
    return far;
}

/* See crv__fast_kernel. */
CRV__INLINE int crv__fast_row(const crv__frame *f, const crv__fast *fast, int32_t y,
                              int32_t first, int32_t last, int32_t x0, int32_t width,
                              float *out, crv__fast_method method)
{
    int far = 0;
    for (int32_t group = first; group < last; group++) {
        const int32_t at = group * CRV__FAST_SPAN - fast->left - x0;
        if (at >= 0 && at + CRV__FAST_SPAN <= width) {
            far |= crv__fast_span(f, fast, y, group, out + at, method);
            continue;
        }
        float span[CRV__FAST_SPAN];
        far |= crv__fast_span(f, fast, y, group, span, method);
        for (int32_t i = at < 0 ? -at : 0; i < CRV__FAST_SPAN && at + i < width; i++)
            out[at + i] = span[i];
    }
    return far;
}

/* Defines the kernel of a method from its static function accessibility(). */
#define CRV__FAST_KERNEL(name)                                                           \
    int CRV__NAME(name##_fast)(const crv__frame *f, const crv__fast *fast, int32_t y,    \
                               int32_t first, int32_t last, int32_t x0, int32_t width,   \
                               float *out);                                              \
    int CRV__NAME(name##_fast)(const crv__frame *f, const crv__fast *fast, int32_t y,    \
                               int32_t first, int32_t last, int32_t x0, int32_t width,   \
                               float *out)                                               \
    {                                                                                    \
        return crv__fast_row(f, fast, y, first, last, x0, width, out, accessibility);    \
    }

#endif
