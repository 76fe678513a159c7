/* SPDX-License-Identifier: MIT */
/*
 * methods/width.c for the lanes of a vector. Whether a surface ends between a pixel and
 * the next one on a line depends on the pixel before them alone, and not on where the
 * search began. So the distance to the silhouette is found by one scan along each line:
 * half a pixel where the surface ends, infinite where the search does, and else one more
 * than the next pixel's.
 *
 * A strip is as many parallel lines as there are lanes. A line has a width only if depth
 * jumps on it both ways; most strips have no such line and are left out.
 */
#include "cpu/kernels/lanes.h"

enum {
    WIDTH = CRV__MAP_TILE_WIDTH,
    HEIGHT = CRV__MAP_TILE_HEIGHT,
    HALO = 32, /* how far silhouettes are looked for, px */
    PAD = 16,
    PITCH = WIDTH + 2 * HALO + 2 * PAD,
    FIRST = PAD + HALO, /* column of the tile */
    ROWS = HEIGHT + 2 * HALO + 2,
    TOP = HALO + 1 /* row of the tile */
};

/* A tile's depth, with what lies around it; -INFINITY: not on the buffers. Rows of PITCH
 * floats: oblique lines begin and end outside of the rows. */
typedef struct surroundings {
    float depth[ROWS * PITCH];
    float least[HEIGHT * PITCH]; /* widths so far, over the depth's unit */
} surroundings;

/* An axis of the image. */
typedef struct axis {
    int32_t dx;    /* columns from row to row */
    int32_t reach; /* pixels beyond a pixel at which a silhouette still counts */
    float length;  /* of a step, over the depth's unit */
} axis;

static void copy_depth(surroundings *s, const crv__plane *plane, crv__tile tile)
{
    const int32_t left = tile.x0 - FIRST, right = left + PITCH;
    const int32_t x0 = left > 0 ? left : 0,
                  x1 = right < plane->width ? right : plane->width;
    for (int32_t r = 0; r < ROWS; r++) {
        const int32_t y = tile.y0 - TOP + r;
        float *row = s->depth + (ptrdiff_t)r * PITCH;
        const bool is_there = y >= 0 && y < plane->height;
        for (int32_t c = 0; c < PITCH && (!is_there || x1 - x0 < PITCH); c++)
            row[c] = -INFINITY;
        if (is_there)
            __builtin_memcpy(row + (x0 - left), crv__plane_at(plane, x0, y),
                             (size_t)(x1 - x0) * sizeof(float));
    }
}

/* The distance of the lanes of `own`, of which `before` and `next` are the neighbours on
 * the line, and `further` the distance from `next` on. */
CRV__INLINE vf distance_of(const crv__params *p, vf before, vf own, vf next, vf further)
{
    const vf zero = vf_zero(), jump = vf_set(0.2f * p->radius);
    const vf ahead = before + before - own; /* own/on, times before */
    vm recedes = vm_and(vf_lt(before, own), vf_lt(zero, ahead));
    vm ends;
    if (p->orthographic) {
        recedes = vm_and(recedes, vf_lt(own - before, jump));
        ends = vf_lt(jump, next - (own + own - before));
    } else {
        const vf product = own * before;
        recedes = vm_and(recedes, vf_lt(product, (own + jump) * ahead));
        ends = vf_lt(product, (next - jump) * ahead);
    }
    const vm silhouette =
        vm_or(vm_and(recedes, ends), vm_and(vm_not(recedes), vf_lt(jump, next - own)));
    const vm hidden = vf_lt(jump, own - next); /* off the buffers, too */
    const vf on = vf_select(hidden, vf_set(INFINITY), further + vf_set(1));
    return vf_select(silhouette, vf_set(0.5f), on);
}

/* Whether some of these lines may have a width: `count` places from `at` on, `step`
 * floats from one to the next. */
