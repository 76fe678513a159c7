/* SPDX-License-Identifier: MIT */
/*
 * filters/edges15.c for the lanes of a vector. A tile is gone through row by row: a row
 * is filtered across, and down with the rows before it, each level as soon as its rows
 * are there. Edges are computed once for each pair of pixels, weights for each pixel.
 *
 * What is no tap has an infinite depth here, so that its edges come out as 0: what lies
 * outside the input, background, and values that are none.
 */
#include "cpu/kernels/window.h"

enum {
    RADIUS = 7,
    MARGIN = 8, /* beside the tile: RADIUS, and slopes read one more */
    LEFT = 16,  /* the tile's first column in a line */
    WIDTH = CRV__FILTER_TILE_WIDTH,
    PITCH = LEFT + WIDTH + LEFT,
    ROWS = 6 /* that are kept: from the one above to that 4 below */
};

static const float STRICT = 0.25f, LONELY = 0.1f;
static const float NEAR_WEIGHT = 0.5f, NEAR_EVENNESS = 0.25f;
static const float FAR_WEIGHT = 1.0f / 3, FAR_EVENNESS = 0.5f;

/* A row of the tile. */
typedef struct row {
    _Alignas(64) float depth[PITCH];  /* infinite: no tap */
    float across[PITCH], down[PITCH]; /* slopes */
    float copies[3][PITCH];           /* of normals that leave the planes */
    const float *normal[3];
} row;

/* The weights of the pixels before and after in a level's mean; the pixel itself has what
 * they leave of 1. */
typedef struct sides {
    vf before, after;
} sides;

typedef struct line_sides {
    _Alignas(64) float before[PITCH], after[PITCH];
} line_sides;

typedef struct row_sides {
    _Alignas(64) float before[WIDTH], after[WIDTH];
} row_sides;

/* What the levels down read, as rings of rows: edges to the rows below, and weights. */
typedef struct column {
    _Alignas(64) float edge1[2][WIDTH], edge2[3][WIDTH], edge4[5][WIDTH];
    row_sides sides1[2], sides2[4], sides4[8];
} column;

/* And values. */
typedef struct values {
    _Alignas(64) float across[3][WIDTH], first[5][WIDTH], second[9][WIDTH];
} values;

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

CRV__NOINLINE void take_row(const crv__frame *f, const crv__plane *input, int32_t x,
                            int32_t y, int32_t width, row *r)
{
    _Alignas(64) float room[4][PITCH];
    const crv__plane *plane = &f->depth[0];
    const float *above = line_of(plane, x, y - 1, INFINITY, room[0]),
                *depth = line_of(plane, x, y, INFINITY, room[1]),
                *below = line_of(plane, x, y + 1, INFINITY, room[2]),
                *value = line_of(input, x, y, NAN, room[3]);
    for (int32_t i = 0; i < 3; i++)
        r->normal[i] = line_of(&f->normal[i], x, y, 0, r->copies[i]);
    for (int32_t i = LEFT - MARGIN; i < LEFT + width + MARGIN; i += CRV__LANES) {
        const vf d = vf_load(depth + i), v = vf_load(value + i);
        vf across = vf_zero(), down = vf_zero();
        if (f->params->filter_slope) {
            across = smaller_slope(vf_load(depth + i - 1), d, vf_load(depth + i + 1));
            down = smaller_slope(vf_load(above + i), d, vf_load(below + i));
        }
        vf_store(r->depth + i, vf_select(vf_le(v, v), d, vf_set(INFINITY)));
        vf_store(r->across + i, across);
        vf_store(r->down + i, down);
    }
}

/* A vector of pixels. */
typedef struct place {
    vf depth, slope;
    crv__v3 normal;
} place;

CRV__INLINE place place_at(const row *r, const float *slope, int32_t i)
{
    return (place){vf_load(r->depth + i),
                   vf_load(slope + i),
                   {vf_load(r->normal[0] + i), vf_load(r->normal[1] + i),
                    vf_load(r->normal[2] + i)}};
}

