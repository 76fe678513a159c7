/* SPDX-License-Identifier: MIT */
/*
 * Large radii: far samples read coarser levels of the depth image, whose texels lie
 * together in the cache, while those of level 0 are scattered over the picture (McGuire,
 * Mara, Luebke: Scalable Ambient Obscurance, HPG 2012). A level holds depths of level 0
 * as they are, of one texel in the middle of each block, not means of them: a sample is
 * moved to that texel and remains a point of the surface, so that a plane still finds
 * itself open. Different samples, same expected error; hence off unless LOD_PX is set.
 */
#ifndef LEVEL_GLSL
#define LEVEL_GLSL

#include "common.glsl"

const int MOST_LEVELS = 6; /* CRV__MOST_LEVELS (memory.h) */

/* Distance from which level 1 is read, px; level 2 from twice as far, and so on. 0: level
 * 0 alone. */
layout(constant_id = 19) const int LOD_PX = 0;

bool uses_levels()
{
    return LOD_PX > 0 && DEPTH_EDGE <= 1;
}

/* The level for a sample this far away. */
int level_at(float distance_px)
{
    if (!uses_levels())
        return 0;
    const int level = findMSB(int(distance_px / float(LOD_PX))) + 1;
    /* The coarsest has more than 4 texels a side (scratch.c). */
    const int coarsest = findMSB(min(params.width, params.height) / 5);
    return clamp(level, 0, clamp(coarsest, 0, MOST_LEVELS - 1));
}

/* The texel of level 0 that a level's texel is a copy of. */
ivec2 source_of(ivec2 texel, int level)
{
    return (texel << level) + ((1 << level) >> 1);
}

/* The texel of level 0 that stands for `texel` in a level. Where the last block is cut
 * off by the border the one before does. */
ivec2 standing_for(ivec2 texel, int level)
{
    const ivec2 last = (ivec2(params.width, params.height) >> level) - 1;
    return level > 0 ? source_of(min(texel >> level, max(last, 0)), level) : texel;
}

/* The depth of texel = standing_for(., level). */
float depth_in_level(ivec2 texel, int layer, int level)
{
    if (!uses_levels())
        return depth_at(texel, layer);
    return texelFetch(depth_image, ivec3(texel >> level, layer), level).r;
}

#endif
