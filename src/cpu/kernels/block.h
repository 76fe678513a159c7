/* SPDX-License-Identifier: MIT */
/*
 * The fast path of a filter: blocks of two rows of a vector each, whose windows lie
 * within the input. What the rows read at one offset is loaded once for both, and
 * nothing is tested: the depth of background is infinite, which brings any weight to 0.
 */
#ifndef CRV_CPU_KERNELS_BLOCK_H
#define CRV_CPU_KERNELS_BLOCK_H

#include "cpu/kernels/window.h"

enum { CRV__BLOCK_ROWS = 2 }; /* four would need more registers than there are */

/* From here on the likeness is a matter of rounding: left to the general way. */
#define CRV__SHARPEST 1000.0f

/* What filters weigh neighbours by. */
typedef struct crv__limits {
    vf depth, inv_depth, minus_inv_depth;
    vf normal, likeness_base; /* likeness = normal * cosine + base */
} crv__limits;

/* A centre of each lane; `turned` is its normal times limits.normal. */
typedef struct crv__centre {
    vf depth, slope_x, slope_y;
    crv__v3 turned;
} crv__centre;

/* A tap, as it was read. */
typedef struct crv__texel {
    vf depth, value;
    crv__v3 normal;
} crv__texel;

CRV__INLINE crv__limits crv__limits_of(const crv__params *p)
{
    return (crv__limits){vf_set(p->filter_depth), vf_set(1 / p->filter_depth),
                         vf_set(-1 / p->filter_depth), vf_set(p->filter_normal),
                         vf_set(1 - p->filter_normal)};
}

/* crv__slope() from both neighbours. */
CRV__INLINE vf crv__block_slope(vf before, vf d, vf after)
{
    const vf backward = d - before, forward = after - d;
    const vf slope =
        vf_select(vf_lt(vf_abs(forward), vf_abs(backward)), forward, backward);
    return vf_where(vf_lt(vf_abs(slope), vf_set(CRV_STEEPEST_SLOPE)), slope);
}

/* What a block reads, from its first pixel on. Depth and normals have rows of one length:
 * they are planes of one G-buffer. */
typedef struct crv__block {
    const float *depth, *normal[3], *value;
    ptrdiff_t pitch, value_pitch;
} crv__block;

CRV__INLINE crv__block crv__block_at(const crv__frame *f, const crv__plane *input,
                                     int32_t x, int32_t y)
{
    return (crv__block){crv__plane_at(&f->depth[0], x, y),
                        {crv__plane_at(&f->normal[0], x, y),
                         crv__plane_at(&f->normal[1], x, y),
                         crv__plane_at(&f->normal[2], x, y)},
                        crv__plane_at(input, x, y),
                        f->depth[0].pitch,
                        input->pitch};
}

/* To the next vector of the same rows. */
CRV__INLINE void crv__block_advance(crv__block *b)
{
    b->depth += CRV__LANES;
    b->value += CRV__LANES;
    for (int32_t i = 0; i < 3; i++)
        b->normal[i] += CRV__LANES;
}

/* The centres of a row, with the slopes along x, y or both. */
CRV__INLINE crv__centre crv__block_centre(const crv__block *b, const crv__limits *limits,
                                          int32_t row, int slope, int with_x, int with_y)
{
    const ptrdiff_t at = row * b->pitch;
    const float *depth = b->depth + at;
    crv__centre c = {.depth = vf_load(depth)};
    c.turned = (crv__v3){vf_load(b->normal[0] + at) * limits->normal,
                         vf_load(b->normal[1] + at) * limits->normal,
                         vf_load(b->normal[2] + at) * limits->normal};
    c.slope_x = c.slope_y = vf_zero();
    if (slope && with_x)
        c.slope_x = crv__block_slope(vf_load(depth - 1), c.depth, vf_load(depth + 1));
    if (slope && with_y)
        c.slope_y = crv__block_slope(vf_load(depth - b->pitch), c.depth,
                                     vf_load(depth + b->pitch));
    return c;
}

/* A table whose numbers are read where they are used: there are more of them than
 * registers. */
CRV__INLINE const float *crv__unhoisted(const float *table)
{
    __asm__ volatile("" : "+r"(table));
    return table;
}

/* The texels `offset` floats from the block's. */
CRV__INLINE crv__texel crv__block_texel(const crv__block *b, ptrdiff_t at,
                                        ptrdiff_t value_at)
{
    return (crv__texel){vf_load(b->depth + at),
                        vf_load(b->value + value_at),
                        {vf_load(b->normal[0] + at), vf_load(b->normal[1] + at),
                         vf_load(b->normal[2] + at)}};
}

/* Prefetches what the same block `rows` rows further down will read. */
CRV__INLINE void crv__block_prefetch(const crv__block *b, int32_t rows)
{
    __builtin_prefetch(b->depth + rows * b->pitch);
    __builtin_prefetch(b->value + rows * b->value_pitch);
    for (int32_t i = 0; i < 3; i++)
        __builtin_prefetch(b->normal[i] + rows * b->pitch);
}