CRV__INLINE bool jumps_both_ways(const crv__params *p, const float *at, ptrdiff_t step,
                                 int32_t count)
{
    const vf jump = vf_set(0.2f * p->radius), minus_jump = vf_zero() - jump;
    vm back = vm_none(), forth = vm_none();
    vf own = vf_load(at);
    for (int32_t i = 1; i < count; i++) {
        const vf next = vf_load(at + i * step), change = next - own;
        back = vm_or(back, vf_lt(jump, change));
        forth = vm_or(forth, vf_lt(change, minus_jump));
        own = next;
    }
    return vm_any(vm_and(back, forth));
}

/* Takes the widths of a strip's lines into account, of their places in the rows `low` to
 * high - 1 of the tile. In row 0 the strip's first line is at column c. */
CRV__INLINE void scan_strip(surroundings *s, const crv__params *p, const axis *a,
                            int32_t c, int32_t low, int32_t high)
{
    const ptrdiff_t step = PITCH + a->dx;
    const float *depth = s->depth + (TOP * PITCH + c);
    const int32_t begin = low - a->reach, end = high + a->reach;
    if (!jumps_both_ways(p, depth + (begin - 1) * step, step, end - begin + 2))
        return;
    _Alignas(64) float ahead[HEIGHT][CRV__LANES];
    vf far = vf_set(INFINITY), own = vf_load(depth + (end - 1) * step),
       next = vf_load(depth + end * step);
    for (int32_t i = end - 1; i >= low; i--) {
        const vf before = vf_load(depth + (i - 1) * step);
        far = distance_of(p, before, own, next, far);
        next = own;
        own = before;
        if (i < high)
            vf_store(ahead[i], far);
    }
    const vf limit = vf_set((float)a->reach + 0.5f), infinity = vf_set(INFINITY),
             length = vf_set(a->length);
    far = infinity;
    own = vf_load(depth + begin * step);
    next = vf_load(depth + (begin - 1) * step);
    for (int32_t i = begin; i < high; i++) {
        const vf before = vf_load(depth + (i + 1) * step);
        far = distance_of(p, before, own, next, far);
        next = own;
        own = before;
        if (i < low)
            continue;
        const vf other = vf_load(ahead[i]);
        const vm both = vm_and(vf_le(far, limit), vf_le(other, limit));
        const vf width = vf_select(both, (other + far) * length, infinity);
        float *least = s->least + (c + i * step);
        vf_store(least, vf_min(width, vf_load(least)));
    }
}

/* An axis that goes from row to row. Each strip takes the rows in which it meets the
 * tile. */
static void scan_rows(surroundings *s, const crv__params *p, const axis *a)
{
    const int32_t right = FIRST + WIDTH;
    const int32_t begin = a->dx > 0 ? FIRST - HEIGHT : FIRST,
                  end = a->dx < 0 ? right + HEIGHT : right;
    for (int32_t c = begin; c < end; c += CRV__LANES) {
        int32_t low = 0, high = HEIGHT;
        if (a->dx > 0) {
            low = FIRST - CRV__LANES - c + 1;
            high = right - c;
        }
        if (a->dx < 0) {
            low = c - right + 1;
            high = c + CRV__LANES - FIRST;
        }
        low = low > 0 ? low : 0;
        high = high < HEIGHT ? high : HEIGHT;
        if (low < high)
            scan_strip(s, p, a, c, low, high);
    }
}

/* Whether a row of the tile may have a width along it. */
CRV__INLINE bool row_jumps_both_ways(const crv__params *p, const float *row)
{
    const vf jump = vf_set(0.2f * p->radius), minus_jump = vf_zero() - jump;
    vm back = vm_none(), forth = vm_none();
    for (int32_t c = PAD; c < PITCH - PAD; c += CRV__LANES) {
        const vf change = vf_load(row + c + 1) - vf_load(row + c);
        back = vm_or(back, vf_lt(jump, change));
        forth = vm_or(forth, vf_lt(change, minus_jump));
    }
    return vm_any(back) && vm_any(forth);
}

