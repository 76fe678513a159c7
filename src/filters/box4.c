/* SPDX-License-Identifier: MIT */
/*
 * A 4x4 box that leaves out taps whose depth differs by more than filter_depth. With the
 * 4x4 noise tile every window holds each rotation once. Laszlo Szirmay-Kalos, Tamas
 * Umenhoffer, Balazs Toth, Laszlo Szecsi, Mateu Sbert: Volumetric Ambient Occlusion for
 * Real-Time Rendering and Games, IEEE CG&A 2010 (interleaved sampling).
 */
#include "core/registry.h"
#include "filters/tap.h"

enum { FIRST = -2, LAST = 1 };

static crv__estimate filter(const crv__frame *f, const crv__picture *input, int32_t pass,
                            int32_t x, int32_t y)
{
    const crv__centre centre = crv__centre_at(f, x, y);
    crv__tap_sum sum = {{0}, 0};
    (void)pass;
    for (int32_t dy = FIRST; dy <= LAST; dy++) {
        for (int32_t dx = FIRST; dx <= LAST; dx++) {
            crv__tap tap;
            if (!crv__tap_at(f, input, &centre, dx, dy, &tap) || tap.deviation > 1)
                continue;
            crv__tap_add(&sum, &tap.value, 1);
        }
    }
    return crv__tap_mean(&sum); /* the centre is always in */
}

static const char *const OPTIONS[] = {"filter_depth", "filter_slope", "filter_normal",
                                      NULL};

const crv__filter crv__filter_box4 = {
    .info =
        {.name = "box4",
         .title = "4x4 box over taps within the depth limit; suits the 4x4 noise tile",
         .paper =
             "Szirmay-Kalos, Umenhoffer, Toth, Szecsi, Sbert 2010: Volumetric Ambient "
             "Occlusion for Real-Time Rendering and Games",
         .options = OPTIONS},
    .passes = 1,
    .radius_px = 2,
    .filter = filter};