/* Moves by rows and columns. */
CRV__INLINE void crv__block_move(crv__block *b, int32_t rows, int32_t columns)
{
    b->depth += rows * b->pitch + columns;
    b->value += rows * b->value_pitch + columns;
    for (int32_t i = 0; i < 3; i++)
        b->normal[i] += rows * b->pitch + columns;
}

/* a + steps * slope in the scalar code's rounding: beside silhouettes slopes are steep,
 * and cancel. Up to two steps the product is exact. */
CRV__INLINE vf crv__block_step(vf a, vf slope, int32_t steps)
{
    return steps == 0    ? a
           : steps == 1  ? a + slope
           : steps == -1 ? a - slope
                         : vf_fma(vf_set((float)steps), slope, a);
}

/* The cosine's part of the likeness: not cut off at 0 yet; above 1 by rounding only. */
CRV__INLINE vf crv__block_likeness(const crv__limits *limits, const crv__centre *c,
                                   const crv__texel *tap)
{
    return vf_fma(tap->normal.x, c->turned.x,
                  vf_fma(tap->normal.y, c->turned.y,
                         vf_fma(tap->normal.z, c->turned.z, limits->likeness_base)));
}

/* Background is 1. */
CRV__INLINE void crv__block_store(float *out, vf depth, vf result)
{
    const vm surface = vf_lt(depth, vf_set(INFINITY));
    vf_store(out, vf_select(surface, vf_clamp01(result), vf_set(1)));
}

CRV__INLINE int crv__block_is_empty(const crv__block *b, int32_t rows)
{
    vf nearest = vf_set(INFINITY);
    for (int32_t i = 0; i < rows; i++)
        nearest = vf_min(nearest, vf_load(b->depth + i * b->pitch));
    return !vm_any(vf_lt(nearest, vf_set(INFINITY)));
}

/* A filter's two ways: `run` for `count` blocks of `rows` rows side by side, whose
 * windows have this radius and lie within the input; `pixels` for where that cannot be.
 */
typedef struct crv__filter_ways {
    int32_t rows, radius_x, radius_y;
    void (*run)(const crv__frame *f, const crv__block *first, int32_t count, float *out,
                ptrdiff_t out_pitch);
    void (*pixels)(const crv__frame *f, const crv__plane *input, int32_t x, int32_t y,
                   int32_t count, float *out);
} crv__filter_ways;

/* Defines the run `name` of block(f, block, limits, out, out_pitch, with_normals,
 * with_slopes), compiled for what is mostly asked for and for all else. */
#define CRV__BLOCK_RUN(name, block, rows)                                                \
    CRV__INLINE void name##_blocks(const crv__frame *f, const crv__block *first,         \
                                   int32_t count, float *out, ptrdiff_t out_pitch,       \
                                   int with_normals, int with_slopes)                    \
    {                                                                                    \
        const crv__limits limits = crv__limits_of(f->params);                            \
        crv__block b = *first;                                                           \
        for (int32_t i = 0; i < count; i++, out += CRV__LANES) {                         \
            if (!crv__block_is_empty(&b, rows)) {                                        \
                block(&b, &limits, out, out_pitch, with_normals, with_slopes);           \
            } else {                                                                     \
                for (int32_t k = 0; k < (rows); k++)                                     \
                    vf_store(out + k * out_pitch, vf_set(1));                            \
            }                                                                            \
            crv__block_advance(&b);                                                      \
        }                                                                                \
    }                                                                                    \
    CRV__NOINLINE void name(const crv__frame *f, const crv__block *first, int32_t count, \
                            float *out, ptrdiff_t out_pitch)                             \
    {                                                                                    \
        const int slopes = f->params->filter_slope;                                      \
        if (f->params->filter_normal > 0 && slopes)                                      \
            name##_blocks(f, first, count, out, out_pitch, 1, 1);                        \
        else if (f->params->filter_normal > 0)                                           \
            name##_blocks(f, first, count, out, out_pitch, 1, 0);                        \
        else                                                                             \
            name##_blocks(f, first, count, out, out_pitch, 0, slopes);                   \
    }

enum {
    CRV__EDGE_RADIUS = 6, /* of any filter */
    CRV__EDGE_LEFT = 16,  /* as much or more, and the block stays aligned */
    CRV__EDGE_PITCH = 2 * CRV__EDGE_LEFT + CRV__LANES,
    CRV__EDGE_ROWS = CRV__BLOCK_ROWS + 2 * CRV__EDGE_RADIUS
};

/* A block of its own with background around the input. */
typedef struct crv__edge {
    _Alignas(64) float plane[5][CRV__EDGE_ROWS][CRV__EDGE_PITCH];
} crv__edge;

