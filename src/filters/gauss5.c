/* SPDX-License-Identifier: MIT */
/*
 * A 5x5 Gaussian, each tap divided by its depth deviation from the centre.
 * Rouslan Dimitrov, Louis Bavoil, Miguel Sainz: Horizon-Split Ambient Occlusion, 2008,
 * section 4.1.3.
 *
 * The paper does not say how the centre, whose deviation is 0, is kept finite: here an
 * eighth of filter_depth is added to every deviation, so that taps within it count about
 * alike.
 */
#include "core/registry.h"
#include "filters/tap.h"

enum { RADIUS = 2 };

static crv__estimate filter(const crv__frame *f, const crv__picture *input, int32_t pass,
                            int32_t x, int32_t y)
{
    static const float BINOMIAL[RADIUS + 1] = {6, 4,
                                               1}; /* the 5-tap Gaussian, unscaled */
    const crv__centre centre = crv__centre_at(f, x, y);
    crv__tap_sum sum = {{0}, 0};
    (void)pass;
    for (int32_t dy = -RADIUS; dy <= RADIUS; dy++) {
        for (int32_t dx = -RADIUS; dx <= RADIUS; dx++) {
            crv__tap tap;
            if (!crv__tap_at(f, input, &centre, dx, dy, &tap))
                continue;
            const float weight = BINOMIAL[dx < 0 ? -dx : dx] * BINOMIAL[dy < 0 ? -dy : dy]
                                 * tap.likeness / (tap.deviation + 0.125f);
            crv__tap_add(&sum, &tap.value, weight);
        }
    }
    return crv__tap_mean(&sum); /* the centre weighs 36 * 8 */
}

static const char *const OPTIONS[] = {"filter_depth", "filter_slope", "filter_normal",
                                      NULL};

const crv__filter crv__filter_gauss5 = {
    .info = {.name = "gauss5",
             .title = "5x5 Gaussian, each tap divided by its depth deviation",
             .paper = "Dimitrov, Bavoil, Sainz 2008: Horizon-Split Ambient Occlusion",
             .options = OPTIONS},
    .passes = 1,
    .radius_px = RADIUS,
    .filter = filter};
