/* SPDX-License-Identifier: MIT */
#include "core/pattern.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { MOST_CANDIDATES = 256 };

static const double PI = 3.14159265358979323846;

/* A 64-bit linear congruential generator; its high bits are what is used. */
static double next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

/* The additive recurrence on the powers of 1/g, g the real root of g^4 = g + 1: the i-th
 * point of a low-discrepancy sequence in the unit cube, shifted by the seed. */
static void cube_point(int32_t i, int32_t seed, double out[3])
{
    const double g = 1.2207440846057596;
    uint64_t state = (uint64_t)(uint32_t)seed * 0x9e3779b97f4a7c15u + 0x7654321u;
    double step = 1;
    for (int k = 0; k < 3; k++) {
        const double start = seed ? next_random(&state) : 0.5;
        step /= g;
        out[k] = fmod(start + (i + 1) * step, 1);
    }
}

static void put(float *point, double x, double y)
{
    point[0] = (float)x;
    point[1] = (float)y;
    point[2] = (float)sqrt(fmax(0, 1 - x * x - y * y));
    point[3] = 1;
}

/* The squared distance of (x, y) to the nearest of the points, each counted at -p too
 * where `paired`. */
static double nearest(const float *points, int32_t count, int32_t stride, int paired,
                      double x, double y)
{
    double best = INFINITY;
    for (int32_t i = 0; i < count; i++) {
        const double px = (double)points[4 * i * stride],
                     py = (double)points[4 * i * stride + 1];
        const double own = (x - px) * (x - px) + (y - py) * (y - py);
        const double mirrored = (x + px) * (x + px) + (y + py) * (y + py);
        best = own < best ? own : best; /* fmin() would be a call */
        best = paired && mirrored < best ? mirrored : best;
    }
    return best;
}

/*
 * Best-candidate sampling: each point is the one of many random candidates that is
 * farthest from all before it, which makes every prefix a Poisson-disk set of its own
 * density. The circle's rim counts as half a neighbour, or points would crowd there.
 */
static void best_candidates(float *points, int32_t count, int32_t stride, int paired,
                            int32_t seed)
{
    uint64_t state = (uint64_t)(uint32_t)seed * 0x9e3779b97f4a7c15u + 0x1234567u;
    for (int32_t i = 0; i < count; i++) {
        const int32_t tries = 64 + 4 * i;
        double best = -1, best_x = 0, best_y = 0;
        for (int32_t k = 0; k < tries; k++) {
            const double r = sqrt(next_random(&state)), a = 2 * PI * next_random(&state);
            const double x = r * cos(a), y = r * sin(a);
            double distance =
                fmin(sqrt(nearest(points, i, stride, paired, x, y)), 2 * (1 - r));
            if (paired)
                distance = fmin(distance, 2 * r); /* from its own mirror image */
            if (distance > best) {
                best = distance;
                best_x = x;
                best_y = y;
            }
        }
        put(points + 4 * i * stride, best_x, best_y);
    }
}

/*
 * Lloyd's relaxation: every point moves to the middle of the part of the disk that is
 * nearest to it, which evens out areas and widens the smallest distance. Mirror images
 * move along.
 */
static void relax(float *points, int32_t count, int32_t stride, int paired)
{
    enum { ROUNDS = 6, GRID = 64 };
    double sums[MOST_CANDIDATES][3];
    for (int round = 0; round < ROUNDS; round++) {
        memset(sums, 0, sizeof sums);
        for (int k = 0; k < GRID * GRID; k++) {
            const double x = (k % GRID + 0.5) / GRID * 2 - 1,
                         y = (k / GRID + 0.5) / GRID * 2 - 1;
            if (x * x + y * y > 1)
                continue;
            double best = INFINITY, sign = 1;
            int32_t owner = 0;
            for (int32_t i = 0; i < count * (paired ? 2 : 1); i++) {
                const double side = i < count ? 1 : -1;
                const float *point = points + (ptrdiff_t)4 * (i % count) * stride;
                const double dx = x - side * (double)point[0],
                             dy = y - side * (double)point[1];
                if (dx * dx + dy * dy < best) {
                    best = dx * dx + dy * dy;
                    owner = i % count;
                    sign = side;
                }
            }
            sums[owner][0] += sign * x;
            sums[owner][1] += sign * y;
            sums[owner][2] += 1;
        }
        for (int32_t i = 0; i < count; i++) {
            if (sums[i][2] > 0)
                put(points + (ptrdiff_t)4 * i * stride, sums[i][0] / sums[i][2],
                    sums[i][1] / sums[i][2]);
        }
    }
}

