/* SPDX-License-Identifier: MIT */
/* methods/characteristic.h without fields, for the lanes of a vector: which points are
 * outside of what the depth buffer shows. */
#ifndef CRV_CPU_KERNELS_OUTSIDE_H
#define CRV_CPU_KERNELS_OUTSIDE_H

#include "cpu/kernels/march.h"

/* The lanes of `active` whose point is not crv__outside_depth(). */
CRV__INLINE vm crv__lanes_inside(const crv__frame *f, crv__shape shape, crv__v3 q,
                                 vm active, float thickness)
{
    const crv__texels at = crv__lanes_texels(f->params, shape, q, active);
    const vi index = crv__lanes_index(&f->depth[0], at.u, at.v);
    vm open = at.in, inside = vm_none();
    for (int32_t layer = 0; layer < shape.layers; layer += 1 + shape.solid) {
        const vf d = vf_gather(f->depth[layer].data, index, open);
        const vm behind = vm_and(open, vf_lt(d, -q.z));
        /* In front of one layer is in front of all further ones. */
        const vf back =
            crv__lanes_back(f, shape, layer, index, behind, d, vf_set(thickness));
        const vm here = vm_and(behind, vf_lt(-q.z, back));
        inside = vm_or(inside, here);
        if (shape.layers == 1)
            break;
        open = vm_and(behind, vm_not(here));
        if (!vm_any(open))
            break;
    }
    return inside;
}

#endif