/* The axis along a row: events by vectors, then both scans at once. */
static void scan_columns(surroundings *s, const crv__params *p, const axis *a)
{
    float ahead[PITCH], behind[PITCH];
    const vf none = vf_set(-2), infinity = vf_set(INFINITY); /* an event's is positive */
    const vf limit = vf_set((float)a->reach + 0.5f), length = vf_set(a->length);
    for (int32_t r = 0; r < HEIGHT; r++) {
        const float *row = s->depth + (ptrdiff_t)(TOP + r) * PITCH;
        if (!row_jumps_both_ways(p, row))
            continue;
        for (int32_t c = PAD; c < PITCH - PAD; c += CRV__LANES) {
            const vf left = vf_load(row + c - 1), own = vf_load(row + c),
                     right = vf_load(row + c + 1);
            vf_store(ahead + c, distance_of(p, left, own, right, none));
            vf_store(behind + c, distance_of(p, right, own, left, none));
        }
        float next = INFINITY, before = INFINITY;
        for (int32_t i = PAD; i < FIRST + WIDTH; i++) {
            const int32_t j = PITCH - 1 - i;
            next = ahead[j] >= 0 ? ahead[j] : next + 1;
            before = behind[i] >= 0 ? behind[i] : before + 1;
            ahead[j] = next;
            behind[i] = before;
        }
        float *least = s->least + (ptrdiff_t)r * PITCH;
        for (int32_t c = FIRST; c < FIRST + WIDTH; c += CRV__LANES) {
            const vf there = vf_load(ahead + c), back = vf_load(behind + c);
            const vm both = vm_and(vf_le(there, limit), vf_le(back, limit));
            const vf width = vf_select(both, (there + back) * length, infinity);
            vf_store(least + c, vf_min(width, vf_load(least + c)));
        }
    }
}

CRV__INLINE void write_rows(const crv__frame *f, const surroundings *s,
                            const crv__plane *out, crv__tile tile)
{
    const crv__params *p = f->params;
    for (int32_t y = tile.y0; y < tile.y1; y++) {
        for (int32_t x = tile.x0; x < tile.x1; x += CRV__LANES) {
            const int32_t rest = tile.x1 - x;
            const ptrdiff_t at = (y - tile.y0) * PITCH + (x - tile.x0 + FIRST);
            const vf d = vf_load(s->depth + TOP * PITCH + at),
                     infinity = vf_set(INFINITY);
            const vf steps = vf_load(s->least + at);
            const vf width = p->orthographic ? steps : steps * d;
            vf_store_n(crv__plane_at(out, x, y),
                       vf_select(vf_lt(d, infinity), width, infinity), rest);
        }
    }
}

static float length_of(float x, float y)
{
    float lanes[CRV__LANES];
    vf_store(lanes, vf_sqrt(vf_set(x * x + y * y)));
    return lanes[0];
}

void CRV__NAME(width)(const crv__frame *f, const crv__plane *out, crv__tile tile);
void CRV__NAME(width)(const crv__frame *f, const crv__plane *out, crv__tile tile)
{
    const crv__params *p = f->params;
    const float oblique = length_of(p->inv_fx, p->inv_fy);
    const axis columns = {.reach = HALO - 1, .length = p->inv_fx},
               rows = {.reach = HALO - 1, .length = p->inv_fy};
    /* 22.5 times sqrt(2): 31.8 px */
    const axis falling = {.dx = 1, .reach = 22, .length = oblique},
               rising = {.dx = -1, .reach = 22, .length = oblique};
    surroundings s;
    copy_depth(&s, &f->depth[0], tile);
    for (int32_t i = 0; i < HEIGHT * PITCH; i++)
        s.least[i] = INFINITY;
    scan_columns(&s, p, &columns);
    scan_rows(&s, p, &rows);
    scan_rows(&s, p, &falling);
    scan_rows(&s, p, &rising);
    write_rows(f, &s, out, tile);
}
