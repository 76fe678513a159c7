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
    vf depth, value[CRV__PLANES];
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

/* What a block reads, from its first pixel on: depth, normals and the planes to filter.
 * Depth and normals have rows of one length: they are planes of one G-buffer. */
typedef struct crv__block {
    const float *depth, *normal[3], *value[CRV__PLANES];
    ptrdiff_t pitch, value_pitch;
    int32_t planes; /* 1 or CRV__PLANES */
} crv__block;

/* Where a block's results go. */
typedef struct crv__block_out {
    float *plane[CRV__PLANES];
    ptrdiff_t pitch;
} crv__block_out;

CRV__INLINE crv__block crv__block_at(const crv__frame *f, const crv__picture *input,
                                     int32_t planes, int32_t x, int32_t y)
{
    crv__block b = {.depth = crv__plane_at(&f->depth[0], x, y),
                    .pitch = f->depth[0].pitch,
                    .value_pitch = input->accessibility.pitch,
                    .planes = planes};
    for (int32_t i = 0; i < 3; i++)
        b.normal[i] = crv__plane_at(&f->normal[i], x, y);
    for (int32_t i = 0; i < planes; i++)
        b.value[i] = crv__plane_at(crv__plane_of(input, i), x, y);
    return b;
}

CRV__INLINE crv__block_out crv__block_out_at(const crv__picture *out, int32_t planes,
                                             int32_t x, int32_t y)
{
    crv__block_out o = {.pitch = out->accessibility.pitch};
    for (int32_t i = 0; i < planes; i++)
        o.plane[i] = crv__plane_at(crv__plane_of(out, i), x, y);
    return o;
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

/* The texels `at` floats from the block's, `value_at` in the planes to filter. */
CRV__INLINE crv__texel crv__block_texel(const crv__block *b, ptrdiff_t at,
                                        ptrdiff_t value_at)
{
    crv__texel texel = {.depth = vf_load(b->depth + at),
                        .normal = {vf_load(b->normal[0] + at), vf_load(b->normal[1] + at),
                                   vf_load(b->normal[2] + at)}};
    for (int32_t i = 0; i < b->planes; i++)
        texel.value[i] = vf_load(b->value[i] + value_at);
    return texel;
}

/* Prefetches what the same block `rows` rows further down will read. */
CRV__INLINE void crv__block_prefetch(const crv__block *b, int32_t rows)
{
    __builtin_prefetch(b->depth + rows * b->pitch);
    for (int32_t i = 0; i < b->planes; i++)
        __builtin_prefetch(b->value[i] + rows * b->value_pitch);
    for (int32_t i = 0; i < 3; i++)
        __builtin_prefetch(b->normal[i] + rows * b->pitch);
}

/* Moves by rows and columns. */
CRV__INLINE void crv__block_move(crv__block *b, int32_t rows, int32_t columns)
{
    b->depth += rows * b->pitch + columns;
    for (int32_t i = 0; i < b->planes; i++)
        b->value[i] += rows * b->value_pitch + columns;
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

/* The means of values in a row of a block. */
CRV__INLINE void crv__block_store(const crv__block_out *out, int32_t row, int32_t planes,
                                  vf depth, const vf values[], vf weights)
{
    for (int32_t i = 0; i < planes; i++)
        vf_store(out->plane[i] + row * out->pitch,
                 crv__filter_result(depth, values[i] / weights, i));
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
    void (*run)(const crv__frame *f, const crv__block *first, int32_t count,
                const crv__block_out *out);
    void (*pixels)(const crv__frame *f, const crv__picture *input, int32_t plane,
                   int32_t x, int32_t y, int32_t count, float *out);
} crv__filter_ways;

/* Defines the run `name` of block(block, limits, out, with_normals, with_slopes),
 * compiled for what is mostly asked for and for all else. */
#define CRV__BLOCK_RUN(name, block, rows)                                                \
    CRV__INLINE void name##_blocks(const crv__frame *f, const crv__block *first,         \
                                   int32_t count, const crv__block_out *to,              \
                                   int32_t planes, int with_normals, int with_slopes)    \
    {                                                                                    \
        const crv__limits limits = crv__limits_of(f->params);                            \
        crv__block b = *first;                                                           \
        crv__block_out out = *to;                                                        \
        b.planes = planes;                                                               \
        for (int32_t i = 0; i < count; i++) {                                            \
            if (!crv__block_is_empty(&b, rows)) {                                        \
                block(&b, &limits, &out, with_normals, with_slopes);                     \
            } else {                                                                     \
                for (int32_t k = 0; k < (rows)*planes; k++)                              \
                    vf_store(out.plane[k / (rows)] + k % (rows)*out.pitch,               \
                             vf_set(k < (rows) ? 1 : 0));                                \
            }                                                                            \
            crv__block_move(&b, 0, CRV__LANES);                                          \
            for (int32_t k = 0; k < planes; k++)                                         \
                out.plane[k] += CRV__LANES;                                              \
        }                                                                                \
    }                                                                                    \
    CRV__NOINLINE void name(const crv__frame *f, const crv__block *first, int32_t count, \
                            const crv__block_out *out)                                   \
    {                                                                                    \
        const int slopes = f->params->filter_slope;                                      \
        if (first->planes > 1)                                                           \
            name##_blocks(f, first, count, out, CRV__PLANES, 1, slopes);                 \
        else if (f->params->filter_normal > 0 && slopes)                                 \
            name##_blocks(f, first, count, out, 1, 1, 1);                                \
        else if (f->params->filter_normal > 0)                                           \
            name##_blocks(f, first, count, out, 1, 1, 0);                                \
        else                                                                             \
            name##_blocks(f, first, count, out, 1, 0, slopes);                           \
    }

enum {
    CRV__EDGE_RADIUS = 6, /* of any filter */
    CRV__EDGE_LEFT = 16,  /* as much or more, and the block stays aligned */
    CRV__EDGE_PITCH = 2 * CRV__EDGE_LEFT + CRV__LANES,
    CRV__EDGE_ROWS = CRV__BLOCK_ROWS + 2 * CRV__EDGE_RADIUS
};

/* A block of its own with background around the input. */
typedef struct crv__edge {
    _Alignas(64) float plane[4 + CRV__PLANES][CRV__EDGE_ROWS][CRV__EDGE_PITCH];
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
CRV__NOINLINE void crv__edge_run(const crv__frame *f, const crv__picture *input,
                                 const crv__picture *out, int32_t planes, int32_t x,
                                 int32_t y, int32_t rows, int32_t count,
                                 const crv__filter_ways *ways)
{
    crv__edge edge;
    float result[CRV__PLANES][CRV__BLOCK_ROWS * CRV__LANES];
    crv__block b = {
        .pitch = CRV__EDGE_PITCH, .value_pitch = CRV__EDGE_PITCH, .planes = planes};
    crv__block_out to = {.pitch = CRV__LANES};
    const float *starts[4 + CRV__PLANES];
    for (int32_t i = 0; i < 4 + planes; i++) {
        const crv__plane *from = i == 0  ? &f->depth[0]
                                 : i < 4 ? &f->normal[i - 1]
                                         : crv__plane_of(input, i - 4);
        for (int32_t k = 0; k < ways->rows + 2 * ways->radius_y; k++)
            crv__edge_copy(from, x - CRV__EDGE_LEFT, y - ways->radius_y + k,
                           i == 0 ? INFINITY : 0, edge.plane[i][k]);
        starts[i] = &edge.plane[i][ways->radius_y][CRV__EDGE_LEFT];
    }
    b.depth = starts[0];
    for (int32_t i = 0; i < 3; i++)
        b.normal[i] = starts[1 + i];
    for (int32_t i = 0; i < planes; i++) {
        b.value[i] = starts[4 + i];
        to.plane[i] = result[i];
    }
    ways->run(f, &b, 1, &to);
    for (int32_t i = 0; i < rows * planes; i++) {
        const int32_t row = i % rows, plane = i / rows;
        vf_store_n(crv__plane_at(crv__plane_of(out, plane), x, y + row),
                   vf_load(result[plane] + row * CRV__LANES), count);
    }
}

/* One pass over a rectangle, of the first `planes` planes. */
CRV__INLINE void crv__filter_pass(const crv__frame *f, const crv__picture *from,
                                  const crv__picture *to, int32_t planes, crv__tile r,
                                  const crv__filter_ways *ways)
{
    const crv__plane *input = &from->accessibility;
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
            const crv__block b = crv__block_at(f, from, planes, first, y);
            const crv__block_out out = crv__block_out_at(to, planes, first, y);
            ways->run(f, &b, count, &out);
        }
        for (int32_t x = r.x0; x < r.x1; x += CRV__LANES) {
            if (whole && x == first)
                x = last;
            if (x >= r.x1)
                break;
            const int32_t n = r.x1 - x < CRV__LANES ? r.x1 - x : CRV__LANES;
            if (!careful && crv__edge_is_outer(&f->depth[0], input, x, y, ways)) {
                crv__edge_run(f, from, to, planes, x, y, rows, n, ways);
                continue;
            }
            for (int32_t i = 0; i < rows * planes; i++) {
                const int32_t row = y + i % rows, plane = i / rows;
                ways->pixels(f, from, plane, x, row, n,
                             crv__plane_at(crv__plane_of(to, plane), x, row));
            }
        }
    }
}

CRV__INLINE int32_t crv__planes_of(const crv__picture *picture)
{
    return picture->bent[0].data ? CRV__PLANES : 1;
}

#endif
