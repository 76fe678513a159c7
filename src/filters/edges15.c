/* SPDX-License-Identifier: MIT */
/*
 * Two one-dimensional passes, each of three levels that take the neighbours 1, 2 and then
 * 4 pixels away: 15 taps by 6. What two pixels p and q, k apart, have in common is
 * computed once for both,
 *
 *     e(p, q) = max(0, min(1 - D/filter_depth, 1 - (1 - n_p.n_q)/N))
 *     D       = (3 min(a, b) + max(a, b))/4  if k = 1, else min(a, b)
 *     a, b    = |d_q - d_p - k s_p|, |d_q - d_p - k s_q|       s: slope of the depth
 *     N       = 1 - cos filter_normal
 *
 * and a level is a mean of the one before, with the edges l and r to both neighbours:
 *
 *     v'(p) = (w v(p) + u l v(p - k) + u r v(p + k)) / (w + u l + u r)
 *
 * At k = 1 and 2, w = 1 and u = 1/2. Over a flat surface that is 1 2 3 4 3 2 1, a box of
 * 4 twice: a pattern of 4 pixels, that of the noise tile, is gone. Neighbours 2 and 4
 * pixels away are compared with the pixel itself, so that things as thin as that, beside
 * each other, are averaged over the gaps between them.
 *
 * At k = 4, u = 1/3, and w tells how much was found until then: from T = 1/4 (nothing)
 * to 1, the product of both denominators over that on a flat surface,
 *
 *     o = min(1, 2 T),  w = o^2.
 *
 * A pixel that has found little is averaged over more. Beside an edge, a mean of more
 * pixels on one side is not the value at the pixel: at k = 2, l and r lose 1/4, and at
 * k = 4 o/2 of what they exceed min(l, r) by.
 *
 * A pixel with an edge on both sides would hardly be filtered and would flicker. Such a
 * lonely pixel takes a little of its neighbours: its l and r of k = 1 are at least
 *
 *     0.1 max(0, 1 - l - r)
 *
 * Packed edges and lonely pixels are Filip Strugar's: XeGTAO, Intel, 2021. Levels of
 * growing distance are Holger Dammertz, Daniel Sewtz, Johannes Hanika and Hendrik
 * Lensch's: Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination
 * Filtering, HPG 2010. The edges' slopes, the weights and the adaptive third level are
 * this project's.
 */
#include "core/registry.h"
#include "filters/tap.h"

enum { RADIUS = 1 + 2 + 4, LENGTH = 2 * RADIUS + 1, LAST_STEP = 4 };

static const float STRICT = 0.25f, LONELY = 0.1f;
static const float NEAR_WEIGHT = 0.5f, NEAR_EVENNESS = 0.25f; /* at 1 and 2; at 2 */
static const float FAR_WEIGHT = 1.0f / 3, FAR_EVENNESS = 0.5f;

/* A pixel of the window along the axis of a pass. */
typedef struct place {
    bool is_tap;
    float depth, slope;
    crv__vec3 normal;
} place;

/* What a pixel and its two neighbours at a level weigh. */
typedef struct weights {
    float own, before, after;
} weights;

static place place_at(const crv__frame *f, const crv__plane *input, int32_t x, int32_t y,
                      int32_t pass)
{
    if (!crv__plane_holds(input, x, y) || isnan(*crv__plane_at(input, x, y)))
        return (place){false};
    place p = {.depth = *crv__plane_at(&f->depth[0], x, y),
               .normal = crv__normal_at(f, x, y)};
    p.is_tap = p.depth < INFINITY;
    if (f->params->filter_slope)
        p.slope = crv__slope(&f->depth[0], x, y, pass == 0, pass == 1, p.depth);
    return p;
}

/* e of two pixels, b `apart` after a. */
static float edge(const crv__params *p, const place *a, const place *b, int32_t apart)
{
    if (!a->is_tap || !b->is_tap)
        return 0;
    const float rise = b->depth - a->depth;
    const float first = fabsf(rise - (float)apart * a->slope),
                second = fabsf(rise - (float)apart * b->slope);
    const float less = fminf(first, second), more = fmaxf(first, second);
    const float off = apart == 1 ? less + STRICT * (more - less) : less;
    const float turned = 1 - crv__dot(a->normal, b->normal);
    return fmaxf(0, fminf(1 - off / p->filter_depth, 1 - turned * p->filter_normal));
}

/* The sides' weights, nearer to their smaller one by this share. */
static weights evened(float own, float before, float after, float share)
{
    const float both = fminf(before, after);
    return (weights){own, before - share * (before - both),
                     after - share * (after - both)};
}

static weights weigh(const crv__params *p, const place *centre, int32_t step, float found)
{
    const place *before = centre - step, *after = centre + step;
    const float l = edge(p, before, centre, step), r = edge(p, centre, after, step);
    if (step == 1) {
        const float least = LONELY * fmaxf(0, 1 - l - r);
        return (weights){1, before->is_tap ? NEAR_WEIGHT * fmaxf(l, least) : 0,
                         after->is_tap ? NEAR_WEIGHT * fmaxf(r, least) : 0};
    }
    if (step < LAST_STEP)
        return evened(1, NEAR_WEIGHT * l, NEAR_WEIGHT * r, NEAR_EVENNESS);
    const float o = fminf(1, 2 * found);
    return evened(o * o, FAR_WEIGHT * l, FAR_WEIGHT * r, FAR_EVENNESS * o);
}

static crv__estimate filter(const crv__frame *f, const crv__picture *input, int32_t pass,
                            int32_t x, int32_t y)
{
    place line[LENGTH];
    crv__estimate values[LENGTH] = {0};
    for (int32_t i = 0; i < LENGTH; i++) {
        const int32_t u = pass == 0 ? x + i - RADIUS : x,
                      v = pass == 1 ? y + i - RADIUS : y;
        line[i] = place_at(f, &input->accessibility, u, v, pass);
        if (line[i].is_tap)
            values[i] = crv__estimate_at(input, u, v);
    }
    float found = 1;
    for (int32_t step = 1; step <= LAST_STEP; step *= 2)
        for (int32_t i = 2 * step - 1; i < LENGTH; i += 2 * step) { /* the next reads */
            const weights w = weigh(f->params, &line[i], step, found);
            crv__tap_sum sum = {{0}, 0};
            crv__tap_add(&sum, &values[i], w.own);
            crv__tap_add(&sum, &values[i - step], w.before);
            crv__tap_add(&sum, &values[i + step], w.after);
            values[i] = crv__tap_mean(&sum);
            if (i == RADIUS)
                found *= (1 + w.before + w.after) / (1 + 2 * NEAR_WEIGHT);
        }
    return values[RADIUS];
}

static const char *const OPTIONS[] = {"filter_depth", "filter_slope", "filter_normal",
                                      NULL};

const crv__filter crv__filter_edges15 = {
    .info = {.name = "edges15",
             .title =
                 "Two 1-D passes of 15 taps in three levels, weighted by packed edges",
             .paper = "Strugar 2021: XeGTAO (packed edges); Dammertz, Sewtz, Hanika, "
                      "Lensch 2010: Edge-Avoiding A-Trous Wavelet Transform",
             .options = OPTIONS},
    .passes = 2,
    .radius_px = RADIUS,
    .filter = filter};
