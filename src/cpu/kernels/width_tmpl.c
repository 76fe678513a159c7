/* SPDX-License-Identifier: MIT */
/*
 * methods/width.c for the lanes of a vector. Whether a surface ends between a pixel and
 * the next one on a line depends on the pixel before them alone, and not on where the
 * search began. So the distance to the silhouette is found by one scan along each line:
 * half a pixel where the surface ends, infinite where the search does, and else one more
 * than the next pixel's.
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

/* A tile's depth, with what lies around it; 0: not on the buffers. And distances. */
typedef struct surroundings {
    float depth[ROWS][PITCH];
    float line[2][PITCH];       /* of the two rows of a scan */
    float ahead[HEIGHT][WIDTH]; /* of one axis, in one direction */
    float least[HEIGHT][WIDTH]; /* widths so far, over the depth's unit */
} surroundings;

static void copy_depth(surroundings *s, const crv__plane *plane, crv__tile tile)
{
    const int32_t left = tile.x0 - FIRST, right = left + PITCH;
    const int32_t x0 = left > 0 ? left : 0,
                  x1 = right < plane->width ? right : plane->width;
    for (int32_t r = 0; r < ROWS; r++) {
        const int32_t y = tile.y0 - TOP + r;
        float *row = s->depth[r];
        if (y < 0 || y >= plane->height || x1 - x0 < PITCH)
            __builtin_memset(row, 0, sizeof s->depth[0]);
        if (y >= 0 && y < plane->height)
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
    const vm hidden = vm_or(vf_le(next, zero), vf_lt(jump, own - next));
    const vf on = vf_select(hidden, vf_set(INFINITY), further + vf_set(1));
    return vf_select(silhouette, vf_set(0.5f), on);
}

/* Distances of a row from the scan's row before. The line goes on by dx columns and dr
 * rows. */
CRV__INLINE void scan_row(surroundings *s, const crv__params *p, int32_t r, int32_t dx,
                          int32_t dr, const float *further, float *line)
{
    const int32_t halo = dx ? HALO : 0;
    for (int32_t c = FIRST - halo; c < FIRST + WIDTH + halo; c += CRV__LANES) {
        const vf before = vf_load(&s->depth[r - dr][c - dx]);
        const vf own = vf_load(&s->depth[r][c]),
                 next = vf_load(&s->depth[r + dr][c + dx]);
        vf_store(line + c, distance_of(p, before, own, next, vf_load(further + c + dx)));
    }
}

/* Takes an axis' distances of a row, on both sides, into account. */
CRV__INLINE void take_row(surroundings *s, int32_t r, const float *behind, float most,
                          float step)
{
    float *ahead = s->ahead[r - TOP], *least = s->least[r - TOP];
    const vf limit = vf_set(most), infinity = vf_set(INFINITY);
    for (int32_t c = 0; c < WIDTH; c += CRV__LANES) {
        const vf a = vf_load(ahead + c), b = vf_load(behind + c);
        const vm both = vm_and(vf_le(a, limit), vf_le(b, limit));
        const vf width = vf_select(both, (a + b) * vf_set(step), infinity);
        vf_store(least + c, vf_min(width, vf_load(least + c)));
    }
}

/* An axis that goes from row to row, dx columns aside. */
static void scan_rows(surroundings *s, const crv__params *p, int32_t dx, float most,
                      float step)
{
    for (int32_t c = 0; c < PITCH; c++)
        s->line[0][c] = s->line[1][c] = INFINITY;
    for (int32_t r = TOP + HEIGHT + HALO - 1, turn = 0; r >= TOP; r--, turn = !turn) {
        scan_row(s, p, r, dx, 1, s->line[turn], s->line[!turn]);
        if (r < TOP + HEIGHT)
            __builtin_memcpy(s->ahead[r - TOP], s->line[!turn] + FIRST,
                             sizeof s->ahead[0]);
    }
    for (int32_t c = 0; c < PITCH; c++)
        s->line[0][c] = s->line[1][c] = INFINITY;
    for (int32_t r = TOP - HALO, turn = 0; r < TOP + HEIGHT; r++, turn = !turn) {
        scan_row(s, p, r, -dx, -1, s->line[turn], s->line[!turn]);
        if (r >= TOP)
            take_row(s, r, s->line[!turn] + FIRST, most, step);
    }
}

/* The axis along a row: events by vectors, then both scans at once. */
static void scan_columns(surroundings *s, const crv__params *p, float most, float step)
{
    float *ahead = s->line[0], *behind = s->line[1];
    const vf none = vf_set(-2); /* an event's distance is not negative */
    for (int32_t r = TOP; r < TOP + HEIGHT; r++) {
        const float *row = s->depth[r];
        for (int32_t c = PAD; c < PITCH - PAD; c += CRV__LANES) {
            const vf left = vf_load(row + c - 1), own = vf_load(row + c),
                     right = vf_load(row + c + 1);
            vf_store(ahead + c, distance_of(p, left, own, right, none));
            vf_store(behind + c, distance_of(p, right, own, left, none));
        }
        float a = INFINITY, b = INFINITY;
        for (int32_t i = PAD; i < FIRST + WIDTH; i++) {
            const int32_t j = PITCH - 1 - i;
            a = ahead[j] >= 0 ? ahead[j] : a + 1;
            b = behind[i] >= 0 ? behind[i] : b + 1;
            ahead[j] = a;
            behind[i] = b;
        }
        __builtin_memcpy(s->ahead[r - TOP], ahead + FIRST, sizeof s->ahead[0]);
        take_row(s, r, behind + FIRST, most, step);
    }
}

CRV__INLINE void write_rows(const crv__frame *f, const surroundings *s,
                            const crv__plane *out, crv__tile tile)
{
    const crv__params *p = f->params;
    for (int32_t y = tile.y0; y < tile.y1; y++) {
        for (int32_t x = tile.x0; x < tile.x1; x += CRV__LANES) {
            const int32_t rest = tile.x1 - x;
            const float *at = &s->depth[y - tile.y0 + TOP][x - tile.x0 + FIRST];
            const vf d = vf_load(at), infinity = vf_set(INFINITY);
            const vf steps = vf_load(&s->least[y - tile.y0][x - tile.x0]);
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
    const float straight = HALO - 0.5f, diagonal = 22.5f; /* times sqrt(2): 31.8 px */
    const float oblique = length_of(p->inv_fx, p->inv_fy);
    surroundings s;
    copy_depth(&s, &f->depth[0], tile);
    for (int32_t r = 0; r < HEIGHT; r++)
        for (int32_t c = 0; c < WIDTH; c++)
            s.least[r][c] = INFINITY;
    scan_columns(&s, p, straight, p->inv_fx);
    scan_rows(&s, p, 0, straight, p->inv_fy);
    scan_rows(&s, p, 1, diagonal, oblique);
    scan_rows(&s, p, -1, diagonal, oblique);
    write_rows(f, &s, out, tile);
}
