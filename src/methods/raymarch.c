/* SPDX-License-Identifier: MIT */
/*
 * Ray marching through the depth buffer: the baseline of Dimitrov, Bavoil, Sainz 2008
 * (Figure 12) and of Bavoil, Sainz, Dimitrov 2008 (Figure 1).
 *
 * Nd * Nn rays with cosine density over the whole hemisphere: Nd azimuths with Nn heights
 * z each. z^2 is stratified uniformly in [0, 1], so that every ray has the same weight.
 * Rays are marched in Ns steps. For the bent normal (bent.h) each has the measure 1.
 */
#include "core/registry.h"
#include "methods/march.h"

static float estimate(const crv__frame *f, int32_t x, int32_t y, crv__vec3 *bent)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const crv__vec3 n = crv__normal_at(f, x, y);
    const crv__vec3 P = crv__unproject(p, x, y, *crv__plane_at(&f->depth[0], x, y));
    const crv__vec3 origin = crv__lift(p, P, n);
    crv__vec3 tangent, bitangent;
    crv__tangents(n, &tangent, &bitangent);

    const int32_t rays = p->normal_rays > 0 ? p->normal_rays : 1;
    float occlusion = 0;
    crv__bent_sums sums = {{0, 0, 0}, {0, 0, 0}};
    for (int32_t i = 0; i < p->directions; i++) {
        const crv__vec3 t = crv__slice_tangent(f, noise, i, tangent, bitangent);
        for (int32_t k = 0; k < rays; k++) {
            const float stratum = ((float)k + crv__stratum(noise, i)) / (float)rays;
            const crv__vec3 direction = crv__raised(n, t, stratum);
            const float blocked = crv__march(f, origin, direction, noise->beta);
            occlusion += blocked;
            if (bent)
                crv__bent_add(&sums, direction, 1, blocked);
        }
    }
    const float total = (float)(p->directions * rays), A = 1 - occlusion / total;
    if (bent)
        *bent = crv__bent_normal(&sums, n, A, CRV__BENT_COSINE * total);
    return A;
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    return estimate(f, x, y, NULL);
}

static const char *const OPTIONS[] = {"falloff",    "tau",         "u",
                                      "directions", "steps",       "normal_rays",
                                      "thickness",  "bent_normal", NULL};

const crv__method crv__method_raymarch = {
    .info =
        {.name = "raymarch",
         .title = "Ray marching in the depth buffer",
         .paper =
             "Dimitrov, Bavoil, Sainz 2008: Horizon-Split Ambient Occlusion (baseline)",
         .weighting = CRV_WEIGHTING_COSINE,
         .options = OPTIONS,
         .bent_normal = 1},
    .accessibility = accessibility,
    .estimate = estimate,
    .presets = {
        "directions=4 steps=8 normal_rays=1", "directions=8 steps=8 normal_rays=4",
        "directions=12 steps=12 normal_rays=6", "directions=24 steps=24 normal_rays=8",
        "directions=8 steps=8 normal_rays=4 falloff=linear thickness=0 filter=none"}};
