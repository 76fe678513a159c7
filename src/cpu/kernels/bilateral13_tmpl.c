/* SPDX-License-Identifier: MIT */
/* filters/bilateral13.c for the lanes of a vector. Both passes go over a tile at once, so
 * that depth and normals come from memory once. */
#include "cpu/kernels/block.h"

enum { REACH = 6 };

static const float GAUSS[REACH + 1] = {1.0f,        0.94595947f, 0.80073740f, 0.60653066f,
                                       0.41111229f, 0.24935221f, 0.13533528f};

typedef struct sums {
    vf values, weights;
} sums;

CRV__INLINE vf filter(const crv__window *w, int32_t step_x, int32_t step_y)
{
    vf sum = vf_zero(), weights = vf_zero();
    for (int32_t k = -REACH; k <= REACH; k++) {
        const crv__taps tap = crv__taps_at(w, k * step_x, k * step_y);
        const vf proximity = vf_max(vf_set(1) - tap.deviation, vf_zero());
        const vf weight = vf_set(GAUSS[k < 0 ? -k : k]) * proximity * tap.likeness;
        sum = vf_fma(weight, tap.value, sum);
        weights = weights + weight;
    }
    return sum / weights;
}

CRV__INLINE vf across(const crv__window *w)
{
    return filter(w, 1, 0);
}

CRV__INLINE vf down(const crv__window *w)
{
    return filter(w, 0, 1);
}

CRV__NOINLINE void across_slowly(const crv__frame *f, const crv__plane *input, int32_t x,
                                 int32_t y, int32_t count, float *out)
{
    crv__filter_pixels(f, input, x, y, count, out, across);
}

CRV__NOINLINE void down_slowly(const crv__frame *f, const crv__plane *input, int32_t x,
                               int32_t y, int32_t count, float *out)
{
    crv__filter_pixels(f, input, x, y, count, out, down);
}

/* Adds the tap k pixels from the centre, where `slope` is the depth's. The weight
 * gauss * (1 - deviation) is one multiply-add of the difference, cut off at the limit. */
CRV__INLINE void add(sums *s, const crv__limits *limits, const crv__centre *c, vf slope,
                     const crv__texel *tap, int32_t k, int with_normals)
{
    const float gauss = GAUSS[k < 0 ? -k : k];
    const vf expected = crv__block_step(c->depth, slope, k);
    const vf off = vf_min(vf_abs(tap->depth - expected), limits->depth);
    vf weight = vf_fma(off, limits->inv_depth * vf_set(-gauss), vf_set(gauss));
    if (with_normals)
        weight = weight * vf_max(crv__block_likeness(limits, c, tap), vf_zero());
    s->values = vf_fma(weight, tap->value, s->values);
    s->weights = s->weights + weight;
}

/* The centre weighs 1, unless it has no normal, as nonsense in the depth may make it. */
CRV__INLINE sums begin(const crv__frame *f, const crv__plane *input,
                       const crv__limits *limits, const crv__centre *c, int32_t x,
                       int32_t y, int with_normals)
{
    const crv__texel own = crv__block_texel(f, input, x, y);
    const vf weight = with_normals
                          ? vf_max(crv__block_likeness(limits, c, &own), vf_zero())
                          : vf_set(1);
    return (sums){weight * own.value, weight};
}

CRV__INLINE void across_block(const crv__frame *f, const crv__plane *input,
                              const crv__plane *out, int32_t x, int32_t y,
                              int with_normals)
{
    const crv__limits limits = crv__limits_of(f->params);
    const crv__centre c = crv__block_centre(f, &limits, x, y, 1, 0);
    sums s = begin(f, input, &limits, &c, x, y, with_normals);
#define TAP(k)                                                                           \
    do {                                                                                 \
        const crv__texel tap = crv__block_texel(f, input, x + (k), y);                   \
        add(&s, &limits, &c, c.slope_x, &tap, k, with_normals);                          \
    } while (0)
    TAP(-6);
    TAP(-5);
    TAP(-4);
    TAP(-3);
    TAP(-2);
    TAP(-1);
    TAP(1);
    TAP(2);
    TAP(3);
    TAP(4);
    TAP(5);
    TAP(6);
#undef TAP
    crv__block_store(out, x, y, c.depth, s.values / s.weights);
}

/* The tap `row` rows above or below the first of the block's, to all that reach it. */
CRV__INLINE void add_row(sums s[CRV__BLOCK_ROWS], const crv__frame *f,
                         const crv__plane *input, const crv__limits *limits,
                         const crv__centre c[CRV__BLOCK_ROWS], int32_t x, int32_t y,
                         int32_t row, int with_normals)
{
    const crv__texel tap = crv__block_texel(f, input, x, y + row);
#define CENTRE(i)                                                                        \
    if (row - (i) >= -REACH && row - (i) <= REACH && row != (i))                         \
    add(&s[i], limits, &c[i], c[i].slope_y, &tap, row - (i), with_normals)
    CENTRE(0);
    CENTRE(1);
#undef CENTRE
}

CRV__INLINE void down_block(const crv__frame *f, const crv__plane *input,
                            const crv__plane *out, int32_t x, int32_t y, int with_normals)
{
    const crv__limits limits = crv__limits_of(f->params);
    crv__centre c[CRV__BLOCK_ROWS];
    sums s[CRV__BLOCK_ROWS];
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++) {
        c[i] = crv__block_centre(f, &limits, x, y + i, 0, 1);
        s[i] = begin(f, input, &limits, &c[i], x, y + i, with_normals);
    }
#define ROW(row) add_row(s, f, input, &limits, c, x, y, row, with_normals)
    ROW(-6);
    ROW(-5);
    ROW(-4);
    ROW(-3);
    ROW(-2);
    ROW(-1);
    ROW(0);
    ROW(1);
    ROW(2);
    ROW(3);
    ROW(4);
    ROW(5);
    ROW(6);
    ROW(7);
#undef ROW
    for (int32_t i = 0; i < CRV__BLOCK_ROWS; i++)
        crv__block_store(out, x, y + i, c[i].depth, s[i].values / s[i].weights);
}

CRV__BLOCK_FILTER(across_fast, across_block)

CRV__BLOCK_FILTER(down_fast, down_block)

void CRV__NAME(bilateral13)(const crv__frame *f, const crv__plane *input,
                            const crv__plane *out, crv__tile tile);
void CRV__NAME(bilateral13)(const crv__frame *f, const crv__plane *input,
                            const crv__plane *out, crv__tile tile)
{
    enum { PITCH = CRV__FILTER_TILE_WIDTH, ROWS = CRV__FILTER_TILE_HEIGHT + 2 * REACH };
    _Alignas(64) float rows[ROWS * PITCH];
    const int32_t bottom = input->y0 + input->height;
    crv__tile wide = tile;
    wide.y0 = tile.y0 - REACH > input->y0 ? tile.y0 - REACH : input->y0;
    wide.y1 = tile.y1 + REACH < bottom ? tile.y1 + REACH : bottom;
    const crv__plane between = {
        rows, PITCH, tile.x0, wide.y0, tile.x1 - tile.x0, wide.y1 - wide.y0};
    crv__filter_pass(f, input, &between, wide, 1, REACH, 0, across_fast, across_slowly);
    crv__filter_pass(f, &between, out, tile, CRV__BLOCK_ROWS, 0, REACH, down_fast,
                     down_slowly);
}