/* Relaxed points keep a distance from the rim, which would weigh it too little: give the
 * k-th nearest to the centre the radius within which k + 1/2 of n belong. `taken` is the
 * share of the area in the middle that belongs to none of them. */
static void equalise_radii(float *points, int32_t count, int32_t stride, double taken)
{
    double radii[MOST_CANDIDATES];
    for (int32_t i = 0; i < count; i++) {
        const float *point = points + (ptrdiff_t)4 * i * stride;
        radii[i] = hypot((double)point[0], (double)point[1]);
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t rank = 0;
        for (int32_t k = 0; k < count; k++)
            rank += radii[k] < radii[i] || (radii[k] == radii[i] && k < i);
        float *point = points + (ptrdiff_t)4 * i * stride;
        const double r = sqrt(taken + (1 - taken) * (rank + 0.5) / count);
        const double angle = atan2((double)point[1], (double)point[0]);
        put(point, r * cos(angle), r * sin(angle));
    }
}

/* The squared distance of (x, y) to the nearest of the points but the one at `skip`. */
static double nearest_other(const float *points, int32_t count, int32_t stride,
                            int paired, int32_t skip, double x, double y)
{
    const float *rest = points + (ptrdiff_t)4 * (skip + 1) * stride;
    double best = fmin(nearest(points, skip, stride, paired, x, y),
                       nearest(rest, count - skip - 1, stride, paired, x, y));
    return paired ? fmin(best, 4 * (x * x + y * y)) : best;
}

/* New radii bring some points near each other: turn each about the centre to where its
 * nearest neighbour is farther away, which never brings the nearest two nearer. */
static void turn_apart(float *points, int32_t count, int32_t stride, int paired)
{
    enum { ROUNDS = 8, TURNS = 8 };
    for (int round = 0; round < ROUNDS; round++) {
        /* From about the distance of neighbours down to a part of it. */
        const double widest = 2.5 / sqrt(count * (paired ? 2.0 : 1.0)) / (1 + round);
        for (int32_t i = 0; i < count; i++) {
            float *point = points + (ptrdiff_t)4 * i * stride;
            const double x = (double)point[0], y = (double)point[1], r = hypot(x, y);
            double best = nearest_other(points, count, stride, paired, i, x, y);
            double best_x = x, best_y = y;
            for (int k = -TURNS; k <= TURNS; k++) {
                const double turn = fmin(PI, widest / r) * k / TURNS;
                const double tx = x * cos(turn) - y * sin(turn);
                const double ty = x * sin(turn) + y * cos(turn);
                const double distance =
                    nearest_other(points, count, stride, paired, i, tx, ty);
                if (distance > best) {
                    best = distance;
                    best_x = tx;
                    best_y = ty;
                }
            }
            put(point, best_x, best_y);
        }
    }
}

/* The distance of two points, to both images of the second where `paired`. */
static double apart(const float *a, const float *b, int paired)
{
    const double dx = (double)a[0] - (double)b[0], dy = (double)a[1] - (double)b[1];
    const double sx = (double)a[0] + (double)b[0], sy = (double)a[1] + (double)b[1];
    const double own = sqrt(dx * dx + dy * dy);
    return paired ? 0.5 * (own + sqrt(sx * sx + sy * sy)) : own;
}

/*
 * Levels of detail take prefixes. The next point is always the one that brings the energy
 * distance (Szekely, Rizzo 2013) of those so far to the whole set down to its least: that
 * distance is the mean square, over all half-planes, of the difference between their
 * shares of the two, and a half-plane is what a wall leaves of the disk.
 */
