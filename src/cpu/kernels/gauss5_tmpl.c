/* SPDX-License-Identifier: MIT */
/* filters/gauss5.c for the lanes of a vector. */
#include "cpu/kernels/block.h"

enum { RADIUS = 2 };

/* By distances in columns and rows. */
static const float BINOMIAL[(RADIUS + 1) * (RADIUS + 1)] = {36, 24, 6, 24, 16,
                                                            4,  6,  4, 1};

typedef struct sums {
    vf values[CRV__PLANES], weights;
} sums;

CRV__INLINE vf filter(const crv__window *w)
{
    vf sum = vf_zero(), weights = vf_zero();
    for (int32_t dy = -RADIUS; dy <= RADIUS; dy++) {
        for (int32_t dx = -RADIUS; dx <= RADIUS; dx++) {
            const crv__taps tap = crv__taps_at(w, dx, dy);
            const float binomial =
                BINOMIAL[(dx < 0 ? -dx : dx) * (RADIUS + 1) + (dy < 0 ? -dy : dy)];
            const vf weight = vf_where(tap.any, vf_set(binomial) * tap.likeness
                                                    / (tap.deviation + vf_set(0.125f)));
            sum = vf_fma(weight, tap.value, sum);
            weights = weights + weight;
        }
    }
    return sum / weights;
}

CRV__NOINLINE void slowly(const crv__frame *f, const crv__picture *input, int32_t plane,
                          int32_t x, int32_t y, int32_t count, float *out)
{
    crv__filter_pixels(f, input, plane, x, y, count, out, filter);
}

/* Adds the tap of a column to all whose windows hold its row, counted from the block's
 * first. `level` is what the centres' depths become in that column, binomial[] its
 * weights by distance in rows. The reciprocal's error is the same for all taps of the
 * same deviation. A NaN, where what is expected overflows, becomes the weight 0. */
CRV__INLINE void add_tap(sums s[CRV__BLOCK_ROWS], const crv__limits *limits,
                         const crv__centre c[CRV__BLOCK_ROWS],
                         const vf level[CRV__BLOCK_ROWS], const float *binomial,
                         crv__block *at, int32_t row, int with_normals)
{
    const crv__texel tap = crv__block_texel(at, 0, 0);
#define CENTRE(i)                                                                        \
    do {                                                                                 \
        const int32_t dy = row - (i);                                                    \
        if (dy >= -RADIUS && dy <= RADIUS) {                                             \
            const vf expected = crv__block_step(level[i], c[i].slope_y, dy);             \
            const vf off = vf_abs(tap.depth - expected);                                 \
            vf weight = vf_rcp_rough(vf_fma(off, limits->inv_depth, vf_set(0.125f)))     \
                        * vf_set(binomial[dy < 0 ? -dy : dy]);                           \
            if (with_normals)                                                            \
                weight = weight * crv__block_likeness(limits, &c[i], &tap);              \
            weight = vf_max(weight, vf_zero());                                          \
            for (int32_t p = 0; p < at->planes; p++)                                     \
                s[i].values[p] = vf_fma(weight, tap.value[p], s[i].values[p]);           \
            s[i].weights = s[i].weights + weight;                                        \
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
    const float *binomial = crv__unhoisted(BINOMIAL) + (RADIUS + 1) * (dx < 0 ? -dx : dx);
    add_tap(s, limits, c, level, binomial, at, -2, with_normals);
    add_tap(s, limits, c, level, binomial, at, -1, with_normals);
    add_tap(s, limits, c, level, binomial, at, 0, with_normals);
    add_tap(s, limits, c, level, binomial, at, 1, with_normals);
    add_tap(s, limits, c, level, binomial, at, 2, with_normals);
    add_tap(s, limits, c, level, binomial, at, 3, with_normals);
    crv__block_move(at, -RADIUS - RADIUS - CRV__BLOCK_ROWS, 1);
}

CRV__INLINE void block(const crv__block *b, const crv__limits *limits,
                       const crv__block_out *out, int with_normals, int with_slopes)
{
    crv__centre c[CRV__BLOCK_ROWS];
    sums s[CRV__BLOCK_ROWS];
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++) {
        c[i] = crv__block_centre(b, limits, i, with_slopes, 1, 1);
        s[i].weights = vf_zero();
        for (int32_t p = 0; p < b->planes; p++)
            s[i].values[p] = vf_zero();
    }
    crv__block at = *b;
    crv__block_move(&at, -RADIUS, -RADIUS);
    add_column(s, limits, c, &at, -2, with_normals);
    add_column(s, limits, c, &at, -1, with_normals);
    add_column(s, limits, c, &at, 0, with_normals);
    add_column(s, limits, c, &at, 1, with_normals);
    add_column(s, limits, c, &at, 2, with_normals);
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++)
        crv__block_store(out, i, b->planes, c[i].depth, s[i].values, s[i].weights);
}

CRV__BLOCK_RUN(run, block, CRV__BLOCK_ROWS)

static const crv__filter_ways WAYS = {.rows = CRV__BLOCK_ROWS,
                                      .radius_x = RADIUS,
                                      .radius_y = RADIUS,
                                      .run = run,
                                      .pixels = slowly};

void CRV__NAME(gauss5)(const crv__frame *f, const crv__picture *input,
                       const crv__picture *out, crv__tile tile);
void CRV__NAME(gauss5)(const crv__frame *f, const crv__picture *input,
                       const crv__picture *out, crv__tile tile)
{
    crv__filter_pass(f, input, out, crv__planes_of(input), tile, &WAYS);
}
