/* SPDX-License-Identifier: MIT */
/* filters/gauss5.c for the lanes of a vector. */
#include "cpu/kernels/block.h"

enum { REACH = 2 };

static const float BINOMIAL[REACH + 1] = {6, 4, 1};

typedef struct sums {
    vf values, weights;
} sums;

CRV__INLINE vf filter(const crv__window *w)
{
    vf sum = vf_zero(), weights = vf_zero();
    for (int32_t dy = -REACH; dy <= REACH; dy++) {
        for (int32_t dx = -REACH; dx <= REACH; dx++) {
            const crv__taps tap = crv__taps_at(w, dx, dy);
            const float binomial =
                BINOMIAL[dx < 0 ? -dx : dx] * BINOMIAL[dy < 0 ? -dy : dy];
            const vf weight = vf_where(tap.any, vf_set(binomial) * tap.likeness
                                                    / (tap.deviation + vf_set(0.125f)));
            sum = vf_fma(weight, tap.value, sum);
            weights = weights + weight;
        }
    }
    return sum / weights;
}

CRV__NOINLINE void slowly(const crv__frame *f, const crv__plane *input, int32_t x,
                          int32_t y, int32_t count, float *out)
{
    crv__filter_pixels(f, input, x, y, count, out, filter);
}

/* Adds the taps of one column of the window, `row` rows from the block's first. `level`
 * is what the centres' depths become there, binomial[] the weights by distance in rows.
 * The reciprocal's error is the same for all taps of the same deviation. A NaN, where
 * what is expected overflows, becomes the weight 0. */
CRV__INLINE void add_row(sums s[CRV__BLOCK_ROWS], const crv__limits *limits,
                         const crv__centre c[CRV__BLOCK_ROWS],
                         const vf level[CRV__BLOCK_ROWS], const vf binomial[REACH + 1],
                         const crv__texel *tap, int32_t row, int with_normals)
{
#define CENTRE(i)                                                                        \
    if (row - (i) >= -REACH && row - (i) <= REACH) {                                     \
        const vf expected = crv__block_step(level[i], c[i].slope_y, row - (i));          \
        const vf off = vf_abs(tap->depth - expected);                                    \
        vf weight = vf_rcp_rough(vf_fma(off, limits->inv_depth, vf_set(0.125f)))         \
                    * binomial[row < (i) ? (i)-row : row - (i)];                         \
        if (with_normals)                                                                \
            weight = weight * crv__block_likeness(limits, &c[i], tap);                   \
        weight = vf_max(weight, vf_zero());                                              \
        s[i].values = vf_fma(weight, tap->value, s[i].values);                           \
        s[i].weights = s[i].weights + weight;                                            \
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
    for (int32_t dx = -REACH; dx <= REACH; dx++) {
        const vf column = vf_set(BINOMIAL[dx < 0 ? -dx : dx]);
        const vf binomial[REACH + 1] = {column * vf_set(BINOMIAL[0]),
                                        column * vf_set(BINOMIAL[1]),
                                        column * vf_set(BINOMIAL[2])};
        vf level[CRV__BLOCK_ROWS];
        for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++)
            level[i] = c[i].depth + vf_set((float)dx) * c[i].slope_x;
#define ROW(row)                                                                         \
    do {                                                                                 \
        const crv__texel tap = crv__block_texel(f, input, x + dx, y + (row));            \
        add_row(s, &limits, c, level, binomial, &tap, row, with_normals);                \
    } while (0)
        ROW(-2);
        ROW(-1);
        ROW(0);
        ROW(1);
        ROW(2);
        ROW(3);
#undef ROW
    }
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++)
        crv__block_store(out, x, y + i, c[i].depth, s[i].values / s[i].weights);
}

CRV__BLOCK_FILTER(fast, block)

void CRV__NAME(gauss5)(const crv__frame *f, const crv__plane *input,
                       const crv__plane *out, crv__tile tile);
void CRV__NAME(gauss5)(const crv__frame *f, const crv__plane *input,
                       const crv__plane *out, crv__tile tile)
{
    crv__filter_pass(f, input, out, tile, CRV__BLOCK_ROWS, REACH, REACH, fast, slowly);
}
