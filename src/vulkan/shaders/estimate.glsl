/* SPDX-License-Identifier: MIT */
/* The main() of every method: accessibility(pixel, depth) of what is not background, then
 * intensity and contrast. */
#ifndef ESTIMATE_GLSL
#define ESTIMATE_GLSL

#include "bent.glsl"
#include "bent_output.glsl"
#include "part.glsl"

/* max(0, 1 - intensity (1 - A))^contrast, at most 1 */
float finished(float a)
{
    const float strong = 1 - params.intensity * (1 - a);
    const float clamped = strong > 0 ? (strong < 1 ? strong : 1) : 0;
    return clamped > 0 && params.contrast != 1 ? pow(clamped, params.contrast) : clamped;
}

void main()
{
    const ivec2 at = pixel_of_invocation();
    if (!in_output(at))
        return;
    const float d = depth_at(at, 0);
    const float a = is_surface(d) ? accessibility(at, d) : 1;
    if (!is_last_part())
        return;
    write_output(at, vec4(finished(a)));
    if (BENT_NORMAL != 0)
        write_bent_normal(at, is_surface(d) ? bent_normal : vec3(0));
}

#endif
