/* SPDX-License-Identifier: MIT */
/* filters/gauss5.c for the lanes of a vector. */
#include "cpu/kernels/window.h"

enum { REACH = 2 };

static inline vf filter(const crv__window *w, int32_t pass)
{
    static const float BINOMIAL[REACH + 1] = {6, 4, 1};
    vf sum = vf_zero(), weights = vf_zero();
    (void)pass;
    for (int32_t dy = -REACH; dy <= REACH; dy++) {
        for (int32_t dx = -REACH; dx <= REACH; dx++) {
            const crv__taps tap = crv__taps_at(w, dx, dy);
            const float binomial =
                BINOMIAL[dx < 0 ? -dx : dx] * BINOMIAL[dy < 0 ? -dy : dy];
            const vf weight = vf_where(tap.any, vf_set(binomial) * tap.likeness
                                                    / (tap.deviation + vf_set(0.125f)));
            sum = vf_fma(weight, tap.value, sum);
            weights = weights + weight;
        }
    }
    return sum / weights;
}

CRV__FILTER_KERNEL(gauss5, REACH)
