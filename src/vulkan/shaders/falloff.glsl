/* SPDX-License-Identifier: MIT */
#ifndef FALLOFF_GLSL
#define FALLOFF_GLSL

#include "common.glsl"

/* crv_falloff */
const int FALLOFF_NONE = 0, FALLOFF_LINEAR = 1, FALLOFF_SQRT = 2, FALLOFF_CUBIC = 3,
          FALLOFF_EXPONENTIAL = 4, FALLOFF_ALCHEMY = 5;

/* W(r) of an occluder at distance r = q * radius, q < 1. */
float falloff_within(float q)
{
    switch (falloff_kind()) {
    case FALLOFF_NONE:
        return 1;
    case FALLOFF_LINEAR:
        return 1 - q;
    case FALLOFF_SQRT:
        return 1 - sqrt(q);
    case FALLOFF_CUBIC:
        return 1 - q * q * q;
    case FALLOFF_EXPONENTIAL:
        return exp(-params.tau * q);
    case FALLOFF_ALCHEMY: {
        const float m = max(q, params.u);
        return params.u * q / (m * m);
    }
    }
    return 0;
}

/* 0 from q = 1 on. */
float falloff(float q)
{
    const float W = falloff_within(q);
    return q < 1 ? W : 0;
}

#endif