static void order_for_prefixes(float *points, int32_t count, int32_t stride, int paired)
{
    double all[MOST_CANDIDATES] = {0}, taken[MOST_CANDIDATES] = {0};
    for (int32_t i = 0; i < count; i++) {
        for (int32_t k = 0; k < count; k++)
            all[i] += apart(points + (ptrdiff_t)4 * i * stride,
                            points + (ptrdiff_t)4 * k * stride, paired);
    }
    for (int32_t i = 0; i < count; i++) {
        /* The two sums of the energy distance that the choice changes. */
        int32_t best = i;
        for (int32_t k = i + 1; k < count; k++) {
            if (all[k] / count - taken[k] / (i + 1)
                < all[best] / count - taken[best] / (i + 1))
                best = k;
        }
        float *here = points + (ptrdiff_t)4 * i * stride, moved[4];
        float *there = points + (ptrdiff_t)4 * best * stride;
        memcpy(moved, here, sizeof moved);
        memmove(here, there, sizeof moved);
        memcpy(there, moved, sizeof moved);
        all[best] = all[i];
        taken[best] = taken[i];
        for (int32_t k = i + 1; k < count; k++)
            taken[k] += apart(here, points + (ptrdiff_t)4 * k * stride, paired);
    }
}

/* The i-th point of the same recurrence in the unit square, on the powers of the plastic
 * number: of all such sequences the one whose points keep the largest distance. */
static void square_point(int32_t i, int32_t seed, double out[2])
{
    const double g = 1.3247179572447460;
    uint64_t state = (uint64_t)(uint32_t)seed * 0x9e3779b97f4a7c15u + 0x2345678u;
    for (int k = 0; k < 2; k++) {
        const double start = seed ? next_random(&state) : 0.5;
        out[k] = fmod(start + (i + 1) / (k ? g * g : g), 1);
    }
}

/* Best candidates cost the cube of their number. Larger sets get a sequence, mapped to
 * the disk: even, though its points come nearer to each other. */
static void disk_points(float *points, int32_t count, int32_t stride, int paired,
                        double taken, int32_t seed)
{
    if (count <= MOST_CANDIDATES) {
        best_candidates(points, count, stride, paired, seed);
        relax(points, count, stride, paired);
        equalise_radii(points, count, stride, taken);
        turn_apart(points, count, stride, paired);
        order_for_prefixes(points, count, stride, paired);
        return;
    }
    for (int32_t i = 0; i < count; i++) {
        double square[2], x, y;
        square_point(i, seed, square);
        crv__concentric(square[0], square[1], &x, &y);
        put(points + (ptrdiff_t)4 * i * stride, x, y);
    }
}

void crv__pattern_disk(float *points, int32_t count, int32_t seed)
{
    disk_points(points, count, 1, 0, 0, seed);
}

void crv__pattern_disk_pairs(float *points, int32_t count, int32_t seed)
{
    disk_points(points, count / 2, 2, 1, count % 2 ? 1.0 / count : 0, seed);
    for (int32_t i = 0; i + 1 < count; i += 2) {
        memcpy(points + 4 * (i + 1), points + 4 * i, 4 * sizeof *points);
        points[4 * (i + 1)] *= -1;
        points[4 * (i + 1) + 1] *= -1;
    }
    if (count % 2)
        put(points + 4 * (count - 1), 0, 0);
}

void crv__pattern_cube(float *points, int32_t count, int32_t seed)
{
    for (int32_t i = 0; i < count; i++) {
        double cube[3];
        cube_point(i, seed, cube);
        for (int k = 0; k < 3; k++)
            points[4 * i + k] = (float)fmin(cube[k], 0.99999994);
        points[4 * i + 3] = 1;
    }
}

void crv__concentric(double u, double v, double *x, double *y)
{
    const double a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) {
        *x = *y = 0;
        return;
    }
    const int wide = fabs(a) > fabs(b);
    const double r = wide ? a : b;
    const double angle = wide ? PI / 4 * (b / a) : PI / 2 - PI / 4 * (a / b);
    *x = r * cos(angle);
    *y = r * sin(angle);
}
