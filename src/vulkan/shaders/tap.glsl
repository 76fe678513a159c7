/* SPDX-License-Identifier: MIT */
/* What the filters share: which neighbours belong to the same surface, by depth and
 * normal. src/filters/tap.h */
#ifndef TAP_GLSL
#define TAP_GLSL

#include "common.glsl"

bool in_input(ivec2 at)
{
    const ivec2 place = at - ivec2(push.in_x, push.in_y);
    return all(lessThan(uvec2(place), uvec2(push.in_width, push.in_height)));
}

/* `at` in the buffers, in_input(at). */
float input_at(ivec2 at)
{
    return texelFetch(input_image, at - ivec2(push.in_x, push.in_y), 0).r;
}

/* The centre of a filter window: its depth, and the depth's change from pixel to pixel.
 */
struct Centre {
    ivec2 at;
    float depth;
    vec2 slope;
    vec3 normal;
};

/* The smaller of the two one-sided differences: the one that does not cross an edge. 0 at
 * pixels without neighbours. */
float slope_along(ivec2 at, ivec2 step, float d)
{
    float slope = INFINITY;
    for (int side = -1; side <= 1; side += 2) {
        const ivec2 neighbour = at + side * step;
        if (!in_buffers(neighbour))
            continue;
        const float depth = depth_at(neighbour, 0);
        const float difference = (depth - d) * float(side);
        if (is_surface(depth) && abs(difference) < abs(slope))
            slope = difference;
    }
    return is_surface(abs(slope)) ? slope : 0;
}

Centre centre_at(ivec2 at)
{
    Centre c = Centre(at, depth_at(at, 0), vec2(0), normal_at(at));
    if (filter_uses_slope())
        c.slope = vec2(slope_along(at, ivec2(1, 0), c.depth),
                       slope_along(at, ivec2(0, 1), c.depth));
    return c;
}

struct Tap {
    float value;
    float deviation; /* of its depth from what the centre leads one to expect, in units of
                        filter_depth */
    float likeness;  /* of its normal to the centre's, 0 to 1 */
};

/* The tap at the centre + step. False where there is no such tap: outside the picture,
 * background, or a surface turned by filter_normal or more. */
bool tap_at(Centre c, ivec2 step, out Tap tap)
{
    tap = Tap(0, 0, 0);
    const ivec2 at = c.at + step;
    if (!in_input(at))
        return false;
    const float d = depth_at(at, 0);
    tap.value = input_at(at);
    if (!is_surface(d) || is_nan(tap.value))
        return false;
    const float expected =
        c.depth + float(step.x) * c.slope.x + float(step.y) * c.slope.y;
    tap.deviation = abs(d - expected) / params.filter_depth;
    tap.likeness = 1;
    if (params.filter_normal > 0) {
        const float turned = 1 - dot(normal_at(at), c.normal);
        tap.likeness = min(1, 1 - turned * params.filter_normal);
    }
    return tap.likeness > 0;
}

#endif
