/* SPDX-License-Identifier: MIT */
/*
 * filters/edges7.c for the lanes of a vector. Edges are computed once for each pair of
 * neighbours: those along a row when the row is filtered, those down a column as a plane
 * for the second pass. What lies outside the input reads as background, so that nothing
 * is tested at borders: an edge to what is no tap is 0.
 *
 * Of two taps an edge is LEAST or more. It tells a neighbour that is unlike from one that
 * is none, and weighs nothing beside the centre.
 */
#include "cpu/kernels/window.h"

enum {
    RADIUS = 3,
    LEFT = 16, /* as much as is read before a tile, or more; lines stay aligned */
    PITCH = LEFT + CRV__FILTER_TILE_WIDTH + LEFT,
    STRIP = CRV__FILTER_TILE_HEIGHT / 2, /* rows at once: hosts' stacks may be small */
    ROWS = STRIP + 2 * RADIUS
};

static const float LONELY = 0.07f, LEAST = 1e-9f;

/* A row of the tile with what its edges read; [LEFT] is the tile's first column. */
typedef struct row {
    const float *depth, *normal[3];
    const float *value;  /* NaN: no tap */
    const float *across; /* slope of the depth along the row */
    const float *down;   /* and to the next row */
} row;

/* Where the rows of the planes come to lie if they leave the buffers, and slopes do. */
typedef struct lines {
    _Alignas(64) float depth[PITCH], normal[3][PITCH], value[PITCH], across[PITCH],
        down[PITCH];
} lines;

/* A plane's row from column x - LEFT on, PITCH floats; `fill` beside what it holds. */
CRV__INLINE const float *line_of(const crv__plane *plane, int32_t x, int32_t y,
                                 float fill, float *line)
{
    const int32_t first = x - LEFT - plane->x0, right = plane->width - first;
    const bool is_there = y >= plane->y0 && y < plane->y0 + plane->height;
    if (is_there && first >= 0 && right >= PITCH)
        return crv__plane_at(plane, x - LEFT, y);
    const int32_t from = first < 0 ? -first : 0, to = right < PITCH ? right : PITCH;
    for (int32_t i = 0; i < PITCH; i++)
        line[i] = fill;
    if (is_there && from < to)
        __builtin_memcpy(line + from, crv__plane_at(plane, x - LEFT + from, y),
                         (size_t)(to - from) * sizeof *line);
    return line;
}

/* crv__slope(): of the two one-sided differences the smaller, the earlier if equal. */
CRV__INLINE vf smaller_slope(vf before, vf d, vf after)
{
    const vf backward = d - before, forward = after - d;
    const vf slope =
        vf_select(vf_lt(vf_abs(forward), vf_abs(backward)), forward, backward);
    return vf_where(vf_lt(vf_abs(slope), vf_set(CRV_STEEPEST_SLOPE)), slope);
}

/* The row y of a tile that begins at column x, with the slopes. */
CRV__INLINE row row_at(const crv__frame *f, const crv__plane *input, int32_t x, int32_t y,
                       int32_t width, lines *l)
{
    const crv__plane *depth = &f->depth[0];
    float aside[2][PITCH];
    row r = {.depth = line_of(depth, x, y, INFINITY, l->depth),
             .value = line_of(input, x, y, NAN, l->value),
             .across = l->across,
             .down = l->down};
    for (int32_t i = 0; i < 3; i++)
        r.normal[i] = line_of(&f->normal[i], x, y, 0, l->normal[i]);
    const float *above = line_of(depth, x, y - 1, INFINITY, aside[0]),
                *below = line_of(depth, x, y + 1, INFINITY, aside[1]);
    for (int32_t i = LEFT - RADIUS - 1; i < LEFT + width + RADIUS + 1; i += CRV__LANES) {
        vf across = vf_zero(), down = vf_zero();
        if (f->params->filter_slope) {
            const vf d = vf_load(r.depth + i);
            across = smaller_slope(vf_load(r.depth + i - 1), d, vf_load(r.depth + i + 1));
            down = smaller_slope(vf_load(above + i), d, vf_load(below + i));
        }
        vf_store(l->across + i, across);
        vf_store(l->down + i, down);
    }
    return r;
}

/* The edges between two lines of pixels. */
CRV__INLINE vf edge(const crv__params *p, const row *a, int32_t i, const row *b,
                    int32_t k, const float *a_slope, const float *b_slope)
{
    const vf one = vf_set(1);
    const vf rise = vf_load(b->depth + k) - vf_load(a->depth + i);
    const vf off =
        vf_abs(rise - vf_load(a_slope + i)) + vf_abs(rise - vf_load(b_slope + k));
    const vf proximity = one - off * vf_set(0.5f / p->filter_depth);
    const crv__v3 n = {vf_load(a->normal[0] + i), vf_load(a->normal[1] + i),
                       vf_load(a->normal[2] + i)},
                  m = {vf_load(b->normal[0] + k), vf_load(b->normal[1] + k),
                       vf_load(b->normal[2] + k)};
    const vf turned = one - crv__v3_dot(n, m);
    const vf likeness = vf_min(one - turned * vf_set(p->filter_normal), one);
    const vf first = vf_load(a->value + i), second = vf_load(b->value + k);
    const vf least = vf_set(LEAST), infinity = vf_set(INFINITY);
    const vm taps = vm_and(vm_and(vf_le(first, first), vf_le(second, second)),
                           vm_and(vf_lt(vf_load(a->depth + i), infinity),
                                  vf_lt(vf_load(b->depth + k), infinity)));
    const vf e = vf_max(proximity, vf_zero()) * vf_max(likeness, vf_zero());
    return vf_where(taps, vf_max(e, least));
}

