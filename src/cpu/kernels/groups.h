/* SPDX-License-Identifier: MIT */
/* Runs a method's deinterleaved kernel over the groups of a tile (deinterleaved.h). */
#ifndef CRV_CPU_KERNELS_GROUPS_H
#define CRV_CPU_KERNELS_GROUPS_H

#include "cpu/kernels/deinterleaved.h"
#include "cpu/kernels/lanes.h"

typedef struct crv__list {
    const crv__sample *samples;
    const crv__sample_place *places;
    const uint16_t *counts;
    float radius;
} crv__list;

/* Some lanes of a group, a vector of them. */
typedef struct crv__group_pixels {
    const crv__frame *frame;
    const crv__deinterleaved *di;
    const float *own;  /* their place in layer 0 */
    int32_t y, m, px;  /* the group's row, and column and phase in its plane */
    int32_t at_border; /* whether samples may be off the picture */
    int32_t off;       /* where those are then, from `own` on */
    int32_t left;      /* column of the first lane, four to the next */
    vi x;              /* columns */
    vf depth, inverse; /* planar depth, and 1 over it */
    vf ray_x, ray_y;   /* the view ray (x, y, -1), or (0, 0, -1) */
    crv__v3 n;
} crv__group_pixels;

/* CRV__GROUP_SPAN floats of a plane's row from x on, which may leave the plane; `fill`
 * there. Lands in `room` or is read where it is. Asks for those `ahead` floats
 * on; 0: does not. */
CRV__INLINE const float *crv__span_read(const crv__plane *plane, int32_t x, int32_t y,
                                        float fill, float *room, ptrdiff_t ahead)
{
    const float *row = crv__plane_at(plane, plane->x0, y);
    const int32_t at = x - plane->x0;
    if (at >= 0 && at + CRV__GROUP_SPAN <= plane->width) {
        for (int32_t i = 0; ahead > 0 && i < CRV__GROUP_SPAN; i += CRV__GROUP_PIXELS)
            __builtin_prefetch(row + at + ahead + i);
        return row + at;
    }
    for (int32_t i = 0; i < CRV__GROUP_SPAN; i++)
        room[i] = at + i >= 0 && at + i < plane->width ? row[at + i] : fill;
    return room;
}

/* Of 4 * CRV__LANES floats every fourth from `phase` on. */
CRV__INLINE vf crv__span_pick(const float *from, int32_t phase)
{
    vf parts[4];
    vf_split4(from, parts);
    return parts[phase];
}

/* The list of a bucket for a phase; sets whether its samples may be off the picture. */
CRV__INLINE crv__list crv__list_at(crv__group_pixels *at, int32_t bucket, int32_t phase)
{
    const crv__deinterleaved *di = at->di;
    const int32_t index = bucket * CRV__PHASES * CRV__PHASES + phase;
    const ptrdiff_t first = (ptrdiff_t)index * (di->slices * di->steps);
    const crv__list_footprint footprint = di->footprints[index];
    at->at_border = at->y < footprint.rows
                    || at->y + footprint.rows >= at->frame->params->height
                    || at->m + footprint.shift_min <= -CRV__GROUP_PIXELS
                    || at->m + footprint.shift_max >= di->columns;
    if (di->extends) /* one lane off the picture is enough */
        at->at_border |= at->m + footprint.shift_min <= di->left / CRV__PHASES
                         || at->m + CRV__GROUP_PIXELS + footprint.shift_max
                                >= (di->left + at->frame->params->width) / CRV__PHASES;
    return (crv__list){di->samples + first, di->places + first,
                       di->counts + (ptrdiff_t)index * di->slices, footprint.radius};
}

/* The least lane that is over `limit`, INT32_MAX where there is none. */
CRV__INLINE int32_t crv__least_lane(vi a, int32_t limit)
{
    /* How beyond below the most that an integer holds: what does not count comes out as
     * 0.
     */
    const vi most = vi_set(INT32_MAX);
    const vi counts = vi_select(vi_lt(vi_set(limit), a), a, most);
    return INT32_MAX - vi_largest(vi_sub(most, counts));
}

