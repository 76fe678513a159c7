/* SPDX-License-Identifier: MIT */
/* How surfaces go on beyond the borders of the buffers: methods/slice.h has the rule. */
#ifndef CRV_CORE_BORDER_H
#define CRV_CORE_BORDER_H

#include "core/frame.h"

#include <stdbool.h>

/* What is linear over the image of a plane: 1/d, orthographic d. */
static inline float crv__border_linear(const crv__frame *f, int32_t x, int32_t y)
{
    const float d = *crv__plane_at(&f->depth[0], x, y);
    return f->params->orthographic ? d : 1 / d;
}

/* Its change over one texel outwards at a border, from four texels inwards (in_x, in_y);
 * 0 where the surface is not planar or the picture is smaller. */
static inline float crv__border_outward(const crv__frame *f, int32_t x, int32_t y,
                                        int32_t in_x, int32_t in_y, float own)
{
    if (!crv__plane_holds(&f->depth[0], x + 4 * in_x, y + 4 * in_y))
        return 0;
    const float middle = crv__border_linear(f, x + 2 * in_x, y + 2 * in_y);
    const float inner = crv__border_linear(f, x + 4 * in_x, y + 4 * in_y);
    const bool is_planar = inner > 0 && fabsf(own - 2 * middle + inner) < 0.01f * own;
    return is_planar ? 0.25f * (own - inner) : 0;
}

#endif
