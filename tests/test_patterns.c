/* SPDX-License-Identifier: MIT */
/* The sample patterns: distances, areas, prefixes. */
#include "fixture.h"

#include "core/pattern.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { MOST = 4096 };

static const double PI = 3.14159265358979323846;

typedef void (*fill_fn)(float *points, int32_t count, int32_t seed);
typedef struct pattern {
    const char *name;
    fill_fn fill;
    int paired;
} pattern;

static const pattern DISKS[] = {{"disk", crv__pattern_disk, 0},
                                {"pairs", crv__pattern_disk_pairs, 1}};

static double coordinate(const float *points, int32_t i, int k)
{
    return (double)points[4 * i + k];
}

static double least_distance(const float *points, int32_t count)
{
    double least = INFINITY;
    for (int32_t i = 0; i < count; i++) {
        for (int32_t k = 0; k < i; k++) {
            const double distance =
                hypot(coordinate(points, i, 0) - coordinate(points, k, 0),
                      coordinate(points, i, 1) - coordinate(points, k, 1));
            least = fmin(least, distance);
        }
    }
    return least;
}

/* Every count up to 40, then some; small ones with more seeds. */
static int32_t next_count(int32_t count)
{
    return count < 40 ? count + 1 : count < 64 ? count + 8 : count * 2;
}

/*
 * No n points of the plane keep a larger distance from each other than a hexagonal
 * lattice of the same density: sqrt(2 pi / (sqrt 3 n)) = 1.905 / sqrt(n) in the unit disk
 * (a few more at its rim, which small sets exceed it by). Poisson-disk sets are called
 * good from 0.65 to 0.85 of that (Lagae, Dutre 2008: A Comparison of Methods for
 * Generating Poisson Disk Distributions); random ones have about 1 / n.
 */
static void disks_keep_their_distance(void **state)
{
    (void)state;
    static float points[4 * MOST];
    const double densest = sqrt(2 * PI / sqrt(3)), share = 0.7;
    for (size_t d = 0; d < 2; d++) {
        double worst = INFINITY, sum = 0;
        int32_t sets = 0;
        for (int32_t count = 2; count <= 256; count = next_count(count)) {
            for (int32_t seed = 0; seed < (count < 40 ? 4 : 1); seed++) {
                DISKS[d].fill(points, count, seed);
                const double relative =
                    least_distance(points, count) * sqrt(count) / densest;
                worst = fmin(worst, relative);
                sum += relative;
                sets++;
                assert_true(relative > share);
            }
        }
        printf("%s: distance of %d sets, in that of the densest packing: least %.3f, "
               "mean %.3f\n",
               DISKS[d].name, sets, worst, sum / sets);
    }
}

static void points_lie_in_the_disk(void **state)
{
    (void)state;
    static float points[4 * MOST];
    for (size_t d = 0; d < 2; d++) {
        for (int32_t count = 1; count <= MOST; count = count * 3 / 2 + 1) {
            DISKS[d].fill(points, count, 3);
            for (int32_t i = 0; i < count; i++) {
                const double x = coordinate(points, i, 0), y = coordinate(points, i, 1);
                const double z = coordinate(points, i, 2);
                assert_true(x * x + y * y <= 1 + 1e-6);
                assert_true(fabs(x * x + y * y + z * z - 1) < 1e-6);
                assert_true(points[4 * i + 3] == 1);
            }
        }
    }
}

/*
 * The mean of z = sqrt(1 - r^2) over the disk is 2/3. Radii are the midpoint rule in t =
 * r^2, whose error for sqrt(1 - t) is that at the rim: with h = 1/n it tends to
 * (1 - sqrt(1/2)) |zeta(-1/2)| h^(3/2) = 0.061 h^(3/2). Pairs have n/2 radii, and an odd
 * count the centre, whose chord is 1 where the mean over its share of the area is 1 -
 * h/2.
 */
static void areas_are_even(void **state)
{
    (void)state;
    static float points[4 * MOST];
    for (size_t d = 0; d < 2; d++) {
        for (int32_t count = 2; count <= 256; count = next_count(count)) {
            DISKS[d].fill(points, count, 1);
            double z = 0;
            for (int32_t i = 0; i < count; i++)
                z += coordinate(points, i, 2) / count;
            const double h = 1.0 / count;
            const double bound = DISKS[d].paired ? 0.065 * pow(2 * h, 1.5) + 0.5 * h * h
                                                 : 0.065 * pow(h, 1.5);
            assert_true(fabs(z - 2.0 / 3) < bound + 1e-6);
        }
    }
}

/* The area of the unit disk on one side of a line at this distance from the centre, as a
 * share. */
static double segment(double distance)
{
    return (acos(distance) - distance * sqrt(1 - distance * distance)) / PI;
}