/* A bucket for the lanes from bucket `low` on, which is the lowest of those left, and how
 * high its lanes may be: three buckets share the middle one, two the one that has more
 * lanes. *next: the lowest bucket beyond, INT32_MAX where there is none. */
CRV__INLINE int32_t crv__group_choose(const int32_t *buckets, int32_t low, int32_t *high,
                                      int32_t *next)
{
    int32_t lowest = 0, above = 0, third = 0, beyond = INT32_MAX;
    for (int32_t i = 0; i < CRV__GROUP_PIXELS; i += CRV__LANES) {
        const vi own = vi_load(buckets + i);
        const int32_t least = crv__least_lane(own, low + 2);
        lowest += vm_count(vi_eq(own, vi_set(low)));
        above += vm_count(vi_eq(own, vi_set(low + 1)));
        third |= vm_any(vi_eq(own, vi_set(low + 2)));
        beyond = least < beyond ? least : beyond;
    }
    *high = low + 2;
    *next = beyond;
    return third || above > lowest ? low + 1 : low;
}

/* Where lanes have a sample, or the one opposite to it. Off the picture: background. */
CRV__INLINE const float *crv__sample_at(const crv__group_pixels *at,
                                        const crv__sample_place *place, int32_t side,
                                        int32_t at_border)
{
    int32_t offset = place->offset[side];
    if (at_border) {
        const int32_t v = at->y + (side ? -place->dv : place->dv);
        const int32_t u = at->m + place->shift[side] + CRV__GROUP_PIXELS - 1;
        const int32_t columns = at->di->columns + CRV__GROUP_PIXELS - 1;
        const int on = ((uint32_t)v < (uint32_t)at->frame->params->height)
                       & ((uint32_t)u < (uint32_t)columns);
        offset = at->off + ((offset - at->off) & -on); /* no branch to mispredict */
    }
    return at->own + offset;
}

/* Lanes' depths of a sample. The phase's next group will read the next line and, in a
 * row's time, the group below it the one that is a row on: asking for them now, the
 * latter for the second level, hides misses. */
CRV__INLINE vf crv__sample_depth(const crv__group_pixels *at, const float *from)
{
    __builtin_prefetch(from + 31);
    __builtin_prefetch(from + at->di->pitch + 15, 0, 2);
    return vf_load(from);
}

/* Accessibility; of kernels that give bent normals, those as well. */
typedef vf (*crv__group_method)(const crv__group_pixels *pixels, const crv__list *list);
typedef vf (*crv__group_bent_method)(const crv__group_pixels *pixels,
                                     const crv__list *list, crv__v3 *bent);

/* Either of them, and how many planes it fills: accessibility alone, or the bent normal's
 * components as well. */
typedef struct crv__group_kernel {
    crv__group_method method;
    crv__group_bent_method bent_method;
    int32_t planes;
} crv__group_kernel;

enum { CRV__GROUP_PLANES = 4 }; /* at most */

/* What is known of a group before its samples are read. */
typedef struct crv__group {
    float inverses[CRV__GROUP_PIXELS]; /* 1 over the depths */
    /* of each lane; -1 without a surface, and beyond the table */
    int32_t buckets[CRV__GROUP_PIXELS];
    int32_t low, high; /* of those from 0 on; low > high where there is none */
} crv__group;