/* The same with normals times filter_normal, as edge() wants them of the earlier one. */
CRV__INLINE place scaled_place_at(const row *r, const float *slope, int32_t i, vf scale)
{
    place a = place_at(r, slope, i);
    a.normal = (crv__v3){a.normal.x * scale, a.normal.y * scale, a.normal.z * scale};
    return a;
}

/* The edges of pixels that are `apart`. */
CRV__INLINE vf edge(const crv__params *p, const place *a, const place *b, int32_t apart)
{
    const vf one = vf_set(1), minus = vf_set((float)-apart);
    const vf rise = b->depth - a->depth;
    const vf first = vf_fma(minus, a->slope, rise),
             second = vf_abs(vf_fma(minus, b->slope, rise));
    const vf less = vf_min_abs(first, second);
    const vf off = apart == 1 ? vf_fma(vf_set(STRICT), vf_max(vf_abs(first), second),
                                       vf_set(1 - STRICT) * less)
                              : less;
    const vf proximity = vf_fma(off, vf_set(-1 / p->filter_depth), one);
    const vf likeness =
        vf_fma(a->normal.x, b->normal.x,
               vf_fma(a->normal.y, b->normal.y,
                      vf_fma(a->normal.z, b->normal.z, vf_set(1 - p->filter_normal))));
    return vf_max(vf_min(likeness, proximity), vf_zero());
}

/* The sides' shares of the sum of weights; returns the sum. */
CRV__INLINE vf share(vf own, vf before, vf after, sides *s)
{
    const vf sum = own + (before + after);
    const vf part = vf_set(1) / sum;
    *s = (sides){before * part, after * part};
    return sum;
}

/* Both sides, nearer to the smaller one by a portion. */
CRV__INLINE sides evened(sides s, vf portion)
{
    const vf rest = vf_set(1) - portion, both = portion * vf_min(s.before, s.after);
    return (sides){vf_fma(rest, s.before, both), vf_fma(rest, s.after, both)};
}

/* A pixel's weights at all levels, in units of the sides' weight, from the edges before
 * and after it; `before` and `after` of the first are taps if their depth is finite. */
CRV__INLINE void weigh(const sides edges[3], vf before, vf after, sides out[3])
{
    const vf one = vf_set(1), infinity = vf_set(INFINITY), own = vf_set(1 / NEAR_WEIGHT);
    const vf l = edges[0].before, r = edges[0].after;
    const vf least = vf_max(vf_fma(vf_set(-LONELY), l + r, vf_set(LONELY)), vf_zero());
    const vf sum1 = share(own, vf_where(vf_lt(before, infinity), vf_max(l, least)),
                          vf_where(vf_lt(after, infinity), vf_max(r, least)), &out[0]);
    const sides near = evened(edges[1], vf_set(NEAR_EVENNESS));
    const vf sum2 = share(own, near.before, near.after, &out[1]);
    /* Twice what was found, of 4 by 4 on a flat surface. */
    const vf enough = vf_min(vf_set(2.0f / 16) * (sum1 * sum2), one);
    const sides far = evened(edges[2], vf_set(FAR_EVENNESS) * enough);
    share(vf_set(1 / FAR_WEIGHT) * enough * enough, far.before, far.after, &out[2]);
}

CRV__INLINE vf mean(vf own, vf before, vf after, const float *share_before,
                    const float *share_after)
{
    return vf_fma(vf_load(share_before), before - own,
                  vf_fma(vf_load(share_after), after - own, own));
}

/* Sets what levels read beside the part of a line from `from` to `to`. */
CRV__INLINE void clear_beside(float *line, int32_t from, int32_t to)
{
    for (int32_t i = 1; i <= 4; i++)
        line[from - i] = line[to + i - 1] = 0;
}

/* One level along a line. */
CRV__INLINE void level_across(const float *in, const line_sides *s, int32_t step,
                              int32_t from, int32_t to, float *out)
{
    for (int32_t i = from; i < to; i += CRV__LANES)
        vf_store(out + i, mean(vf_load(in + i), vf_load(in + i - step),
                               vf_load(in + i + step), s->before + i, s->after + i));
}

