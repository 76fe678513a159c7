/* SPDX-License-Identifier: MIT */
/*
 * filters/edges15.c for the lanes of a vector. A tile is gone through row by row: a row
 * is filtered across, and down with the rows before it, each level as soon as its rows
 * are there. Edges are computed once for each pair of pixels, weights once for each
 * pixel, for accessibility and bent normals alike.
 *
 * What is no tap has an infinite depth here, so that its edges come out as 0: what lies
 * outside the input, background, and values that are none.
 */
#include "cpu/kernels/window.h"

enum {
    RADIUS = 7,
    MARGIN = 8, /* beside the tile: RADIUS, and slopes read one more */
    LEFT = 24,  /* the tile's first column in a line; that of the margin is aligned */
    WIDTH = CRV__FILTER_TILE_WIDTH,
    PITCH = LEFT + WIDTH + LEFT,
    ROWS = 6, /* that are kept: from the one above to that 4 below */
    PLANES = CRV__PLANES,
    AHEAD = 3 /* rows that are taken before they are filtered across */
};

static const float STRICT = 0.25f, LONELY = 0.1f;
static const float NEAR_WEIGHT = 0.5f, NEAR_EVENNESS = 0.25f;
static const float FAR_WEIGHT = 1.0f / 3, FAR_EVENNESS = 0.5f;

/* A row of the tile. */
typedef struct row {
    _Alignas(64) float depth[PITCH];  /* infinite: no tap */
    float value[PITCH];               /* accessibility; 0: no tap */
    float across[PITCH], down[PITCH]; /* slopes; those down MARGIN further on, aligned */
    float copies[3][PITCH];           /* of normals that leave the planes */
    const float *normal[3];
} row;

/* The weights of the pixels before and after in a level's mean; the pixel itself has what
 * they leave of 1. */
typedef struct sides {
    vf before, after;
} sides;

/* A row across: edges to the pixels 1, 2 and 4 further on, and the weights of the second
 * and third level. Here and in `values`, what is read beside the margins is 0. */
typedef struct line {
    _Alignas(64) float edges[3][PITCH], before[2][PITCH], after[2][PITCH];
} line;

/* What the rows down leave for those below, as rings of as many rows as lie between. */
typedef struct column {
    _Alignas(64) float edge1[2][WIDTH], edge2[3][WIDTH], edge4[5][WIDTH];
    float before2[2][WIDTH], after2[2][WIDTH], before4[6][WIDTH], after4[6][WIDTH];
} column;

/* A plane's values before each level: along the row across, and as such rings down. */
typedef struct values {
    _Alignas(64) float bent[PITCH], second[PITCH], third[PITCH];
    float down1[2][WIDTH], down2[4][WIDTH], down4[8][WIDTH];
} values;

/* A plane's row from column x - LEFT on, PITCH floats; `fill` beside what it holds. */
CRV__INLINE const float *line_of(const crv__plane *plane, int32_t x, int32_t y,
                                 float fill, float *copy)
{
    const int32_t first = x - LEFT - plane->x0, right = plane->width - first;
    const bool is_there = y >= plane->y0 && y < plane->y0 + plane->height;
    if (is_there && first >= 0 && right >= PITCH)
        return crv__plane_at(plane, x - LEFT, y);
    const int32_t from = first < 0 ? -first : 0, to = right < PITCH ? right : PITCH;
    const bool holds = is_there && from < to;
    for (int32_t i = 0; i < (holds ? from : PITCH); i++)
        copy[i] = fill;
    for (int32_t i = to; i < PITCH && holds; i++)
        copy[i] = fill;
    if (holds)
        __builtin_memcpy(copy + from, crv__plane_at(plane, x - LEFT + from, y),
                         (size_t)(to - from) * sizeof *copy);
    return copy;
}

