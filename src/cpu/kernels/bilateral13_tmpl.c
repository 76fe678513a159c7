/* SPDX-License-Identifier: MIT */
/* filters/bilateral13.c for the lanes of a vector. Both passes go over a tile at once, so
 * that depth and normals come from memory once. */
#include "cpu/kernels/block.h"

enum { RADIUS = 6 };

static const float GAUSS[RADIUS + 1] = {
    1.0f, 0.94595947f, 0.80073740f, 0.60653066f, 0.41111229f, 0.24935221f, 0.13533528f};

static const float STEPS[RADIUS + 1] = {0, 1, 2, 3, 4, 5, 6};

CRV__INLINE vf filter(const crv__window *w, int32_t step_x, int32_t step_y)
{
    vf sum = vf_zero(), weights = vf_zero();
    for (int32_t k = -RADIUS; k <= RADIUS; k++) {
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

CRV__NOINLINE void across_slowly(const crv__frame *f, const crv__picture *input,
                                 int32_t plane, int32_t x, int32_t y, int32_t count,
                                 float *out)
{
    crv__filter_pixels(f, input, plane, x, y, count, out, across);
}

CRV__NOINLINE void down_slowly(const crv__frame *f, const crv__picture *input,
                               int32_t plane, int32_t x, int32_t y, int32_t count,
                               float *out)
{
    crv__filter_pixels(f, input, plane, x, y, count, out, down);
}

/* The weight of a tap but for the Gaussian: 1 - deviation is one multiply-add of the
 * difference, cut off at the limit. */
CRV__INLINE vf weigh(const crv__limits *limits, const crv__centre *c, vf expected,
                     const crv__texel *tap, int with_normals)
{
    const vf off = vf_min_abs(tap->depth - expected, limits->depth);
    const vf proximity = vf_fma(off, limits->minus_inv_depth, vf_set(1));
    return with_normals
               ? proximity * vf_max(crv__block_likeness(limits, c, tap), vf_zero())
               : proximity;
}

/* Filters along a line of texels; the strides between them, in floats, in the planes of
 * the G-buffer and in those of the values. The centre weighs 1, unless it has no normal,
 * as nonsense in the depth may make it. */
CRV__INLINE void line(const crv__block *b, const crv__limits *limits,
                      const crv__centre *c, vf slope, ptrdiff_t step,
                      ptrdiff_t value_step, const crv__block_out *out, int with_normals)
{
    const crv__texel own = crv__block_texel(b, 0, 0);
    vf weights = with_normals ? vf_max(crv__block_likeness(limits, c, &own), vf_zero())
                              : vf_set(1);
    vf values[CRV__PLANES];
    for (int32_t p = 0; p < b->planes; p++)
        values[p] = weights * own.value[p];
    for (int32_t k = 1; k <= RADIUS; k++) {
        const vf gauss = vf_set(crv__unhoisted(GAUSS)[k]);
        const vf change = vf_set(crv__unhoisted(STEPS)[k]) * slope;
        const crv__texel before = crv__block_texel(b, -k * step, -k * value_step),
                         after = crv__block_texel(b, k * step, k * value_step);
        const vf first = weigh(limits, c, c->depth - change, &before, with_normals),
                 second = weigh(limits, c, c->depth + change, &after, with_normals);
        for (int32_t p = 0; p < b->planes; p++)
            values[p] =
                vf_fma(gauss, vf_fma(first, before.value[p], second * after.value[p]),
                       values[p]);
        weights = vf_fma(gauss, first + second, weights);
    }
    crv__block_store(out, 0, b->planes, c->depth, values, weights);
}

CRV__INLINE void across_block(const crv__block *b, const crv__limits *limits,
                              const crv__block_out *out, int with_normals,
                              int with_slopes)
{
    crv__block_prefetch(b, 2); /* the tile's rows are too short to be foreseen */
    const crv__centre c = crv__block_centre(b, limits, 0, with_slopes, 1, 0);
    line(b, limits, &c, c.slope_x, 1, 1, out, with_normals);
}

CRV__INLINE void down_block(const crv__block *b, const crv__limits *limits,
                            const crv__block_out *out, int with_normals, int with_slopes)
{
    const crv__centre c = crv__block_centre(b, limits, 0, with_slopes, 0, 1);
    line(b, limits, &c, c.slope_y, b->pitch, b->value_pitch, out, with_normals);
}

CRV__BLOCK_RUN(across_run, across_block, 1)

CRV__BLOCK_RUN(down_run, down_block, 1)

static const crv__filter_ways ACROSS = {.rows = 1,
                                        .radius_x = RADIUS,
                                        .radius_y = 0,
                                        .run = across_run,
                                        .pixels = across_slowly};
static const crv__filter_ways DOWN = {
    .rows = 1, .radius_x = 0, .radius_y = RADIUS, .run = down_run, .pixels = down_slowly};

/* A part of a tile, with the rows between the passes in `room`. */
CRV__INLINE void filter_part(const crv__frame *f, const crv__picture *input,
                             const crv__picture *out, crv__tile part, float *room)
{
    const crv__plane *first = &input->accessibility;
    const int32_t bottom = first->y0 + first->height, width = part.x1 - part.x0;
    const int32_t planes = crv__planes_of(input);
    crv__tile wide = part;
    wide.y0 = part.y0 - RADIUS > first->y0 ? part.y0 - RADIUS : first->y0;
    wide.y1 = part.y1 + RADIUS < bottom ? part.y1 + RADIUS : bottom;
    const int32_t pitch = CRV__FILTER_TILE_WIDTH / planes, height = wide.y1 - wide.y0;
    crv__picture between = {
        .accessibility = {room, pitch, part.x0, wide.y0, width, height}};
    for (int32_t i = 1; i < planes; i++) {
        between.bent[i - 1] = between.accessibility;
        between.bent[i - 1].data = room + (ptrdiff_t)i * pitch * height;
    }
    crv__filter_pass(f, input, &between, planes, wide, &ACROSS);
    crv__filter_pass(f, &between, out, planes, part, &DOWN);
}

void CRV__NAME(bilateral13)(const crv__frame *f, const crv__picture *input,
                            const crv__picture *out, crv__tile tile);
void CRV__NAME(bilateral13)(const crv__frame *f, const crv__picture *input,
                            const crv__picture *out, crv__tile tile)
{
    enum { PITCH = CRV__FILTER_TILE_WIDTH, ROWS = CRV__FILTER_TILE_HEIGHT + 2 * RADIUS };
    _Alignas(64) float room[ROWS * PITCH];
    const int32_t width = PITCH / crv__planes_of(input); /* of what has room */
    for (int32_t x = tile.x0; x < tile.x1; x += width) {
        crv__tile part = tile;
        part.x0 = x;
        part.x1 = x + width < tile.x1 ? x + width : tile.x1;
        filter_part(f, input, out, part, room);
    }
}