/* Returns whether there is a lane beyond the table. */
CRV__INLINE int crv__group_fill(crv__group *group, const crv__deinterleaved *di,
                                const crv__params *p, const float *depth, int32_t phase)
{
    const vf radius = vf_set(p->radius * p->fy), background = vf_set(di->background);
    const vf cap = vf_set(di->cap);
    vm beyond = vm_none();
    int32_t low = INT32_MAX, high = -1;
    for (int32_t i = 0; i < CRV__GROUP_PIXELS; i += CRV__LANES) {
        const vf d = vf_load(depth + i), inverse = vf_set(1) / d;
        const vf r = p->orthographic ? radius : radius * inverse;
        const vf capped = vf_max(vf_min(r, cap) * vf_set(di->scale[phase]),
                                 vf_set(CRV__SMALLEST_RADIUS_PX));
        const vm surface = vf_lt(d, background);
        const vm within = vf_lt(r, vf_set(di->largest));
        beyond = vm_or(beyond, vm_and(surface, vm_not(within)));
        const vi bucket =
            (vf_bits(capped) - vi_set(CRV__SMALLEST_RADIUS_BITS)) >> di->shift;
        const vi own = vi_select(vm_and(surface, within), bucket, vi_set(-1));
        vf_store(group->inverses + i, inverse);
        __builtin_memcpy(group->buckets + i, &own, sizeof own);
        const int32_t largest = vi_largest(own), least = crv__least_lane(own, -1);
        high = largest > high ? largest : high;
        low = least < low ? least : low;
    }
    group->low = low;
    group->high = high;
    return vm_any(beyond);
}

CRV__INLINE crv__v3 crv__group_normal_of(const float *const spans[3], int32_t px)
{
    return (crv__v3){crv__span_pick(spans[0], px), crv__span_pick(spans[1], px),
                     crv__span_pick(spans[2], px)};
}

/* Lanes from i on of a phase of spans. */
CRV__INLINE crv__v3 crv__group_normal(const float *const spans[3], int32_t px, int32_t i)
{
    const float *const at[3] = {spans[0] + 4 * i, spans[1] + 4 * i, spans[2] + 4 * i};
    switch (px) { /* so that each takes only its own from a span */
    case 0:
        return crv__group_normal_of(at, 0);
    case 1:
        return crv__group_normal_of(at, 1);
    case 2:
        return crv__group_normal_of(at, 2);
    default:
        return crv__group_normal_of(at, 3);
    }
}

CRV__INLINE void crv__group_store(float *to, vm mine, vf value)
{
    vf_store(to, vf_select(mine, value, vf_load(to)));
}

/* One pass over a group: the lanes whose bucket is from low to high, with one list. */
CRV__INLINE void crv__group_pass(crv__group_pixels *at, const crv__list *list,
                                 const crv__group *group, const float *depth, int32_t low,
                                 int32_t high, int32_t px,
                                 float *const results[CRV__GROUP_PLANES],
                                 crv__group_kernel kernel)
{
    const crv__params *p = at->frame->params;
    const vf one = vf_set(1), intensity = vf_set(p->intensity);
    const int32_t x = at->m * CRV__PHASES - at->di->left + px;
    float room[3][CRV__GROUP_SPAN];
    const float *normal[3];
    for (int32_t i = 0; i < 3; i++) {
        const crv__plane *plane = &at->frame->normal[i];
        normal[i] = crv__span_read(plane, x - px, at->y, 0, room[i],
                                   px == 0 ? CRV__PHASES * plane->pitch : 0);
    }
    for (int32_t i = 0; i < CRV__GROUP_PIXELS; i += CRV__LANES) {
        const vi bucket = vi_load(group->buckets + i);
        const vm mine =
            vm_and(vi_lt(vi_set(low - 1), bucket), vi_lt(bucket, vi_set(high + 1)));
        if (!vm_any(mine))
            continue;
        at->own = depth + i;
        at->depth = vf_load(depth + i);
        at->inverse = vf_load(group->inverses + i);
        at->n = crv__group_normal(normal, px, i);
        at->left = x + CRV__PHASES * i;
        at->x = vi_set(at->left) + vi_iota() * vi_set(CRV__PHASES);
        at->ray_x = p->orthographic
                        ? vf_zero()
                        : (vf_of(at->x) + vf_set(0.5f - p->cx)) * vf_set(p->inv_fx);
        crv__v3 bent;
        const vf a = kernel.bent_method ? kernel.bent_method(at, list, &bent)
                                        : kernel.method(at, list);
        const vf shown = vf_clamp01(one - intensity * (one - a));
        crv__group_store(results[0] + i, mine, shown);
        if (kernel.planes > 1) {
            crv__group_store(results[1] + i, mine, bent.x);
            crv__group_store(results[2] + i, mine, bent.y);
            crv__group_store(results[3] + i, mine, bent.z);
        }
    }
}

