/* SPDX-License-Identifier: MIT */
/* The characteristic function of the depth buffer (2010): what is outside.
 * src/methods/characteristic.h; fields are left to the CPU. */
#ifndef CHARACTERISTIC_GLSL
#define CHARACTERISTIC_GLSL

#include "march.glsl"

/* Whether q is in front of the depth buffer's first surface or behind the back of every
 * surface in front of it: the next layer if layers come in pairs, else `thickness`
 * behind the front. Off the buffers is outside. */
bool is_outside_depth(vec3 q, float thickness)
{
    ivec2 texel;
    if (!texel_of(q, texel))
        return true;
    for (int layer = 0; layer < layer_count(); layer += layer_step()) {
        const float d = depth_at(texel, layer);
        if (!(-q.z > d)) /* and in front of all further ones */
            return true;
        if (-q.z < back_of(layer, texel, d, thickness))
            return false;
    }
    return true;
}

bool is_outside(vec3 q)
{
    return params.use_depth == 0 || is_outside_depth(q, params.thickness);
}

#endif