/* Edges and weights along a row. */
CRV__NOINLINE void weigh_across(const crv__params *p, const row *r, int32_t width,
                                line_sides out[3])
{
    _Alignas(64) float edges[3][PITCH];
    const int32_t from = LEFT - MARGIN, to = LEFT + width + MARGIN;
    for (int32_t k = 0; k < 3; k++)
        clear_beside(edges[k], from, to);
    for (int32_t i = from; i < to; i += CRV__LANES) {
        const place own = scaled_place_at(r, r->across, i, vf_set(p->filter_normal));
        for (int32_t k = 0; k < 3; k++) {
            const place other = place_at(r, r->across, i + (1 << k));
            vf_store(edges[k] + i, edge(p, &own, &other, 1 << k));
        }
    }
    for (int32_t i = from; i < to; i += CRV__LANES) {
        sides e[3], s[3];
        for (int32_t k = 0; k < 3; k++)
            e[k] = (sides){vf_load(edges[k] + i - (1 << k)), vf_load(edges[k] + i)};
        weigh(e, vf_load(r->depth + i - 1), vf_load(r->depth + i + 1), s);
        for (int32_t k = 0; k < 3; k++) {
            vf_store(out[k].before + i, s[k].before);
            vf_store(out[k].after + i, s[k].after);
        }
    }
}

/* The row y of a plane, filtered across. */
CRV__INLINE void filter_across(const crv__plane *input, const row *r, int32_t x,
                               int32_t y, int32_t width, const line_sides s[3],
                               float *out)
{
    _Alignas(64) float value[PITCH], first[PITCH], second[PITCH];
    const float *own = line_of(input, x, y, 0, value);
    const int32_t from = LEFT - MARGIN, to = LEFT + width + MARGIN;
    for (int32_t i = from; i < to; i += CRV__LANES)
        vf_store(value + i, vf_where(vf_lt(vf_load(r->depth + i), vf_set(INFINITY)),
                                     vf_load(own + i)));
    clear_beside(value, from, to);
    clear_beside(first, from, to);
    clear_beside(second, from, to);
    level_across(value, &s[0], 1, from, to, first);
    level_across(first, &s[1], 2, from, to, second);
    for (int32_t i = 0; i < width; i += CRV__LANES) {
        const int32_t k = LEFT + i;
        const vf v = mean(vf_load(second + k), vf_load(second + k - 4),
                          vf_load(second + k + 4), s[2].before + k, s[2].after + k);
        vf_store(out + i, vf_clamp01(v));
    }
}

/* The edges from the k-th row of a tile to those below, and its weights. */
CRV__NOINLINE void weigh_down(const crv__params *p, const row *rows, int32_t k,
                              int32_t width, column *c)
{
    const row *own = &rows[k % ROWS], *above = &rows[(k + ROWS - 1) % ROWS],
              *below[3] = {&rows[(k + 1) % ROWS], &rows[(k + 2) % ROWS],
                           &rows[(k + 4) % ROWS]};
    float *edge1 = c->edge1[k % 2], *edge2 = c->edge2[k % 3], *edge4 = c->edge4[k % 5];
    const float *before1 = c->edge1[(k + 1) % 2], *before2 = c->edge2[(k + 1) % 3],
                *before4 = c->edge4[(k + 1) % 5];
    row_sides *out[3] = {&c->sides1[k % 2], &c->sides2[k % 4], &c->sides4[k % 8]};
    for (int32_t i = 0; i < width; i += CRV__LANES) {
        const place a =
            scaled_place_at(own, own->down, LEFT + i, vf_set(p->filter_normal));
        vf e[3];
        for (int32_t n = 0; n < 3; n++) {
            const place b = place_at(below[n], below[n]->down, LEFT + i);
            e[n] = edge(p, &a, &b, 1 << n);
        }
        const sides edges[3] = {{vf_load(before1 + i), e[0]},
                                {vf_load(before2 + i), e[1]},
                                {vf_load(before4 + i), e[2]}};
        vf_store(edge1 + i, e[0]);
        vf_store(edge2 + i, e[1]);
        vf_store(edge4 + i, e[2]);
        sides s[3];
        weigh(edges, vf_load(above->depth + LEFT + i),
              vf_load(below[0]->depth + LEFT + i), s);
        for (int32_t n = 0; n < 3; n++) {
            vf_store(out[n]->before + i, s[n].before);
            vf_store(out[n]->after + i, s[n].after);
        }
    }
}

