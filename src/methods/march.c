/* SPDX-License-Identifier: MIT */
#include "methods/march.h"

#include "core/falloff.h"

float crv__march(const crv__frame *f, crv__vec3 origin, crv__vec3 direction, float beta)
{
    const crv__params *p = f->params;
    const float step = p->radius / (float)p->steps;
    for (int32_t i = 1; i <= p->steps; i++) {
        crv__vec3 I;
        const crv__vec3 Q = crv__add_scaled(origin, direction, ((float)i + beta) * step);
        if (crv__blocked(f, origin, Q, &I))
            return crv__falloff(p, crv__length(crv__sub(I, origin)) * p->inv_radius);
    }
    return 0;
}
