/* SPDX-License-Identifier: MIT */
/*
 * Two one-dimensional passes of 7 taps, weighted by the edges on the way to them. What
 * two neighbours p and q have in common is computed once,
 *
 *     e(p, q) = max(0, 1 - D/filter_depth) max(0, 1 - (1 - n_p.n_q)/N)
 *     D       = (|d_q - d_p - s_p| + |d_q - d_p - s_q|)/2      s: slope of the depth
 *     N       = 1 - cos filter_normal
 *
 * and a tap's weight is the product of the edges between it and the centre:
 *
 *     w(k) = (4 - |k|) e(0, 1) e(1, 2) ... e(k - 1, k)
 *
 * 4 3 2 1 is a box of 4 twice: over a flat surface, a pattern of 4 pixels, that of the
 * noise tile, is gone. Nothing is averaged across an edge, nor what lies behind one.
 *
 * A pixel with an edge on both sides would not be filtered and would flicker. Such a
 * lonely pixel takes a little of its neighbours: its own two edges are at least
 *
 *     0.07 max(0, 1 - e(-1, 0) - e(0, 1))
 *
 * Packed edges and lonely pixels are Filip Strugar's: XeGTAO, Intel, 2021. The running
 * product, the slopes and the weights are this project's.
 */
#include "core/registry.h"
#include "filters/tap.h"

enum { RADIUS = 3 };

static const float LONELY = 0.07f;

static bool is_tap(const crv__frame *f, const crv__plane *input, int32_t x, int32_t y)
{
    return crv__plane_holds(input, x, y) && *crv__plane_at(&f->depth[0], x, y) < INFINITY
           && !isnan(*crv__plane_at(input, x, y));
}

/* e of two neighbours, q to the right of p or below it. */
static float edge(const crv__params *p, const crv__centre *a, const crv__centre *b)
{
    const bool is_below = b->y != a->y;
    const float rise = b->depth - a->depth;
    const float first = fabsf(rise - (is_below ? a->slope_y : a->slope_x)),
                second = fabsf(rise - (is_below ? b->slope_y : b->slope_x));
    const float deviation = (first + second) * 0.5f / p->filter_depth;
    const float turned = 1 - crv__dot(a->normal, b->normal);
    const float likeness = fminf(1, 1 - turned * p->filter_normal);
    return fmaxf(0, 1 - deviation) * fmaxf(0, likeness);
}

/* The edges from (x, y) to the taps 1 to RADIUS on one side; 0 from the first place on
 * that is no tap. Returns how many are taps. */
static int32_t edges_towards(const crv__frame *f, const crv__plane *input, int32_t x,
                             int32_t y, int32_t step_x, int32_t step_y,
                             float edges[RADIUS])
{
    crv__centre near = crv__centre_at(f, x, y);
    for (int32_t k = 0; k < RADIUS; k++) {
        x += step_x;
        y += step_y;
        if (!is_tap(f, input, x, y)) {
            for (int32_t i = k; i < RADIUS; i++)
                edges[i] = 0;
            return k;
        }
        const crv__centre far = crv__centre_at(f, x, y);
        const bool is_forward = step_x + step_y > 0;
        edges[k] =
            is_forward ? edge(f->params, &near, &far) : edge(f->params, &far, &near);
        near = far;
    }
    return RADIUS;
}

static crv__estimate filter(const crv__frame *f, const crv__picture *input, int32_t pass,
                            int32_t x, int32_t y)
{
    const int32_t step_x = pass == 0, step_y = pass == 1;
    float edges[2][RADIUS];
    const crv__plane *taps = &input->accessibility;
    const int32_t count[2] = {edges_towards(f, taps, x, y, -step_x, -step_y, edges[0]),
                              edges_towards(f, taps, x, y, step_x, step_y, edges[1])};
    const float least = LONELY * fmaxf(0, 1 - edges[0][0] - edges[1][0]);
    const crv__estimate own = crv__estimate_at(input, x, y);
    crv__tap_sum sum = {{0}, 0};
    crv__tap_add(&sum, &own, RADIUS + 1);
    for (int32_t side = 0; side < 2; side++) {
        float product = 1;
        for (int32_t k = 1; k <= count[side]; k++) {
            const int32_t at = side ? k : -k;
            const float e = edges[side][k - 1];
            product *= k == 1 ? fmaxf(e, least) : e;
            const float weight = (float)(RADIUS + 1 - k) * product;
            const crv__estimate tap =
                crv__estimate_at(input, x + at * step_x, y + at * step_y);
            crv__tap_add(&sum, &tap, weight);
        }
    }
    return crv__tap_mean(&sum);
}

static const char *const OPTIONS[] = {"filter_depth", "filter_slope", "filter_normal",
                                      NULL};

const crv__filter crv__filter_edges7 = {
    .info = {.name = "edges7",
             .title =
                 "Two 1-D passes of 7 taps, weighted by the edges between the pixels",
             .paper = "Strugar 2021: XeGTAO (packed edges)",
             .options = OPTIONS},
    .passes = 2,
    .radius_px = RADIUS,
    .filter = filter};
