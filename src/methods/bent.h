/* SPDX-License-Identifier: MIT */
/*
 * The bent normal of a pixel, from the directions that its method samples. Every
 * direction w stands for a measure m, of which V W is blocked (V, W: crv_weighting):
 *
 *     O = Sum m (1 - V W) w      K = Sum m V W w      M = Sum m                       (1)
 *     B = norm((1 - A) O + A (M h n - K))                                             (2)
 *     h = 2/3 cosine weighting,  1/2 uniform
 *
 * M h n is the sum over the whole hemisphere, known exactly. If all directions were
 * sampled, O and M h n - K would be the same. Few directions are not spread evenly around
 * n: O alone turns away from n even on an open plane, where M h n - K is exact. If little
 * is open, M h n - K is a small difference of large sums, where O keeps to the directions
 * that are open. A leads from one to the other.
 *
 * If nothing is open, B is n.
 */
#ifndef CRV_METHODS_BENT_H
#define CRV_METHODS_BENT_H

#include "core/frame.h"

/* O and K. */
typedef struct crv__bent_sums {
    crv__vec3 open, blocked;
} crv__bent_sums;

/* h */
#define CRV__BENT_COSINE  0.66666667f
#define CRV__BENT_UNIFORM 0.5f

/* Adds a direction of this measure, or a mean of directions, of which a share is blocked.
 */
static inline void crv__bent_add(crv__bent_sums *sums, crv__vec3 direction, float measure,
                                 float blocked)
{
    sums->open = crv__add_scaled(sums->open, direction, measure * (1 - blocked));
    sums->blocked = crv__add_scaled(sums->blocked, direction, measure * blocked);
}

/* Eq. 2; hemisphere: M h. */
static inline crv__vec3 crv__bent_normal(const crv__bent_sums *sums, crv__vec3 n,
                                         float accessibility, float hemisphere)
{
    const float A = fminf(1, fmaxf(0, accessibility));
    const crv__vec3 known = {n.x * hemisphere, n.y * hemisphere, n.z * hemisphere};
    const crv__vec3 rest = crv__sub(known, sums->blocked);
    const crv__vec3 open = sums->open;
    const crv__vec3 B = {open.x + A * (rest.x - open.x), open.y + A * (rest.y - open.y),
                         open.z + A * (rest.z - open.z)};
    /* What is less than this share of the hemisphere is rounding. */
    const float least = 1e-4f * hemisphere, squared = crv__dot(B, B);
    if (!(squared > least * least))
        return n;
    const float scale = 1 / sqrtf(squared);
    return (crv__vec3){B.x * scale, B.y * scale, B.z * scale};
}

#endif
