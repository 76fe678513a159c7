/* SPDX-License-Identifier: MIT */
/*
 * Two passes of a one-dimensional cross-bilateral filter of 13 taps: Gaussian times
 * proximity in camera-space depth. Morgan McGuire, Brian Osman, Michael Bukowski, Padraic
 * Hennessy: The Alchemy Screen-Space Ambient Obscurance Algorithm, HPG 2011.
 *
 * The paper gives neither the Gaussian's width nor the proximity function. Here sigma is
 * half the filter's radius, so that the last taps still count, and proximity falls
 * linearly to 0 at filter_depth.
 */
#include "core/registry.h"
#include "filters/tap.h"

enum { RADIUS = 6 };

static crv__estimate filter(const crv__frame *f, const crv__picture *input, int32_t pass,
                            int32_t x, int32_t y)
{
    /* exp(-k^2 / (2 sigma^2)), sigma = RADIUS / 2 */
    static const float GAUSS[RADIUS + 1] = {1.0f,        0.94595947f, 0.80073740f,
                                            0.60653066f, 0.41111229f, 0.24935221f,
                                            0.13533528f};
    const crv__centre centre = crv__centre_at(f, x, y);
    const int32_t step_x = pass == 0, step_y = pass == 1;
    crv__tap_sum sum = {{0}, 0};
    for (int32_t k = -RADIUS; k <= RADIUS; k++) {
        crv__tap tap;
        if (!crv__tap_at(f, input, &centre, k * step_x, k * step_y, &tap)
            || tap.deviation >= 1)
            continue;
        const float weight = GAUSS[k < 0 ? -k : k] * (1 - tap.deviation) * tap.likeness;
        crv__tap_add(&sum, &tap.value, weight);
    }
    return crv__tap_mean(&sum); /* the centre weighs 1 */
}

static const char *const OPTIONS[] = {"filter_depth", "filter_slope", "filter_normal",
                                      NULL};

const crv__filter crv__filter_bilateral13 = {
    .info = {.name = "bilateral13",
             .title = "Two 1-D passes of 13 taps: Gaussian times depth proximity",
             .paper = "McGuire, Osman, Bukowski, Hennessy 2011: The Alchemy Screen-Space "
                      "Ambient Obscurance Algorithm",
             .options = OPTIONS},
    .passes = 2,
    .radius_px = RADIUS,
    .filter = filter};
