/* SPDX-License-Identifier: MIT */
/*
 * steps.c: depth that was rounded to a few numbers. Its surfaces are stairs: neighbours
 * are equal in rows and in columns, and the numbers lie on a grid. A floor that is seen
 * along one axis of the picture has equal neighbours in one direction only; boxes that
 * are seen from above have few depths, or such as lie anywhere.
 */
#include "steps.h"

#include <math.h>
#include <string.h>

enum { FEWEST = 32, MOST = 1024 };

typedef struct numbers {
    float value[MOST];
    int32_t count;
} numbers;

/* Keeps the values sorted; false if there are more than MOST. */
static bool insert(numbers *n, float value)
{
    int32_t first = 0, end = n->count;
    while (first < end) {
        const int32_t middle = (first + end) / 2;
        if (n->value[middle] < value)
            first = middle + 1;
        else
            end = middle;
    }
    if (first < n->count && !(n->value[first] > value))
        return true;
    if (n->count == MOST)
        return false;
    memmove(&n->value[first + 1], &n->value[first],
            (size_t)(n->count - first) * sizeof n->value[0]);
    n->value[first] = value;
    n->count++;
    return true;
}

/* Whether a quarter of the places of a grid or more are taken, and no other places. */
static bool lie_on_grid(const numbers *n, float *size)
{
    const double span = (double)n->value[n->count - 1] - (double)n->value[0];
    double step = span;
    for (int32_t i = 1; i < n->count; i++)
        step = fmin(step, (double)n->value[i] - (double)n->value[i - 1]);
    for (int32_t i = 1; i < n->count; i++) {
        const double steps = ((double)n->value[i] - (double)n->value[i - 1]) / step;
        if (fabs(steps - round(steps)) > 0.05)
            return false;
    }
    *size = (float)step;
    return 4.0 * n->count > span / step;
}

int32_t io__depth_steps(const crv_image *depth, float background, float *size)
{
    numbers n = {.count = 0};
    size_t count = 0, as_left = 0, as_above = 0;
    for (int32_t y = 1; y < depth->height; y++)
        for (int32_t x = 1; x < depth->width; x++) {
            const float value = *crv_image_at(depth, x, y, 0);
            if (!isfinite(value) || value >= background)
                continue;
            if (!insert(&n, value))
                return 0;
            count++;
            as_left += !(fabsf(value - *crv_image_at(depth, x - 1, y, 0)) > 0.0f);
            as_above += !(fabsf(value - *crv_image_at(depth, x, y - 1, 0)) > 0.0f);
        }
    const bool has_stairs = 3 * as_left > count && 3 * as_above > count;
    return n.count >= FEWEST && has_stairs && lie_on_grid(&n, size) ? n.count : 0;
}