/* The mean of a line of taps with these edges; the strides between them. */
CRV__INLINE vf mean_along(const float *value, ptrdiff_t step, const float *edge_after,
                          ptrdiff_t edge_step)
{
    const vf zero = vf_zero(), two = vf_set(2), three = vf_set(3), four = vf_set(4);
    const vf before = vf_load(edge_after - edge_step), after = vf_load(edge_after);
    const vf least = vf_set(LONELY) * vf_max(vf_set(1) - before - after, zero);
    const vf first = vf_where(vf_lt(zero, before), vf_max(before, least)),
             second = vf_where(vf_lt(zero, after), vf_max(after, least));
    const vf e2 = vf_load(edge_after - 2 * edge_step),
             e3 = vf_load(edge_after - 3 * edge_step);
    const vf f2 = vf_load(edge_after + edge_step),
             f3 = vf_load(edge_after + 2 * edge_step);
    vf sum = vf_fma(
        three, vf_load(value - step),
        e2 * vf_fma(two, vf_load(value - 2 * step), e3 * vf_load(value - 3 * step)));
    vf weights = vf_fma(e2, two + e3, three);
    const vf sum2 = vf_fma(
        three, vf_load(value + step),
        f2 * vf_fma(two, vf_load(value + 2 * step), f3 * vf_load(value + 3 * step)));
    const vf weights2 = vf_fma(f2, two + f3, three);
    sum = vf_fma(first, sum, vf_fma(second, sum2, four * vf_load(value)));
    weights = vf_fma(first, weights, vf_fma(second, weights2, four));
    return sum / weights;
}

/* What the first pass leaves for the second: its values, 0 where there is no tap, and the
 * edges to the row below. */
typedef struct between {
    _Alignas(64) float value[ROWS][CRV__FILTER_TILE_WIDTH],
        down[ROWS][CRV__FILTER_TILE_WIDTH];
} between;

CRV__INLINE void filter_row(const crv__params *p, const row *r, int32_t width, float *out)
{
    _Alignas(64) float value[PITCH], edges[PITCH];
    for (int32_t i = LEFT - RADIUS; i < LEFT + width + RADIUS; i += CRV__LANES) {
        const vf v = vf_load(r->value + i);
        vf_store(value + i, vf_where(vf_le(v, v), v));
    }
    for (int32_t i = LEFT - RADIUS; i < LEFT + width + RADIUS; i += CRV__LANES)
        vf_store(edges + i, edge(p, r, i, r, i + 1, r->across, r->across));
    for (int32_t i = 0; i < width; i += CRV__LANES)
        vf_store(out + i,
                 vf_clamp01(mean_along(value + LEFT + i, 1, edges + LEFT + i, 1)));
}

/* The k-th row of `between`, filtered down the columns. */
CRV__INLINE void store_row(const crv__frame *f, const crv__plane *input, const between *b,
                           int32_t k, int32_t x, int32_t y, int32_t width, float *out)
{
    const float *value = crv__plane_at(input, x, y),
                *depth = crv__plane_at(&f->depth[0], x, y);
    for (int32_t i = 0; i < width; i += CRV__LANES) {
        const vf own = vf_load_n(value + i, width - i);
        const vm surface = vf_lt(vf_load_n(depth + i, width - i), vf_set(INFINITY));
        const vf mean = mean_along(b->value[k] + i, CRV__FILTER_TILE_WIDTH,
                                   b->down[k] + i, CRV__FILTER_TILE_WIDTH);
        const vf result = vf_select(vf_le(own, own), vf_clamp01(mean), own);
        vf_store_n(out + i, vf_select(surface, result, vf_set(1)), width - i);
    }
}

/* Both passes over a part of a tile, at most STRIP rows. */
CRV__NOINLINE void filter_strip(const crv__frame *f, const crv__plane *input,
                                const crv__plane *out, crv__tile tile)
{
    const int32_t width = tile.x1 - tile.x0, height = tile.y1 - tile.y0;
    const int32_t whole = (width + CRV__LANES - 1) / CRV__LANES * CRV__LANES;
    const int32_t top = tile.y0 - RADIUS; /* of `between` */
    between b;
    lines memory[2] = {0};
    row rows[2];
    rows[0] = row_at(f, input, tile.x0, top, whole, &memory[0]);
    for (int32_t k = 0; k < height + 2 * RADIUS; k++) {
        const row *own = &rows[k % 2];
        row *next = &rows[(k + 1) % 2];
        *next = row_at(f, input, tile.x0, top + k + 1, whole, &memory[(k + 1) % 2]);
        filter_row(f->params, own, whole, b.value[k]);
        for (int32_t i = 0; i < whole; i += CRV__LANES)
            vf_store(b.down[k] + i, edge(f->params, own, LEFT + i, next, LEFT + i,
                                         own->down, next->down));
    }
    for (int32_t y = tile.y0; y < tile.y1; y++)
        store_row(f, input, &b, y - top, tile.x0, y, width,
                  crv__plane_at(out, tile.x0, y));
}

void CRV__NAME(edges7)(const crv__frame *f, const crv__plane *input,
                       const crv__plane *out, crv__tile tile);
void CRV__NAME(edges7)(const crv__frame *f, const crv__plane *input,
                       const crv__plane *out, crv__tile tile)
{
    for (int32_t y = tile.y0; y < tile.y1; y += STRIP) {
        crv__tile strip = tile;
        strip.y0 = y;
        strip.y1 = y + STRIP < tile.y1 ? y + STRIP : tile.y1;
        filter_strip(f, input, out, strip);
    }
}