/* Copies what a row of a plane holds from column x on; `fill` beside it. */
CRV__INLINE void crv__edge_copy(const crv__plane *plane, int32_t x, int32_t y, float fill,
                                float *to)
{
    const int32_t left = plane->x0 - x, right = plane->x0 + plane->width - x;
    const int32_t first = left > 0 ? left : 0;
    const int32_t last = right < CRV__EDGE_PITCH ? right : CRV__EDGE_PITCH;
    const int inside = y >= plane->y0 && y < plane->y0 + plane->height && first < last;
    for (int32_t i = 0; i < CRV__EDGE_PITCH; i++)
        to[i] = fill;
    if (inside)
        __builtin_memcpy(to + first, crv__plane_at(plane, x + first, y),
                         (size_t)(last - first) * sizeof *to);
}

/* Whether no tap of the block is a surface that the input does not hold: what is outside
 * the input could not be told from what is outside the picture. */
CRV__INLINE int crv__edge_is_outer(const crv__plane *depth, const crv__plane *input,
                                   int32_t x, int32_t y, const crv__filter_ways *ways)
{
    const int32_t left = x - ways->radius_x, right = x + CRV__LANES + ways->radius_x;
    const int32_t top = y - ways->radius_y, bottom = y + ways->rows + ways->radius_y;
    const int32_t depth_right = depth->x0 + depth->width,
                  depth_bottom = depth->y0 + depth->height;
    const int32_t input_right = input->x0 + input->width,
                  input_bottom = input->y0 + input->height;
    return (left >= input->x0 || input->x0 == depth->x0)
           && (top >= input->y0 || input->y0 == depth->y0)
           && (right <= input_right || input_right == depth_right)
           && (bottom <= input_bottom || input_bottom == depth_bottom);
}

/* A block at the border, of `rows` rows of `count` pixels. */
CRV__NOINLINE void crv__edge_run(const crv__frame *f, const crv__plane *input,
                                 const crv__plane *out, int32_t x, int32_t y,
                                 int32_t rows, int32_t count,
                                 const crv__filter_ways *ways)
{
    crv__edge edge;
    float result[CRV__BLOCK_ROWS * CRV__LANES];
    const crv__plane *planes[5] = {&f->depth[0], input, &f->normal[0], &f->normal[1],
                                   &f->normal[2]};
    for (int32_t i = 0; i < 5; i++) {
        for (int32_t k = 0; k < ways->rows + 2 * ways->radius_y; k++)
            crv__edge_copy(planes[i], x - CRV__EDGE_LEFT, y - ways->radius_y + k,
                           i == 0 ? INFINITY : 0, edge.plane[i][k]);
    }
    const crv__block b = {&edge.plane[0][ways->radius_y][CRV__EDGE_LEFT],
                          {&edge.plane[2][ways->radius_y][CRV__EDGE_LEFT],
                           &edge.plane[3][ways->radius_y][CRV__EDGE_LEFT],
                           &edge.plane[4][ways->radius_y][CRV__EDGE_LEFT]},
                          &edge.plane[1][ways->radius_y][CRV__EDGE_LEFT],
                          CRV__EDGE_PITCH,
                          CRV__EDGE_PITCH};
    ways->run(f, &b, 1, result, CRV__LANES);
    for (int32_t i = 0; i < rows; i++)
        vf_store_n(crv__plane_at(out, x, y + i), vf_load(result + i * CRV__LANES), count);
}

/* One pass over a rectangle. */
CRV__INLINE void crv__filter_pass(const crv__frame *f, const crv__plane *input,
                                  const crv__plane *out, crv__tile r,
                                  const crv__filter_ways *ways)
{
    const int careful = f->params->filter_normal > CRV__SHARPEST;
    const int32_t right = input->x0 + input->width - ways->radius_x;
    const int32_t end = right < r.x1 ? right : r.x1;
    int32_t first = r.x0;
    while (first < input->x0 + ways->radius_x)
        first += CRV__LANES;
    const int32_t count = careful || end <= first ? 0 : (end - first) / CRV__LANES;
    const int32_t last = first + count * CRV__LANES;
    for (int32_t y = r.y0; y < r.y1; y += ways->rows) {
        const int32_t rows = r.y1 - y < ways->rows ? r.y1 - y : ways->rows;
        const int whole = count && rows == ways->rows && y - ways->radius_y >= input->y0
                          && y + ways->radius_y + rows <= input->y0 + input->height;
        if (whole) {
            const crv__block b = crv__block_at(f, input, first, y);
            ways->run(f, &b, count, crv__plane_at(out, first, y), out->pitch);
        }
        for (int32_t x = r.x0; x < r.x1; x += CRV__LANES) {
            if (whole && x == first)
                x = last;
            if (x >= r.x1)
                break;
            const int32_t n = r.x1 - x < CRV__LANES ? r.x1 - x : CRV__LANES;
            if (!careful && crv__edge_is_outer(&f->depth[0], input, x, y, ways)) {
                crv__edge_run(f, input, out, x, y, rows, n, ways);
                continue;
            }
            for (int32_t i = 0; i < rows; i++)
                ways->pixels(f, input, x, y + i, n, crv__plane_at(out, x, y + i));
        }
    }
}

#endif
