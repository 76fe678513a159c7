/* SPDX-License-Identifier: MIT */
/* filters/bilateral13.c for the lanes of a vector. */
#include "cpu/kernels/window.h"

enum { REACH = 6 };

static inline vf filter(const crv__window *w, int32_t pass)
{
    static const float GAUSS[REACH + 1] = {1.0f,        0.94595947f, 0.80073740f,
                                           0.60653066f, 0.41111229f, 0.24935221f,
                                           0.13533528f};
    vf sum = vf_zero(), weights = vf_zero();
    for (int32_t k = -REACH; k <= REACH; k++) {
        const crv__taps tap = crv__taps_at(w, pass == 0 ? k : 0, pass == 0 ? 0 : k);
        const vf proximity = vf_max(vf_set(1) - tap.deviation, vf_zero());
        const vf weight = vf_set(GAUSS[k < 0 ? -k : k]) * proximity * tap.likeness;
        sum = vf_fma(weight, tap.value, sum);
        weights = weights + weight;
    }
    return sum / weights;
}

CRV__FILTER_KERNEL(bilateral13, REACH)
