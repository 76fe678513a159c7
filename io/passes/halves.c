/* SPDX-License-Identifier: MIT */
/*
 * halves.c: a plane is linear in the inverse of its depth, so that the inverse should
 * have no second differences along a row or a column, except at edges. Successive
 * over-relaxation (Young 1950) of that equation, every value held between the bounds that
 * its rounding leaves.
 */
#include "halves.h"

#include <math.h>
#include <stdlib.h>

enum { SWEEPS = 40 };

static const float relaxation = 1.6f;

/* Steps that a second difference may have: beyond, it is an edge. */
static const float flat_steps = 4.0f;

typedef struct inverse_depth {
    int32_t width, height;
    float *value, *half_step; /* half_step 0: background */
} inverse_depth;

/* Of half floats: 11 significant bits, none below 2^-14. */
static float half_step_of(float value)
{
    int exponent;
    frexpf(value, &exponent);
    return ldexpf(1.0f, (exponent < -13 ? -13 : exponent) - 12);
}

/* The value halfway between two neighbours, if all three lie on one surface. */
static bool predict(const inverse_depth *u, size_t i, size_t before, size_t after,
                    float *sum)
{
    if (u->half_step[before] <= 0.0f || u->half_step[after] <= 0.0f)
        return false;
    const float middle = 0.5f * (u->value[before] + u->value[after]);
    const float step =
        fmaxf(u->half_step[i], fmaxf(u->half_step[before], u->half_step[after]));
    if (!(fabsf(middle - u->value[i]) <= flat_steps * step))
        return false;
    *sum += middle;
    return true;
}

static void relax(const inverse_depth *u, const float *given, size_t i, int32_t x,
                  int32_t y)
{
    const size_t width = (size_t)u->width;
    float sum = 0.0f;
    int count = 0;
    if (x > 0 && x < u->width - 1)
        count += predict(u, i, i - 1, i + 1, &sum);
    if (y > 0 && y < u->height - 1)
        count += predict(u, i, i - width, i + width, &sum);
    if (!count)
        return;
    const float moved = u->value[i] + relaxation * (sum / (float)count - u->value[i]);
    u->value[i] =
        fminf(fmaxf(moved, given[i] - u->half_step[i]), given[i] + u->half_step[i]);
}

static void sweep(const inverse_depth *u, const float *given)
{
    for (int32_t y = 0; y < u->height; y++)
        for (int32_t x = 0; x < u->width; x++) {
            const size_t i = (size_t)y * (size_t)u->width + (size_t)x;
            if (u->half_step[i] > 0.0f)
                relax(u, given, i, x, y);
        }
}

static void invert(const crv_image *depth, const inverse_depth *u, float *given)
{
    for (int32_t y = 0; y < u->height; y++)
        for (int32_t x = 0; x < u->width; x++) {
            const size_t i = (size_t)y * (size_t)u->width + (size_t)x;
            const float d = *crv_image_at(depth, x, y, 0);
            const bool surface = d > 0.0f && d < 65504.0f;
            given[i] = u->value[i] = surface ? 1.0f / d : 0.0f;
            u->half_step[i] = surface ? half_step_of(d) / d / d : 0.0f;
        }
}

int io__smooth_halves(const crv_image *depth)
{
    const size_t count = (size_t)depth->width * (size_t)depth->height;
    float *memory = malloc(3 * count * sizeof *memory);
    if (!memory)
        return -1;
    const inverse_depth u = {depth->width, depth->height, memory, memory + count};
    float *given = memory + 2 * count;
    invert(depth, &u, given);
    for (int i = 0; i < SWEEPS; i++)
        sweep(&u, given);
    for (int32_t y = 0; y < u.height; y++)
        for (int32_t x = 0; x < u.width; x++) {
            const size_t i = (size_t)y * (size_t)u.width + (size_t)x;
            if (u.half_step[i] > 0.0f)
                *crv_image_at(depth, x, y, 0) = 1.0f / u.value[i];
        }
    free(memory);
    return 0;
}