/* crv__slope(): of the two one-sided differences the smaller, the earlier if equal. */
CRV__INLINE vf smaller_slope(vf before, vf d, vf after)
{
    const vf backward = d - before, forward = after - d;
    const vf least = vf_least_abs(backward, forward);
    const vf slope = vf_select(vf_lt(least, vf_abs(backward)), forward, backward);
    return vf_where(vf_lt(least, vf_set(CRV_STEEPEST_SLOPE)), slope);
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
    const bool with_slopes = f->params->filter_slope;
    for (int32_t i = LEFT - MARGIN; i < LEFT + width + MARGIN; i += CRV__LANES) {
        const vf d = vf_load(depth + i), v = vf_load(value + i);
        vf across = vf_zero(), down = vf_zero();
        if (with_slopes) {
            across = smaller_slope(vf_load(depth + i - 1), d, vf_load(depth + i + 1));
            down = smaller_slope(vf_load(above + i), d, vf_load(below + i));
        }
        const vm is_tap = vm_and(vf_le(v, v), vf_lt(d, vf_set(INFINITY)));
        vf_store(r->depth + i, vf_select(is_tap, d, vf_set(INFINITY)));
        vf_store(r->value + i, vf_where(is_tap, v));
        vf_store(r->across + i, across);
        vf_store(r->down + MARGIN + i, down);
    }
}

/* A row of a component of bent normals; 0 where there is no tap. */
CRV__NOINLINE void take_bent(const crv__plane *input, const row *r, int32_t x, int32_t y,
                             int32_t width, float *out)
{
    _Alignas(64) float room[PITCH];
    const float *given = line_of(input, x, y, 0, room);
    for (int32_t i = LEFT - MARGIN; i < LEFT + width + MARGIN; i += CRV__LANES)
        vf_store(out + i, vf_where(vf_lt(vf_load(r->depth + i), vf_set(INFINITY)),
                                   vf_load(given + i)));
}

/* What edges are made with. Loops are given it by value: what they store may be anything
 * to the compiler. */
typedef struct limits {
    vf normal, base; /* likeness = normal * cosine + base */
    vf unit;         /* proximity = unit * deviation + 1 */
    vf strict_less, strict_more;
} limits;

CRV__INLINE limits limits_of(const crv__params *p)
{
    const float unit = -1 / p->filter_depth;
    return (limits){vf_set(p->filter_normal), vf_set(1 - p->filter_normal), vf_set(unit),
                    vf_set((1 - STRICT) * unit), vf_set(STRICT * unit)};
}

/* A row as the loops see it. */
typedef struct view {
    const float *depth, *slope, *normal[3];
} view;

CRV__INLINE view view_of(const row *r, const float *slope, int32_t at)
{
    return (view){r->depth + at,
                  slope + at,
                  {r->normal[0] + at, r->normal[1] + at, r->normal[2] + at}};
}

/* A vector of pixels. */
typedef struct place {
    vf depth, slope;
    crv__v3 normal;
} place;

CRV__INLINE place place_at(const view *v, int32_t i)
{
    return (place){vf_load(v->depth + i),
                   vf_load(v->slope + i),
                   {vf_load(v->normal[0] + i), vf_load(v->normal[1] + i),
                    vf_load(v->normal[2] + i)}};
}

/* The same with normals times filter_normal, as edge() wants them of the earlier one. */
CRV__INLINE place scaled_place_at(const view *v, int32_t i, const limits *l)
{
    place a = place_at(v, i);
    a.normal =
        (crv__v3){a.normal.x * l->normal, a.normal.y * l->normal, a.normal.z * l->normal};
    return a;
}

