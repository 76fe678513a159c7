/* SPDX-License-Identifier: MIT */
/* filters/box4.c for the lanes of a vector. */
#include "cpu/kernels/window.h"

enum { FIRST = -2, LAST = 1 };

static inline vf filter(const crv__window *w, int32_t pass)
{
    const vf one = vf_set(1);
    vf sum = vf_zero(), count = vf_zero();
    (void)pass;
    for (int32_t dy = FIRST; dy <= LAST; dy++) {
        for (int32_t dx = FIRST; dx <= LAST; dx++) {
            const crv__taps tap = crv__taps_at(w, dx, dy);
            const vm in = vm_and(tap.any, vf_le(tap.deviation, one));
            sum = sum + vf_where(in, tap.value);
            count = count + vf_where(in, one);
        }
    }
    return sum / count;
}

CRV__FILTER_KERNEL(box4, -FIRST)
