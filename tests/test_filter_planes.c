/* SPDX-License-Identifier: MIT */
/*
 * Kernels filter accessibility and bent normals with one set of weights: a component that
 * holds what accessibility holds comes out as accessibility does, and that is the same to
 * the bit with bent normals as without.
 */
#include "fixture.h"

#include "core/context.h"
#include "core/registry.h"
#include "cpu/kernels/kernel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 200, PITCH = 208, HEIGHT = 130, COUNT = PITCH * HEIGHT };

static float depth[COUNT], normal[3][COUNT], values[COUNT], minus[COUNT];
static float alone[COUNT], together[4][COUNT];

static crv__plane plane_of(float *data)
{
    return (crv__plane){data, PITCH, 0, 0, WIDTH, HEIGHT};
}

/* A floor with waves, a box on it, a hole, and noise in (0, 1). */
static void make_scene(void)
{
    uint32_t state = 1;
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t x = i % PITCH, y = i / PITCH;
        const double slope = 0.3 * cos(0.1 * x), length = sqrt(1 + slope * slope);
        const bool box = x > 60 && x < 140 && y > 40 && y < 100;
        depth[i] = box ? 4 + 0.01f * (float)x : 6 + 0.03f * sinf(0.1f * (float)x);
        if ((x - 150) * (x - 150) + (y - 60) * (y - 60) < 400)
            depth[i] = INFINITY;
        normal[0][i] = box ? 0 : (float)(slope / length);
        normal[1][i] = 0;
        normal[2][i] = box ? 1 : (float)(1 / length);
        state = state * 1664525u + 1013904223u;
        values[i] = 0.1f + 0.8f * (float)(state >> 8) / (float)(1 << 24);
        minus[i] = -values[i];
    }
}

static void run_kernel(crv__filter_kernel kernel, const crv__frame *frame,
                       const crv__picture *input, const crv__picture *out)
{
    for (int32_t y = 0; y < HEIGHT; y += CRV__FILTER_TILE_HEIGHT)
        for (int32_t x = 0; x < WIDTH; x += CRV__FILTER_TILE_WIDTH) {
            const int32_t right = x + CRV__FILTER_TILE_WIDTH,
                          bottom = y + CRV__FILTER_TILE_HEIGHT;
            const crv__tile tile = {x, right < WIDTH ? right : WIDTH, y,
                                    bottom < HEIGHT ? bottom : HEIGHT};
            kernel(frame, input, out, tile);
        }
}

typedef void (*check)(crv__filter_kernel kernel, const crv__frame *frame);

static void check_weights(crv__filter_kernel kernel, const crv__frame *frame)
{
    crv__picture input = {.accessibility = plane_of(values)},
                 out = {.accessibility = plane_of(alone)};
    make_scene();
    run_kernel(kernel, frame, &input, &out);
    input.bent[0] = plane_of(values);
    input.bent[1] = plane_of(minus);
    input.bent[2] = plane_of(normal[1]); /* zeros */
    out.accessibility = plane_of(together[0]);
    for (int k = 0; k < 3; k++)
        out.bent[k] = plane_of(together[k + 1]);
    run_kernel(kernel, frame, &input, &out);
    double change = 0;
    for (int32_t i = 0; i < COUNT; i++) {
        if (i % PITCH >= WIDTH)
            continue;
        assert_true(together[0][i] == alone[i]);
        if (!(depth[i] < INFINITY))
            continue;
        /* Background, 1 in one plane and 0 in others, weighs up to a rounding error. */
        assert_true(fabsf(together[1][i] - alone[i]) < 1e-6f);
        assert_true(together[2][i] == -together[1][i]);
        assert_true(together[3][i] == 0);
        change += fabs((double)(alone[i] - values[i]));
    }
    assert_true(change > 0.05 * WIDTH * HEIGHT); /* noise of 0.2 has been filtered */
}

/* What is left of the floor lies in one corner of the tiles that it touches, or else all
 * corners have a pixel of it, too far to be in the windows of others. */
static void check_background(crv__filter_kernel kernel, const crv__frame *frame)
{
    const crv__picture input = {.accessibility = plane_of(values)},
                       few = {.accessibility = plane_of(alone)},
                       many = {.accessibility = plane_of(together[0])};
    make_scene();
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t x = i % PITCH, y = i / PITCH;
        if (x < 30 || x >= 50 || y < 20 || y >= 53)
            depth[i] = INFINITY;
    }
    run_kernel(kernel, frame, &input, &few);
    static const int32_t X[] = {0, CRV__FILTER_TILE_WIDTH - 1, WIDTH - 1},
                         Y[] = {0, CRV__FILTER_TILE_HEIGHT - 1, HEIGHT - 1};
    for (int k = 0; k < 9; k++)
        depth[Y[k / 3] * PITCH + X[k % 3]] = 6;
    run_kernel(kernel, frame, &input, &many);
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t x = i % PITCH, y = i / PITCH;
        if (x >= 30 && x < 50 && y >= 20 && y < 53)
            assert_true(alone[i] == together[0][i] && alone[i] < 1);
        else if (x < WIDTH && !(depth[i] < INFINITY))
            assert_true(alone[i] == 1 && together[0][i] == 1);
    }
}

static void for_every_kernel(check check_kernel)
{
    const crv__params params = {.width = WIDTH,
                                .height = HEIGHT,
                                .filter_depth = 0.1f,
                                .filter_slope = 1,
                                .filter_normal = 10};
    const crv__plane depths = plane_of(depth);
    const crv__plane normals[3] = {plane_of(normal[0]), plane_of(normal[1]),
                                   plane_of(normal[2])};
    const crv__frame frame = {.params = &params, .depth = &depths, .normal = normals};
    for (int isa = 0; isa < 32; isa++) {
        if (!(crv_isa_available() >> isa & 1))
            continue;
        crv_context_desc desc;
        crv_context_desc_init(&desc, sizeof desc);
        desc.isa_mask = 1u << isa;
        crv_context *context = NULL;
        assert_int_equal(crv_context_create(&desc, &context), CRV_OK);
        for (int k = 0; k < CRV__FILTER_COUNT && context->kernels; k++)
            check_kernel(context->kernels->filters[k], &frame);
        crv_context_destroy(context);
    }
}

static void planes_share_their_weights(void **state)
{
    (void)state;
    for_every_kernel(check_weights);
}

static void background_in_a_tile_changes_nothing(void **state)
{
    (void)state;
    for_every_kernel(check_background);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_share_their_weights),
        cmocka_unit_test(background_in_a_tile_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