/* The edges of pixels that are `apart`. */
CRV__INLINE vf edge(const limits *l, const place *a, const place *b, int32_t apart)
{
    const vf minus = vf_set((float)-apart), rise = b->depth - a->depth;
    const vf first = vf_fma(minus, a->slope, rise),
             second = vf_fma(minus, b->slope, rise);
    const vf less = vf_least_abs(first, second), one = vf_set(1);
    const vf proximity =
        apart == 1 ? vf_fma(less, l->strict_less,
                            vf_fma(vf_most_abs(first, second), l->strict_more, one))
                   : vf_fma(less, l->unit, one);
    const vf likeness = vf_fma(
        a->normal.x, b->normal.x,
        vf_fma(a->normal.y, b->normal.y, vf_fma(a->normal.z, b->normal.z, l->base)));
    return vf_max(vf_min(likeness, proximity), vf_zero());
}

/* A pixel's weights at all levels, from the edges before and after it; `before` and
 * `after` of the first are taps if their depth is finite. Sums are in units that save
 * multiplications, and divide at once: they lie between 0.75 and 6. */
CRV__INLINE void weigh(const sides edges[3], vf before, vf after, sides out[3])
{
    const vf infinity = vf_set(INFINITY);
    const vf l = edges[0].before, r = edges[0].after;
    const vf least = vf_fma(vf_set(-LONELY), l + r, vf_set(LONELY)); /* edges are >= 0 */
    const vf before1 = vf_where(vf_lt(before, infinity), vf_max(l, least)),
             after1 = vf_where(vf_lt(after, infinity), vf_max(r, least));
    const vf sum1 = vf_set(1 / NEAR_WEIGHT) + (before1 + after1);

    const float uneven = 1 - NEAR_EVENNESS;
    const vf both2 = vf_min(edges[1].before, edges[1].after),
             before2 = vf_fma(vf_set(NEAR_EVENNESS / uneven), both2, edges[1].before),
             after2 = vf_fma(vf_set(NEAR_EVENNESS / uneven), both2, edges[1].after);
    const vf sum2 = vf_set(1 / (NEAR_WEIGHT * uneven)) + (before2 + after2);

    /* Twice what was found, of 4 by 4 on a flat surface. */
    const vf found = sum1 * sum2;
    const vf enough = vf_min(vf_set(2.0f / 16 * uneven) * found, vf_set(1));
    const vf portion = vf_set(FAR_EVENNESS) * enough, rest = vf_set(1) - portion;
    const vf both4 = portion * vf_min(edges[2].before, edges[2].after),
             before4 = vf_fma(rest, edges[2].before, both4),
             after4 = vf_fma(rest, edges[2].after, both4);
    const vf sum4 = vf_fma(vf_set(1 / FAR_WEIGHT) * enough, enough, before4 + after4);

    const vf all = vf_set(1) / (found * sum4), near = all * sum4;
    const vf part1 = near * sum2, part2 = near * sum1, part4 = all * found;
    out[0] = (sides){before1 * part1, after1 * part1};
    out[1] = (sides){before2 * part2, after2 * part2};
    out[2] = (sides){before4 * part4, after4 * part4};
}

CRV__INLINE vf mean(vf own, vf before, vf after, const sides *s)
{
    return vf_fma(s->before, before - own, vf_fma(s->after, after - own, own));
}

CRV__NOINLINE void edges_across(const crv__params *p, const row *r, int32_t width,
                                line *out)
{
    const limits l = limits_of(p);
    const view v = view_of(r, r->across, 0);
    for (int32_t i = LEFT - MARGIN; i < LEFT + width + MARGIN; i += CRV__LANES) {
        const place own = scaled_place_at(&v, i, &l);
        for (int32_t k = 0; k < 3; k++) {
            const place other = place_at(&v, i + (1 << k));
            vf_store(out->edges[k] + i, edge(&l, &own, &other, 1 << k));
        }
    }
}

/* A level's mean along a line. */
CRV__INLINE vf mean_across(const float *at, int32_t step, const sides *s)
{
    return mean(vf_load(at), vf_load(at - step), vf_load(at + step), s);
}

