/* SPDX-License-Identifier: MIT */
/* The noise tile: ranges, stratification, seeds. */
#include "fixture.h"

#include "core/noise.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static crv__noise_texel *make(int32_t size, double sector, int32_t seed)
{
    crv__noise_texel *tile = malloc((size_t)(size * size) * sizeof *tile);
    uint32_t *scratch = malloc((size_t)(size * size) * sizeof *scratch);
    crv__noise_fill(tile, size, sector, seed, scratch);
    free(scratch);
    return tile;
}

static void tiles_are_stratified(void **state)
{
    (void)state;
    static const int32_t SIZES[] = {1, 2, 3, 4, 5, 8, 17, 64},
                         SEEDS[] = {0, 1, 2147483647};
    static uint8_t alphas[64 * 64], betas[64 * 64];
    const double sector = PI / 4;
    for (int k = 0; k < 8 * 3; k++) {
        const int32_t count = SIZES[k / 3] * SIZES[k / 3];
        crv__noise_texel *tile = make(SIZES[k / 3], sector, SEEDS[k % 3]);
        memset(alphas, 0, sizeof alphas);
        memset(betas, 0, sizeof betas);
        for (int32_t i = 0; i < count; i++) {
            const double c = (double)tile[i].cos_alpha, s = (double)tile[i].sin_alpha;
            assert_true(fabs(c * c + s * s - 1) < 1e-6);
            const double alpha = atan2(s, c);
            assert_true(alpha >= -1e-7 && alpha < sector);
            assert_true(tile[i].beta > -1 && tile[i].beta < 1);
            alphas[(int)fmin(count - 1, fmax(0, alpha / sector * count))]++;
            betas[(int)(((double)tile[i].beta + 1) / 2 * count)]++;
        }
        /* One value in each stratum; a seed's shift rounds some to a neighbour, and where
         * count is no power of two the radical inverse leaves gaps. */
        int32_t doubled = 0;
        for (int32_t i = 0; i < count; i++)
            doubled += (alphas[i] != 1) + (SIZES[k / 3] % 2 == 0 && betas[i] != 1);
        assert_true(SEEDS[k % 3] ? doubled <= 4 + count / 50 : doubled == 0);
        free(tile);
    }
}

/* Rotation and jitter together: each quarter of the tile's pairs falls into each quarter
 * of their square. */
static void pairs_are_spread(void **state)
{
    (void)state;
    crv__noise_texel *tile = make(4, 1, 0);
    int cells[4][4] = {{0}};
    for (int i = 0; i < 16; i++) {
        const double alpha = atan2((double)tile[i].sin_alpha, (double)tile[i].cos_alpha);
        cells[(int)(alpha * 4)][(int)(((double)tile[i].beta + 1) * 2)]++;
    }
    for (int i = 0; i < 16; i++)
        assert_int_equal(cells[i / 4][i % 4], 1);
    free(tile);
}

/* Every line of four pixels, and every 2x2 block, holds all quarters of the rotation and
 * of the jitter, every line those of the sector offset, too. */
static void lines_hold_all_quarters(void **state)
{
    (void)state;
    static const int LINES[3][4] = {{0, 1, 2, 3}, {0, 4, 8, 12}, {0, 1, 4, 5}};
    crv__noise_texel *tile = make(4, 1, 0);
    for (int k = 0; k < 3 * 4; k++) {
        static const int FIRST[3][4] = {{0, 4, 8, 12}, {0, 1, 2, 3}, {0, 2, 8, 10}};
        unsigned found[3] = {0};
        for (int i = 0; i < 4; i++) {
            const crv__noise_texel *t = &tile[FIRST[k / 4][k % 4] + LINES[k / 4][i]];
            const double alpha = atan2((double)t->sin_alpha, (double)t->cos_alpha);
            found[0] |= 1u << (int)(alpha * 4);
            found[1] |= 1u << (int)(((double)t->beta + 1) * 2);
            found[2] |= 1u << (int)((double)t->sector_offset * 4);
        }
        assert_int_equal(found[0], 15);
        assert_int_equal(found[1], 15);
        assert_true(found[2] == 15 || k / 4 == 2);
    }
    free(tile);
}

static void seeds_make_other_tiles(void **state)
{
    (void)state;
    crv__noise_texel *a = make(4, 1, 3), *b = make(4, 1, 3), *c = make(4, 1, 4);
    assert_memory_equal(a, b, 16 * sizeof *a);
    assert_memory_not_equal(a, c, 16 * sizeof *a);
    free(a);
    free(b);
    free(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_are_stratified),
        cmocka_unit_test(pairs_are_spread),
        cmocka_unit_test(lines_hold_all_quarters),
        cmocka_unit_test(seeds_make_other_tiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
