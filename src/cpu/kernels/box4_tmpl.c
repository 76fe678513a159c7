/* SPDX-License-Identifier: MIT */
/* filters/box4.c for the lanes of a vector. */
#include "cpu/kernels/block.h"

enum { FIRST = -2, LAST = 1 };

typedef struct sums {
    vf values, count;
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

CRV__NOINLINE void slowly(const crv__frame *f, const crv__plane *input, int32_t x,
                          int32_t y, int32_t count, float *out)
{
    crv__filter_pixels(f, input, x, y, count, out, filter);
}

/* Adds the taps of one column of the window, `row` rows from the block's first. `level`
 * is what the centres' depths become there. */
CRV__INLINE void add_row(sums s[CRV__BLOCK_ROWS], const crv__limits *limits,
                         const crv__centre c[CRV__BLOCK_ROWS],
                         const vf level[CRV__BLOCK_ROWS], const crv__texel *tap,
                         int32_t row, int with_normals)
{
#define CENTRE(i)                                                                        \
    if (row - (i) >= FIRST && row - (i) <= LAST) {                                       \
        const vf expected = crv__block_step(level[i], c[i].slope_y, row - (i));          \
        vm in = vf_le(vf_abs(tap->depth - expected), limits->depth);                     \
        if (with_normals)                                                                \
            in = vm_and(in, vf_lt(vf_zero(), crv__block_likeness(limits, &c[i], tap)));  \
        s[i].values = s[i].values + vf_where(in, tap->value);                            \
        s[i].count = s[i].count + vf_where(in, vf_set(1));                               \
    }
    CENTRE(0)
    CENTRE(1)
#undef CENTRE
}

CRV__INLINE void block(const crv__frame *f, const crv__plane *input,
                       const crv__plane *out, int32_t x, int32_t y, int with_normals)
{
    const crv__limits limits = crv__limits_of(f->params);
    crv__centre c[CRV__BLOCK_ROWS];
    sums s[CRV__BLOCK_ROWS];
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++) {
        c[i] = crv__block_centre(f, &limits, x, y + i, 1, 1);
        s[i] = (sums){vf_zero(), vf_zero()};
    }
    for (int32_t dx = FIRST; dx <= LAST; dx++) {
        vf level[CRV__BLOCK_ROWS];
        for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++)
            level[i] = c[i].depth + vf_set((float)dx) * c[i].slope_x;
#define ROW(row)                                                                         \
    do {                                                                                 \
        const crv__texel tap = crv__block_texel(f, input, x + dx, y + (row));            \
        add_row(s, &limits, c, level, &tap, row, with_normals);                          \
    } while (0)
        ROW(-2);
        ROW(-1);
        ROW(0);
        ROW(1);
        ROW(2);
#undef ROW
    }
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++)
        crv__block_store(out, x, y + i, c[i].depth, s[i].values / s[i].count);
}

CRV__BLOCK_FILTER(fast, block)

void CRV__NAME(box4)(const crv__frame *f, const crv__plane *input, const crv__plane *out,
                     crv__tile tile);
void CRV__NAME(box4)(const crv__frame *f, const crv__plane *input, const crv__plane *out,
                     crv__tile tile)
{
    crv__filter_pass(f, input, out, tile, CRV__BLOCK_ROWS, -FIRST, -FIRST, fast, slowly);
}