/* The first two levels along a row, and the weights of the third. */
CRV__INLINE void levels_across(const row *r, int32_t width, int32_t planes, line *l,
                               values *v)
{
    const int32_t from = LEFT - MARGIN, to = LEFT + width + MARGIN;
    for (int32_t i = from; i < to; i += CRV__LANES) {
        sides e[3], s[3];
        for (int32_t k = 0; k < 3; k++)
            e[k] = (sides){vf_load(l->edges[k] + i - (1 << k)), vf_load(l->edges[k] + i)};
        weigh(e, vf_load(r->depth + i - 1), vf_load(r->depth + i + 1), s);
        for (int32_t k = 0; k < 2; k++) {
            vf_store(l->before[k] + i, s[k + 1].before);
            vf_store(l->after[k] + i, s[k + 1].after);
        }
        for (int32_t p = 0; p < planes; p++) {
            const float *first = p == 0 ? r->value : v[p].bent;
            vf_store(v[p].second + i, mean_across(first + i, 1, &s[0]));
        }
    }
    for (int32_t i = from; i < to; i += CRV__LANES) {
        const sides s = {vf_load(l->before[0] + i), vf_load(l->after[0] + i)};
        for (int32_t p = 0; p < planes; p++)
            vf_store(v[p].third + i, mean_across(v[p].second + i, 2, &s));
    }
}

/* Takes the weights that a ring has, and leaves others. */
CRV__INLINE sides exchanged(float *before, float *after, sides s)
{
    const sides old = {vf_load(before), vf_load(after)};
    vf_store(before, s.before);
    vf_store(after, s.after);
    return old;
}

CRV__INLINE vf exchanged_value(float *at, vf value)
{
    const vf old = vf_load(at);
    vf_store(at, value);
    return old;
}

/* The edges of the row before the k-th to those below. */
CRV__NOINLINE void edges_down(const crv__params *p, const row *rows, int32_t k,
                              int32_t width, column *c)
{
    const limits l = limits_of(p);
    view at[4]; /* the row, and 1, 2 and 4 below */
    for (int32_t n = 0; n < 4; n++) {
        const row *r = &rows[(k + ROWS - 1 + (1 << n) / 2) % ROWS];
        at[n] = view_of(r, r->down + MARGIN, LEFT);
    }
    float *out[3] = {c->edge1[k % 2], c->edge2[k % 3], c->edge4[k % 5]};
    for (int32_t i = 0; i < width; i += CRV__LANES) {
        const place own = scaled_place_at(&at[0], i, &l);
        for (int32_t n = 0; n < 3; n++) {
            const place other = place_at(&at[n + 1], i);
            vf_store(out[n] + i, edge(&l, &own, &other, 1 << n));
        }
    }
}

/* The edges before and after a pixel, at each level. */
CRV__INLINE void edges_at(const column *c, int32_t k, int32_t i, sides out[3])
{
    out[0] = (sides){vf_load(c->edge1[(k + 1) % 2] + i), vf_load(c->edge1[k % 2] + i)};
    out[1] = (sides){vf_load(c->edge2[(k + 1) % 3] + i), vf_load(c->edge2[k % 3] + i)};
    out[2] = (sides){vf_load(c->edge4[(k + 1) % 5] + i), vf_load(c->edge4[k % 5] + i)};
}

/* Where a row of results goes. */
typedef struct output {
    const float *value, *depth; /* the input's accessibility, and depth, there */
    float *to[PLANES];
    int32_t width;
} output;

/* An accessibility that is none stays so; that of background is 1. */
CRV__INLINE void store_result(const output *out, int32_t p, int32_t i, vf result)
{
    const int32_t count = out->width - i;
    if (p == 0) {
        const vf own = vf_load_n(out->value + i, count);
        const vm surface = vf_lt(vf_load_n(out->depth + i, count), vf_set(INFINITY));
        const vf a = vf_select(vf_le(own, own), vf_clamp01(result), own);
        result = vf_select(surface, a, vf_set(1));
    }
    vf_store_n(out->to[p] + i, result, count);
}

