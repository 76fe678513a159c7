/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_FALLOFF_H
#define CRV_CORE_FALLOFF_H

#include "crevice/options.h"
#include "shared/params.h"

#include <math.h>

/* The largest share of the radius that has a weight. */
#define CRV__FALLOFF_END 0.99999994f

/* W(r) of an occluder at distance r = q * radius; 0 from q = 1 on. See crv_falloff. */
static inline float crv__falloff(const crv__params *p, float q)
{
    if (!(q < 1))
        return 0;
    switch ((crv_falloff)p->falloff) {
    case CRV_FALLOFF_NONE:
        return 1;
    case CRV_FALLOFF_LINEAR:
        return 1 - q;
    case CRV_FALLOFF_SQRT:
        return 1 - sqrtf(q);
    case CRV_FALLOFF_CUBIC:
        return 1 - q * q * q;
    case CRV_FALLOFF_EXPONENTIAL:
        return expf(-p->tau * q);
    case CRV_FALLOFF_ALCHEMY: {
        float m = q > p->u ? q : p->u;
        return p->u * q / (m * m);
    }
    }
    return 0;
}

#endif