/* The largest error of a half-plane's share of the points. */
static double half_plane_discrepancy(const float *points, int32_t count)
{
    double worst = 0;
    for (int a = 0; a < 24; a++) {
        for (int k = -9; k <= 9; k++) {
            const double c = cos(2 * PI * a / 24 + 0.1), s = sin(2 * PI * a / 24 + 0.1);
            const double at = 0.1 * k;
            int32_t beyond = 0;
            for (int32_t i = 0; i < count; i++)
                beyond +=
                    c * coordinate(points, i, 0) + s * coordinate(points, i, 1) > at;
            worst = fmax(worst, fabs((double)beyond / count - segment(at)));
        }
    }
    return worst;
}

/* Of n random points a half-plane over half of the disk holds a share with the standard
 * deviation 1/2 / sqrt(n), and the worst of these 456 half-planes is off by two to three
 * of them. A wall cuts the disk by such a line, so this is the estimators' own error. */
static void half_planes_are_even(void **state)
{
    (void)state;
    static float points[4 * MOST];
    for (size_t d = 0; d < 2; d++) {
        double worst = 0;
        for (int32_t count = 4; count <= MOST; count = next_count(count)) {
            DISKS[d].fill(points, count, 2);
            const double relative =
                half_plane_discrepancy(points, count) / (0.5 / sqrt(count));
            worst = fmax(worst, relative);
            assert_true(relative < 1.5);
        }
        printf("%s: worst half-plane, in standard deviations of random points: %.2f\n",
               DISKS[d].name, worst);
    }
}

static void pairs_are_mirrored_exactly(void **state)
{
    (void)state;
    static float points[4 * MOST];
    static const int32_t COUNTS[] = {1, 2, 3, 8, 17, 64, 255, 513, 1024};
    for (size_t k = 0; k < sizeof COUNTS / sizeof COUNTS[0]; k++) {
        const int32_t count = COUNTS[k];
        crv__pattern_disk_pairs(points, count, 5);
        for (int32_t i = 0; i + 1 < count; i += 2) {
            assert_true(points[4 * i] == -points[4 * i + 4]);
            assert_true(points[4 * i + 1] == -points[4 * i + 5]);
            assert_true(points[4 * i + 2] == points[4 * i + 6]);
        }
        if (count % 2) {
            assert_true(points[4 * (count - 1)] == 0);
            assert_true(points[4 * (count - 1) + 1] == 0);
        }
    }
}

/* The root of the mean over half-planes of the squared error of their share. */
static double mean_half_plane_error(const float *points, int32_t count)
{
    double sum = 0;
    for (int a = 0; a < 24; a++) {
        for (int k = -9; k <= 9; k++) {
            const double c = cos(2 * PI * a / 24 + 0.1), s = sin(2 * PI * a / 24 + 0.1);
            int32_t beyond = 0;
            for (int32_t i = 0; i < count; i++)
                beyond +=
                    c * coordinate(points, i, 0) + s * coordinate(points, i, 1) > 0.1 * k;
            const double error = (double)beyond / count - segment(0.1 * k);
            sum += error * error;
        }
    }
    return sqrt(sum / (24 * 19));
}

/*
 * Levels of detail take the first points of a disk: they must be spread over all of it.
 * Sets of their own size, made for that count, are the measure. Points in the order in
 * which they were made have 1.21 times the error of those.
 */
static void prefixes_of_a_disk_are_spread(void **state)
{
    (void)state;
    static float points[4 * MOST], own[4 * MOST];
    const double densest = sqrt(2 * PI / sqrt(3));
    double sum = 0;
    int32_t prefixes = 0;
    for (int32_t count = 12; count <= 192; count *= 2) {
        for (int32_t seed = 0; seed < 4; seed++) {
            crv__pattern_disk(points, count, seed);
            for (int32_t used = count / 3; used < count; used += (count + 5) / 6) {
                const double relative =
                    least_distance(points, used) * sqrt(used) / densest;
                /* Half of them has at worst sqrt(1/2) of the whole set's 0.7; a third,
                 * with sqrt(1/3), has 0.40. */
                assert_true(relative > 0.4);
                assert_true(half_plane_discrepancy(points, used) < 1.2 / sqrt(used));
                crv__pattern_disk(own, used, seed);
                sum += mean_half_plane_error(points, used)
                       / mean_half_plane_error(own, used);
                prefixes++;
            }
        }
    }
    printf("disk: mean error of half-planes of %d prefixes, in that of sets of their own "
           "size: %.3f\n",
           prefixes, sum / prefixes);
    /* A tenth: what a fixed set may fall short of one that is made for the count. */
    assert_true(sum / prefixes < 1.1);
}

