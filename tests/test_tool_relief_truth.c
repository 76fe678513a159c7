/* SPDX-License-Identifier: MIT */
/* The rays through height maps that the report holds the library's relief to. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "study/claims_relief_truth.h"

static void a_flat_map_is_open(void **state)
{
    static relief_map map = {.size = 2.0, .scale = 0.1};
    relief_value v;
    (void)state;

    v = relief_trace(&map, 0.3, 1.7, 0.4, 16, 5);
    assert_true(fabs(v.none - 1.0) < 1e-12);
    assert_true(fabs(v.cubic - 1.0) < 1e-12);
    /* A share of the volume: the mean over 256 directions of 2 cos^2, which is 1. */
    assert_true(fabs(v.sphere - 1.0) < 0.01);
}

/* Falloff none and the tangent sphere; the function has the forms. */
static void a_groove_meets_the_closed_forms(void **state)
{
    (void)state;
    /* 64x64 strata: a step function is off by about a stratum's edge, 1/64 of 1/10 of
     * them; steps of 1/48 radius are refined to where the line meets the slope. */
    assert_true(relief_trace_error() < 0.003);
}

/* By hand: at the foot of a wall that is high and all but vertical, half of the sky is
 * blocked within the radius. A step of the map rises over one texel, 1/64 unit. */
static void a_wall_blocks_half(void **state)
{
    static relief_map map;
    relief_value v;
    (void)state;

    map.size = 2.0;
    map.scale = 10.0;
    for (int i = 0; i < RELIEF_TEXELS * RELIEF_TEXELS; i++)
        map.texels[i] = i % RELIEF_TEXELS >= RELIEF_TEXELS / 2 ? 1.0f : 0.0f;
    /* It begins to rise 0.4 texels to the right; the one to the left, beyond the map's
     * edge, is 63 texels away, 0.98 units. */
    v = relief_trace(&map, 2.0 * (RELIEF_TEXELS / 2 - 0.9) / RELIEF_TEXELS, 1.0, 0.9, 64,
                     1);
    assert_true(fabs(v.none - 0.5) < 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_map_is_open),
        cmocka_unit_test(a_groove_meets_the_closed_forms),
        cmocka_unit_test(a_wall_blocks_half),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