/* All passes that a group takes. */
CRV__INLINE void crv__group_run(crv__group_pixels *at, const crv__group *group,
                                const float *depth, int32_t px,
                                float *const results[CRV__GROUP_PLANES],
                                crv__group_kernel kernel)
{
    const int32_t phase = ((at->y + at->di->top) & 3) * CRV__PHASES + px;
    int32_t low = group->low;
    for (int32_t k = 0; k < kernel.planes; k++) {
        for (int32_t i = 0; i < CRV__GROUP_PIXELS; i += CRV__LANES)
            vf_store(results[k] + i, vf_set(k == 0 ? 1 : 0));
    }
    while (low <= group->high) {
        int32_t chosen = low, top = low, next = INT32_MAX;
        if (group->high > low)
            chosen = crv__group_choose(group->buckets, low, &top, &next);
        const crv__list list = crv__list_at(at, chosen, phase);
        crv__group_pass(at, &list, group, depth, low, top, px, results, kernel);
        low = next;
    }
}

/* A tile's results. While it is computed, a span holds its four phases one after the
 * other; those that leave the plane at its left or right are kept beside it. */
typedef struct crv__tile_out {
    const crv__plane *plane;
    float edges[2][CRV__TILE_ROWS][CRV__GROUP_SPAN];
} crv__tile_out;

/* The span whose first column is x, in row y, the tile's `row`th. */
CRV__INLINE float *crv__tile_span(crv__tile_out *out, int32_t x, int32_t y, int32_t row)
{
    const crv__plane *plane = out->plane;
    if (x < plane->x0)
        return out->edges[0][row];
    if (x + CRV__GROUP_SPAN > plane->x0 + plane->width)
        return out->edges[1][row];
    return crv__plane_at(plane, x, y);
}

/* Puts the four phases of a row's spans together. */
CRV__INLINE void crv__tile_join(const crv__deinterleaved *di, const crv__group_tile *tile,
                                crv__tile_out *out, int32_t y, int32_t row)
{
    const crv__plane *plane = out->plane;
    for (int32_t group = tile->first; group < tile->last; group++) {
        const int32_t x = group * CRV__GROUP_SPAN - di->left;
        float *span = crv__tile_span(out, x, y, row), phases[CRV__GROUP_SPAN];
        for (int32_t i = 0; i < CRV__GROUP_SPAN; i += CRV__LANES)
            vf_store(phases + i, vf_load(span + i));
        for (int32_t i = 0; i < CRV__GROUP_PIXELS; i += CRV__LANES) {
            vf parts[4];
            for (int32_t px = 0; px < 4; px++)
                parts[px] = vf_load(phases + px * CRV__GROUP_PIXELS + i);
            vf_join4(span + 4 * i, parts);
        }
        if (x >= plane->x0 && x + CRV__GROUP_SPAN <= plane->x0 + plane->width)
            continue;
        for (int32_t i = 0; i < CRV__GROUP_SPAN; i++) {
            if (x + i >= plane->x0 && x + i < plane->x0 + plane->width)
                *crv__plane_at(plane, x + i, y) = span[i];
        }
    }
}

