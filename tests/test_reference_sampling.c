/* SPDX-License-Identifier: MIT */
/*
 * Scrambled Sobol points: what the construction promises of every seed, and what it
 * promises of seeds among each other.
 */
#include "sampling.h"
#include "test_scene_support.h"

#include <string.h>

enum { SEEDS = 200, LOG_POINTS = 8, POINTS = 1 << LOG_POINTS };

/* Any 2^k points from a multiple of 2^k on put exactly one into every box of 2^-a x
 * 2^-(k-a): the definition of a (0, k, 2)-net. */
static void assert_net(uint32_t first, int k, uint64_t seed)
{
    for (int a = 0; a <= k; a++) {
        unsigned char count[POINTS] = {0};
        for (uint32_t i = 0; i < 1u << k; i++) {
            sample_point p = sampling_owen_sobol(first + i, seed);
            uint32_t u = (uint32_t)(p.u * (double)(1u << a));
            uint32_t v = (uint32_t)(p.v * (double)(1u << (k - a)));
            assert_true(p.u > 0.0 && p.u < 1.0 && p.v > 0.0 && p.v < 1.0);
            count[u << (k - a) | v]++;
        }
        for (uint32_t box = 0; box < 1u << k; box++)
            assert_int_equal(count[box], 1);
    }
}

static void test_stratification(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < SEEDS; seed++)
        for (int k = 0; k <= LOG_POINTS; k++)
            for (uint32_t block = 0; block < 3; block++)
                assert_net(block << k, k, seed * 977u);
    assert_net(65536 - POINTS, LOG_POINTS, 5);
}

/* Owen's scrambling moves points as a tree: points that share their first k bits before
 * share exactly k bits after it. Two scramblings of one sequence show it: the first
 * differing bit of a pair is the same in both. */
static void test_nesting(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 64; i++) {
        for (uint32_t j = 0; j < i; j++) {
            int bit[2][2];
            for (int s = 0; s < 2; s++) {
                sample_point a = sampling_owen_sobol(i, (uint64_t)s + 11u);
                sample_point b = sampling_owen_sobol(j, (uint64_t)s + 11u);
                uint32_t du = (uint32_t)(a.u * 0x1p32) ^ (uint32_t)(b.u * 0x1p32);
                uint32_t dv = (uint32_t)(a.v * 0x1p32) ^ (uint32_t)(b.v * 0x1p32);
                assert_true(du && dv);
                bit[s][0] = (int)floor(log2((double)du));
                bit[s][1] = (int)floor(log2((double)dv));
            }
            assert_int_equal(bit[0][0], bit[1][0]);
            assert_int_equal(bit[0][1], bit[1][1]);
        }
    }
}

/* Over seeds each point is uniform, and the two coordinates, as well as the same point of
 * neighbouring seeds, are uncorrelated: means of N products of variance 1/144 stay within
 * 5 standard deviations. */
static void test_independence(void **state)
{
    enum { N = 20000 };
    double limit = 5.0 / sqrt((double)N);
    (void)state;
    for (uint32_t i = 0; i < 8; i++) {
        double mean = 0.0, square = 0.0, uv = 0.0, neighbour = 0.0;
        for (uint64_t seed = 0; seed < N; seed++) {
            sample_point p = sampling_owen_sobol(i, seed);
            sample_point q = sampling_owen_sobol(i, seed + 1);
            mean += (p.u - 0.5) / N;
            square += ((p.v - 0.5) * (p.v - 0.5) - 1.0 / 12.0) / N;
            uv += (p.u - 0.5) * (p.v - 0.5) / N;
            neighbour += (p.u - 0.5) * (q.u - 0.5) / N;
        }
        assert_true(fabs(mean) < limit * sqrt(1.0 / 12.0));
        assert_true(fabs(square) < limit * sqrt(1.0 / 180.0));
        assert_true(fabs(uv) < limit / 12.0);
        assert_true(fabs(neighbour) < limit / 12.0);
    }
}

/* Error of the area of a quarter disk over the number of points, rms over the seeds:
 * n^-1/2 for independent points. For an indicator function in two dimensions scrambled
 * nets reach n^-3/4; n^-0.65 leaves room for the estimate of the rms from 200 seeds (5
 * %). */
static void test_convergence(void **state)
{
    double former = 0.0;
    (void)state;
    for (int k = 4; k <= 12; k += 4) {
        double rms = 0.0;
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            double sum = 0.0;
            for (uint32_t i = 0; i < 1u << k; i++) {
                sample_point p = sampling_owen_sobol(i, seed);
                sum += p.u * p.u + p.v * p.v < 1.0 ? 1.0 : 0.0;
            }
            rms += pow(sum / (double)(1u << k) - PI / 4.0, 2.0) / SEEDS;
        }
        rms = sqrt(rms);
        print_message("%4u points: error %.2e\n", 1u << k, rms);
        if (former > 0.0)
            assert_true(rms < former * pow(16.0, -0.65));
        former = rms;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stratification), cmocka_unit_test(test_nesting),
        cmocka_unit_test(test_independence), cmocka_unit_test(test_convergence)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