/* The last level across of the k-th row, and those down that can be done then: the first
 * of the row before it, the second 2 before that, and the third 4 before that. Its
 * results are stored unless `out` is NULL. */
CRV__INLINE void levels_down(const row *rows, const line *l, int32_t k, int32_t width,
                             int32_t planes, column *c, values *v, const output *out)
{
    /* The depth above and below the row before the k-th. */
    const float *above = rows[(k + ROWS - 2) % ROWS].depth + LEFT,
                *below = rows[k % ROWS].depth + LEFT;
    for (int32_t i = 0; i < width; i += CRV__LANES) {
        const sides across = {vf_load(l->before[1] + LEFT + i),
                              vf_load(l->after[1] + LEFT + i)};
        sides e[3], s[3];
        edges_at(c, k, i, e);
        weigh(e, vf_load(above + i), vf_load(below + i), s);
        s[1] = exchanged(c->before2[k % 2] + i, c->after2[k % 2] + i, s[1]);
        s[2] = exchanged(c->before4[k % 6] + i, c->after4[k % 6] + i, s[2]);
        for (int32_t n = 0; n < planes; n++) {
            values *p = &v[n];
            vf m = mean_across(p->third + LEFT + i, 4, &across);
            m = n == 0 ? vf_clamp01(m) : m;
            const vf above1 = exchanged_value(p->down1[k % 2] + i, m);
            m = mean(vf_load(p->down1[(k + 1) % 2] + i), above1, m, &s[0]);
            const vf above2 = exchanged_value(p->down2[k % 4] + i, m);
            m = mean(vf_load(p->down2[(k + 2) % 4] + i), above2, m, &s[1]);
            const vf above4 = exchanged_value(p->down4[k % 8] + i, m);
            m = mean(vf_load(p->down4[(k + 4) % 8] + i), above4, m, &s[2]);
            if (out)
                store_result(out, n, i, m);
        }
    }
}

/* A row of results. Those written soon are asked for: rows of a tile are too short to be
 * foreseen. */
CRV__INLINE float *output_row(const crv__plane *out, int32_t x, int32_t y, int32_t width)
{
    enum { ROWS_AHEAD = 2, CACHE_LINE = 16 };
    float *to = crv__plane_at(out, x, y);
    for (int32_t i = 0; i < width; i += CACHE_LINE)
        __builtin_prefetch(to + ROWS_AHEAD * out->pitch + i, 1);
    return to;
}

/* Widens the part of a tile to the surfaces of a row, in whole vectors. */
CRV__INLINE void widen(const crv__frame *f, crv__tile tile, int32_t y, crv__tile *part)
{
    for (int32_t x = tile.x0; x < tile.x1; x += CRV__LANES) {
        const int32_t count = tile.x1 - x < CRV__LANES ? tile.x1 - x : CRV__LANES;
        const vf depth = vf_load_n(crv__plane_at(&f->depth[0], x, y), count);
        if (!vm_any(vm_and(vm_first(count), vf_lt(depth, vf_set(INFINITY)))))
            continue;
        part->x0 = x < part->x0 ? x : part->x0;
        part->x1 = x + count > part->x1 ? x + count : part->x1;
        part->y0 = y < part->y0 ? y : part->y0;
        part->y1 = y + 1 > part->y1 ? y + 1 : part->y1;
    }
}

/* The part that holds all surfaces of a tile; none: it is empty. */
CRV__INLINE crv__tile surfaces_of(const crv__frame *f, crv__tile tile)
{
    crv__tile part = {tile.x1, tile.x0, tile.y1, tile.y0};
    for (int32_t y = tile.y0; y < tile.y1 && (part.x0 > tile.x0 || part.x1 < tile.x1);
         y++)
        widen(f, tile, y, &part);
    for (int32_t y = tile.y1 - 1; y >= part.y1; y--)
        widen(f, tile, y, &part);
    return part;
}