/* The groups of one row and phase. */
CRV__INLINE int crv__tile_row(crv__group_pixels *at, const crv__group_tile *tile,
                              int32_t px, int32_t row, crv__tile_out *out,
                              crv__group_kernel kernel)
{
    const crv__params *p = at->frame->params;
    const crv__deinterleaved *di = at->di;
    const int32_t phase = ((at->y + di->top) & 3) * CRV__PHASES + px;
    const ptrdiff_t begin = crv__deinterleaved_index(di, at->y, px, 0);
    const float *depth = di->depth + begin + tile->first * CRV__GROUP_PIXELS;
    const int32_t count = tile->last - tile->first;
    crv__group groups[CRV__TILE_GROUPS];
    int beyond = 0;
    at->ray_y = vf_set(p->orthographic ? 0 : -((float)at->y + 0.5f - p->cy) * p->inv_fy);
    at->off = (int32_t)(CRV__ROW_PADDING - begin); /* the same column, before planes */
    /* All at once: one after the other they would wait for their divisions. */
    for (int32_t g = 0; g < count; g++)
        beyond |=
            crv__group_fill(&groups[g], di, p, depth + g * CRV__GROUP_PIXELS, phase);
    for (int32_t g = 0; g < count; g++) {
        at->m = (tile->first + g) * CRV__GROUP_PIXELS;
        float *spans[CRV__GROUP_PLANES];
        for (int32_t k = 0; k < kernel.planes; k++)
            spans[k] = crv__tile_span(&out[k], at->m * CRV__PHASES - di->left, at->y, row)
                       + px * CRV__GROUP_PIXELS;
        crv__group_run(at, &groups[g], depth + g * CRV__GROUP_PIXELS, px, spans, kernel);
    }
    return beyond;
}

/* See crv__deinterleaved_kernel. */
CRV__INLINE int crv__tile_run(const crv__frame *f, const crv__deinterleaved *di,
                              const crv__group_tile *tile, const crv__picture *picture,
                              crv__group_kernel kernel)
{
    crv__group_pixels at;
    crv__tile_out out[CRV__GROUP_PLANES];
    int beyond = 0;
    at.frame = f;
    at.di = di;
    for (int32_t k = 0; k < kernel.planes; k++)
        out[k].plane = k == 0 ? &picture->accessibility : &picture->bent[k - 1];
    for (int32_t px = 0; px < CRV__PHASES; px++) {
        at.px = px;
        for (int32_t y = tile->y0, row = 0; y < tile->y1; y += CRV__PHASES, row++) {
            at.y = y;
            beyond |= crv__tile_row(&at, tile, px, row, out, kernel);
        }
    }
    for (int32_t k = 0; k < kernel.planes; k++) {
        for (int32_t y = tile->y0, row = 0; y < tile->y1; y += CRV__PHASES, row++)
            crv__tile_join(di, tile, &out[k], y, row);
    }
    return beyond;
}

/* Defines a method's kernel from its static function accessibility(); what follows the
 * name are members of crv__deinterleaved_method, designated. */
#define CRV__DEINTERLEAVED_KERNEL(name, ...)                                             \
    static int run(const crv__frame *f, const crv__deinterleaved *di,                    \
                   const crv__group_tile *tile, const crv__picture *out)                 \
    {                                                                                    \
        return crv__tile_run(f, di, tile, out,                                           \
                             (crv__group_kernel){.method = accessibility, .planes = 1}); \
    }                                                                                    \
    extern const crv__deinterleaved_method CRV__NAME(name##_deinterleaved);              \
    const crv__deinterleaved_method CRV__NAME(name##_deinterleaved) = {.run = run,       \
                                                                       __VA_ARGS__};

/* Defines run_bent() from the static function estimate(), for that member; goes before
 * CRV__DEINTERLEAVED_KERNEL. */
#define CRV__DEINTERLEAVED_BENT                                                          \
    static int run_bent(const crv__frame *f, const crv__deinterleaved *di,               \
                        const crv__group_tile *tile, const crv__picture *out)            \
    {                                                                                    \
        return crv__tile_run(                                                            \
            f, di, tile, out,                                                            \
            (crv__group_kernel){.bent_method = estimate, .planes = CRV__GROUP_PLANES});  \
    }

#endif