/* One level down. */
CRV__INLINE void level_down(const float *own, const float *above, const float *below,
                            const row_sides *s, int32_t width, float *out)
{
    for (int32_t i = 0; i < width; i += CRV__LANES)
        vf_store(out + i, mean(vf_load(own + i), vf_load(above + i), vf_load(below + i),
                               s->before + i, s->after + i));
}

/* The last level down, of a row of `width` pixels from (x, y) on. A value that is none
 * stays so; background is 1. */
CRV__INLINE void store_row(const crv__frame *f, const crv__plane *input,
                           const crv__plane *out, int32_t x, int32_t y, int32_t width,
                           const float *result)
{
    const float *value = crv__plane_at(input, x, y),
                *depth = crv__plane_at(&f->depth[0], x, y);
    float *to = crv__plane_at(out, x, y);
    for (int32_t i = 0; i < width; i += CRV__LANES) {
        const vf own = vf_load_n(value + i, width - i);
        const vm surface = vf_lt(vf_load_n(depth + i, width - i), vf_set(INFINITY));
        const vf a = vf_select(vf_le(own, own), vf_clamp01(vf_load(result + i)), own);
        vf_store_n(to + i, vf_select(surface, a, vf_set(1)), width - i);
    }
}

/* The levels down whose last row is the k-th: the first of the row before it, the second
 * 2 before that, and of the row 4 before that, which is returned, the third. */
CRV__INLINE void go_down(values *v, const column *c, int32_t k, int32_t width, float *out)
{
    if (k >= 2)
        level_down(v->across[(k - 1) % 3], v->across[(k - 2) % 3], v->across[k % 3],
                   &c->sides1[(k - 1) % 2], width, v->first[(k - 1) % 5]);
    if (k >= 6)
        level_down(v->first[(k - 3) % 5], v->first[(k - 5) % 5], v->first[(k - 1) % 5],
                   &c->sides2[(k - 3) % 4], width, v->second[(k - 3) % 9]);
    if (k >= 2 * RADIUS)
        level_down(v->second[(k - 7) % 9], v->second[(k - 11) % 9],
                   v->second[(k - 3) % 9], &c->sides4[(k - 7) % 8], width, out);
}

void CRV__NAME(edges15)(const crv__frame *f, const crv__plane *input,
                        const crv__plane *out, crv__tile tile);
void CRV__NAME(edges15)(const crv__frame *f, const crv__plane *input,
                        const crv__plane *out, crv__tile tile)
{
    const int32_t width = tile.x1 - tile.x0, rows = tile.y1 - tile.y0 + 2 * RADIUS;
    const int32_t whole = (width + CRV__LANES - 1) / CRV__LANES * CRV__LANES;
    const int32_t top = tile.y0 - RADIUS;
    row window[ROWS] = {0};
    column c = {0};
    values v = {0};
    for (int32_t k = 0; k < 4; k++)
        take_row(f, input, tile.x0, top + k, whole, &window[k]);
    for (int32_t k = 0; k < rows; k++) {
        line_sides along[3];
        _Alignas(64) float result[WIDTH];
        if (k + 4 < rows)
            take_row(f, input, tile.x0, top + k + 4, whole, &window[(k + 4) % ROWS]);
        const row *r = &window[k % ROWS];
        weigh_across(f->params, r, whole, along);
        filter_across(input, r, tile.x0, top + k, whole, along, v.across[k % 3]);
        weigh_down(f->params, window, k, whole, &c);
        go_down(&v, &c, k, whole, result);
        if (k >= 2 * RADIUS)
            store_row(f, input, out, tile.x0, top + k - RADIUS, width, result);
    }
}