CRV__INLINE void fill_background(const crv__plane *const out[], int32_t planes,
                                 crv__tile tile)
{
    for (int32_t p = 0; p < planes; p++)
        for (int32_t y = tile.y0; y < tile.y1; y++)
            for (int32_t x = tile.x0; x < tile.x1; x += CRV__LANES)
                vf_store_n(crv__plane_at(out[p], x, y), vf_set(p == 0 ? 1 : 0),
                           tile.x1 - x);
}

CRV__INLINE void filter_tile(const crv__frame *f, const crv__plane *const input[],
                             const crv__plane *const out[], int32_t planes, values *v,
                             crv__tile whole_tile)
{
    const crv__tile tile = surfaces_of(f, whole_tile);
    const int32_t width = tile.x1 - tile.x0, rows = tile.y1 - tile.y0 + 2 * RADIUS;
    const int32_t whole = (width + CRV__LANES - 1) / CRV__LANES * CRV__LANES;
    const int32_t x = tile.x0, top = tile.y0 - RADIUS;
    if (width < whole_tile.x1 - whole_tile.x0
        || tile.y1 - tile.y0 < whole_tile.y1 - whole_tile.y0)
        fill_background(out, planes, whole_tile);
    if (width <= 0)
        return;
    row window[ROWS] = {0};
    line l = {0};
    column c = {0};
    for (int32_t k = 0; k < ROWS * 3; k++) /* of rows before the first */
        window[k / 3].normal[k % 3] = window[k / 3].copies[k % 3];
    for (int32_t k = 0; k < AHEAD; k++)
        take_row(f, input[0], x, top + k, whole, &window[k]);
    for (int32_t k = 0; k < rows; k++) {
        if (k + AHEAD < rows)
            take_row(f, input[0], x, top + k + AHEAD, whole, &window[(k + AHEAD) % ROWS]);
        const row *r = &window[k % ROWS];
        for (int32_t p = 1; p < planes; p++)
            take_bent(input[p], r, x, top + k, whole, v[p].bent);
        edges_across(f->params, r, whole, &l);
        edges_down(f->params, window, k, whole, &c);
        levels_across(r, whole, planes, &l, v);
        if (k < 2 * RADIUS) {
            levels_down(window, &l, k, whole, planes, &c, v, NULL);
            continue;
        }
        const int32_t y = top + k - RADIUS;
        output to = {.value = crv__plane_at(input[0], x, y),
                     .depth = crv__plane_at(&f->depth[0], x, y),
                     .width = width};
        for (int32_t p = 0; p < planes; p++)
            to.to[p] = output_row(out[p], x, y, whole);
        levels_down(window, &l, k, whole, planes, &c, v, &to);
    }
}

CRV__NOINLINE void filter_accessibility(const crv__frame *f, const crv__plane *input,
                                        const crv__plane *out, crv__tile tile)
{
    values v = {0};
    filter_tile(f, &input, &out, 1, &v, tile);
}

CRV__NOINLINE void filter_all(const crv__frame *f, const crv__picture *input,
                              const crv__picture *out, crv__tile tile)
{
    const crv__plane *const inputs[PLANES] = {&input->accessibility, &input->bent[0],
                                              &input->bent[1], &input->bent[2]};
    const crv__plane *const outs[PLANES] = {&out->accessibility, &out->bent[0],
                                            &out->bent[1], &out->bent[2]};
    values v[PLANES] = {0};
    filter_tile(f, inputs, outs, PLANES, v, tile);
}

void CRV__NAME(edges15)(const crv__frame *f, const crv__picture *input,
                        const crv__picture *out, crv__tile tile);
void CRV__NAME(edges15)(const crv__frame *f, const crv__picture *input,
                        const crv__picture *out, crv__tile tile)
{
    if (input->bent[0].data)
        filter_all(f, input, out, tile);
    else
        filter_accessibility(f, &input->accessibility, &out->accessibility, tile);
}
