/* SPDX-License-Identifier: MIT */
/*
 * Bent normals from the directions that a method samples: src/methods/bent.h has the
 * equations and says why. To lift an algorithm with them, define BENT_NORMAL as 1 before
 * all else, and read bent_normal after accessibility().
 */
#ifndef BENT_GLSL
#define BENT_GLSL

#include "part.glsl"

const float BENT_COSINE = 0.66666667, BENT_UNIFORM = 0.5; /* h */

/* The pixel's, if BENT_NORMAL is 1. */
vec3 bent_normal = vec3(0);

/* Adds a direction of this measure, of which a share is blocked. */
void bent_add(inout BentSums sums, vec3 direction, float measure, float blocked)
{
    sums.open += measure * (1 - blocked) * direction;
    sums.blocked += measure * blocked * direction;
}

/* hemisphere: M h. */
vec3 bent_of(BentSums sums, vec3 n, float a, float hemisphere)
{
    const float A = min(1, max(0, a));
    const vec3 rest = n * hemisphere - sums.blocked;
    const vec3 B = sums.open + A * (rest - sums.open);
    const float least = 1e-4 * hemisphere, squared = dot(B, B);
    return squared > least * least ? B * inversesqrt(squared) : n;
}

#endif
