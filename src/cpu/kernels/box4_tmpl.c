/* SPDX-License-Identifier: MIT */
/* filters/box4.c for the lanes of a vector. */
#include "cpu/kernels/block.h"

enum { FIRST = -2, LAST = 1 };

typedef struct sums {
    vf values[CRV__PLANES], count;
} sums;

CRV__INLINE vf filter(const crv__window *w)
{
    const vf one = vf_set(1);
    vf sum = vf_zero(), count = vf_zero();
    for (int32_t dy = FIRST; dy <= LAST; dy++) {
        for (int32_t dx = FIRST; dx <= LAST; dx++) {
            const crv__taps tap = crv__taps_at(w, dx, dy);
            const vm in = vm_and(tap.any, vf_le(tap.deviation, one));
            sum = sum + vf_where(in, tap.value);
            count = count + vf_where(in, one);
        }
    }
    return sum / count;
}

CRV__NOINLINE void slowly(const crv__frame *f, const crv__picture *input, int32_t plane,
                          int32_t x, int32_t y, int32_t count, float *out)
{
    crv__filter_pixels(f, input, plane, x, y, count, out, filter);
}

/* Adds the tap of a column to all whose windows hold its row, counted from the block's
 * first. `level` is what the centres' depths become in that column. */
CRV__INLINE void add_tap(sums s[CRV__BLOCK_ROWS], const crv__limits *limits,
                         const crv__centre c[CRV__BLOCK_ROWS],
                         const vf level[CRV__BLOCK_ROWS], crv__block *at, int32_t row,
                         int with_normals)
{
    const crv__texel tap = crv__block_texel(at, 0, 0);
#define CENTRE(i)                                                                        \
    do {                                                                                 \
        const int32_t dy = row - (i);                                                    \
        if (dy >= FIRST && dy <= LAST) {                                                 \
            const vf expected = crv__block_step(level[i], c[i].slope_y, dy);             \
            vm in = vf_le(vf_abs(tap.depth - expected), limits->depth);                  \
            if (with_normals)                                                            \
                in = vm_and(in,                                                          \
                            vf_lt(vf_zero(), crv__block_likeness(limits, &c[i], &tap))); \
            for (int32_t p = 0; p < at->planes; p++)                                     \
                s[i].values[p] = s[i].values[p] + vf_where(in, tap.value[p]);            \
            s[i].count = s[i].count + vf_where(in, vf_set(1));                           \
        }                                                                                \
    } while (0)
    CENTRE(0);
    CENTRE(1);
#undef CENTRE
    crv__block_move(at, 1, 0);
}

CRV__INLINE void add_column(sums s[CRV__BLOCK_ROWS], const crv__limits *limits,
                            const crv__centre c[CRV__BLOCK_ROWS], crv__block *at,
                            int32_t dx, int with_normals)
{
    vf level[CRV__BLOCK_ROWS];
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++)
        level[i] = crv__block_step(c[i].depth, c[i].slope_x, dx);
    add_tap(s, limits, c, level, at, -2, with_normals);
    add_tap(s, limits, c, level, at, -1, with_normals);
    add_tap(s, limits, c, level, at, 0, with_normals);
    add_tap(s, limits, c, level, at, 1, with_normals);
    add_tap(s, limits, c, level, at, 2, with_normals);
    crv__block_move(at, FIRST - LAST - CRV__BLOCK_ROWS, 1);
}

CRV__INLINE void block(const crv__block *b, const crv__limits *limits,
                       const crv__block_out *out, int with_normals, int with_slopes)
{
    crv__centre c[CRV__BLOCK_ROWS];
    sums s[CRV__BLOCK_ROWS];
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++) {
        c[i] = crv__block_centre(b, limits, i, with_slopes, 1, 1);
        s[i].count = vf_zero();
        for (int32_t p = 0; p < b->planes; p++)
            s[i].values[p] = vf_zero();
    }
    crv__block at = *b;
    crv__block_move(&at, FIRST, FIRST);
    add_column(s, limits, c, &at, -2, with_normals);
    add_column(s, limits, c, &at, -1, with_normals);
    add_column(s, limits, c, &at, 0, with_normals);
    add_column(s, limits, c, &at, 1, with_normals);
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++)
        crv__block_store(out, i, b->planes, c[i].depth, s[i].values, s[i].count);
}

CRV__BLOCK_RUN(run, block, CRV__BLOCK_ROWS)

static const crv__filter_ways WAYS = {.rows = CRV__BLOCK_ROWS,
                                      .radius_x = -FIRST,
                                      .radius_y = -FIRST,
                                      .run = run,
                                      .pixels = slowly};

void CRV__NAME(box4)(const crv__frame *f, const crv__picture *input,
                     const crv__picture *out, crv__tile tile);
void CRV__NAME(box4)(const crv__frame *f, const crv__picture *input,
                     const crv__picture *out, crv__tile tile)
{
    crv__filter_pass(f, input, out, crv__planes_of(input), tile, &WAYS);
}