/* The largest error of an axis-aligned box at the origin, over a grid of boxes. */
static double box_discrepancy(const float *points, int32_t count)
{
    enum { GRID = 10 };
    double worst = 0;
    for (int k = 0; k < GRID * GRID * GRID; k++) {
        const double a = (k % GRID + 1.0) / GRID, b = (k / GRID % GRID + 1.0) / GRID;
        const double c = (k / GRID / GRID + 1.0) / GRID;
        int32_t inside = 0;
        for (int32_t i = 0; i < count; i++)
            inside += coordinate(points, i, 0) < a && coordinate(points, i, 1) < b
                      && coordinate(points, i, 2) < c;
        worst = fmax(worst, fabs((double)inside / count - a * b * c));
    }
    return worst;
}

/* The error of random points halves when they are four times as many; that of a
 * low-discrepancy sequence in three dimensions falls as (log n)^3 / n, by nearly four. */
static void prefixes_of_the_cube_are_even(void **state)
{
    (void)state;
    static float points[4 * MOST];
    crv__pattern_cube(points, MOST, 0);
    double first = 0, last = 0;
    for (int32_t count = 16; count <= MOST; count *= 4) {
        last = box_discrepancy(points, count);
        first = count == 16 ? last : first;
        printf("cube: discrepancy of the first %d: %.4f\n", count, last);
        /* 1/(2 sqrt n) is one standard deviation of a random share, at worst. */
        assert_true(last < 1 / sqrt(count));
    }
    assert_true(last < first / 20); /* 16 at random; 4^4 = 256 but for the logarithms */
    static float shorter[4 * 100];
    crv__pattern_cube(shorter, 100, 0);
    assert_memory_equal(points, shorter, sizeof shorter);
    for (int32_t i = 0; i < MOST; i++) {
        for (int k = 0; k < 3; k++)
            assert_true(points[4 * i + k] >= 0 && points[4 * i + k] < 1);
    }
}

static void seeds_repeat_and_differ(void **state)
{
    (void)state;
    static const fill_fn FILLS[] = {crv__pattern_disk, crv__pattern_disk_pairs,
                                    crv__pattern_cube};
    static const int32_t COUNTS[] = {12, 300, 1000};
    static float a[4 * 1000], b[4 * 1000];
    for (int f = 0; f < 3; f++) {
        for (int k = 0; k < 3; k++) {
            const int32_t count = COUNTS[k];
            const size_t bytes = (size_t)count * 4 * sizeof(float);
            static const int32_t SEEDS[] = {0, 1, 7, 2147483647};
            for (int s = 0; s < 4; s++) {
                FILLS[f](a, count, SEEDS[s]);
                FILLS[f](b, count, SEEDS[s]);
                assert_memory_equal(a, b, bytes);
                FILLS[f](b, count, SEEDS[(s + 1) % 4]);
                assert_memory_not_equal(a, b, bytes);
            }
        }
    }
}

/* The map keeps areas: a grid of cells becomes parts of the disk of equal size, told by
 * the determinant of its derivatives. */
static void the_concentric_map_keeps_areas(void **state)
{
    (void)state;
    const double h = 1e-5;
    for (int i = 0; i < 400; i++) {
        const double u = (i % 20 + 0.52) / 20, v = (i / 20 + 0.47) / 20;
        double x[4], y[4];
        crv__concentric(u - h, v, &x[0], &y[0]);
        crv__concentric(u + h, v, &x[1], &y[1]);
        crv__concentric(u, v - h, &x[2], &y[2]);
        crv__concentric(u, v + h, &x[3], &y[3]);
        const double area = (x[1] - x[0]) * (y[3] - y[2]) - (x[3] - x[2]) * (y[1] - y[0]);
        assert_true(fabs(fabs(area) / (4 * h * h) - PI) < 1e-3); /* differences: h^2 */
    }
    double x = 1, y = 1;
    crv__concentric(0.5, 0.5, &x, &y);
    assert_true(x == 0 && y == 0);
    crv__concentric(1, 0.5, &x, &y);
    assert_true(fabs(x - 1) < 1e-12 && fabs(y) < 1e-12);
}

/* A figure, not a test: machines differ. */
static void making_them_is_fast(void **state)
{
    (void)state;
    static float points[4 * MOST];
    for (int32_t count = 16; count <= 256; count *= 2) {
        const clock_t start = clock();
        crv__pattern_disk(points, count, 0);
        printf("disk of %d: %.1f ms\n", count,
               1e3 * (double)(clock() - start) / CLOCKS_PER_SEC);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(disks_keep_their_distance),
        cmocka_unit_test(points_lie_in_the_disk),
        cmocka_unit_test(areas_are_even),
        cmocka_unit_test(half_planes_are_even),
        cmocka_unit_test(pairs_are_mirrored_exactly),
        cmocka_unit_test(prefixes_of_a_disk_are_spread),
        cmocka_unit_test(prefixes_of_the_cube_are_even),
        cmocka_unit_test(seeds_repeat_and_differ),
        cmocka_unit_test(the_concentric_map_keeps_areas),
        cmocka_unit_test(making_them_is_fast),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
