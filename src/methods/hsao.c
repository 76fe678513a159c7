/* SPDX-License-Identifier: MIT */
/*
 * Horizon-split ambient occlusion.
 * Rouslan Dimitrov, Louis Bavoil, Miguel Sainz: Horizon-Split Ambient Occlusion, 2008.
 *
 * The hemisphere around n is cut into Nd slices. In each, a ray that starts in the
 * tangent plane is deflected step by step towards the surface points above it (Figure 4);
 * the height H of its tip is the horizon. Below H all is blocked, which integrates in
 * closed form to H^2 (eq. 6). Above H, Nn rays find what the horizon misses (eq. 7):
 *
 *     A = 1 - 1/Nd Sum [H^2 + (1 - H^2)/Nn Sum V]
 *
 * The paper stratifies the rays from 0 to 1 - O_T, so that its first lies below the
 * horizon, and its patches can sum past 1; here z^2 is stratified between H^2 and 1, so
 * that they fill exactly what the horizon leaves.
 */
#include "core/falloff.h"
#include "core/registry.h"
#include "methods/march.h"

/* The horizon of one slice. */
typedef struct horizon {
    float height;    /* H: cosine between the horizon ray and n */
    float occlusion; /* of all below, falloff applied */
} horizon;

static horizon trace_horizon(const crv__frame *f, crv__vec3 origin, crv__vec3 n,
                             crv__vec3 t, float beta)
{
    const crv__params *p = f->params;
    const float step = p->radius / (float)p->steps;
    horizon result = {0, 0};
    float weight = 0;
    crv__vec3 h = t;
    for (int32_t i = 1; i <= p->steps; i++) {
        crv__vec3 I;
        const crv__vec3 Q = crv__add_scaled(origin, h, ((float)i + beta) * step);
        if (!crv__blocked(f, origin, Q, &I))
            continue;
        const crv__vec3 to = crv__sub(I, origin);
        const float distance = crv__length(to), along_t = crv__dot(to, t);
        if (!(along_t > 0) || (p->growing_sphere && distance > (float)i * step))
            continue;
        /* The projection on the plane (n, t), normalised. */
        const float along_n = crv__dot(to, n);
        const float scale = 1 / sqrtf(along_t * along_t + along_n * along_n);
        const float height = along_n * scale;
        if (height <= result.height)
            continue; /* hidden below the horizon already */
        weight = crv__falloff(p, distance * p->inv_radius);
        result.occlusion += (height * height - result.height * result.height) * weight;
        result.height = height;
        h = (crv__vec3){height * n.x + along_t * scale * t.x,
                        height * n.y + along_t * scale * t.y,
                        height * n.z + along_t * scale * t.z};
    }
    if (p->attenuation == CRV_ATTENUATION_HORIZON)
        result.occlusion = result.height * result.height * weight;
    return result;
}

/* What the rays above the horizon hit: z^2 stratified between H^2 and 1 (eq. 7 to 11). */
static float normal_occlusion(const crv__frame *f, crv__vec3 origin, crv__vec3 n,
                              crv__vec3 t, float height, float stratum, float beta)
{
    const crv__params *p = f->params;
    const float rest = 1 - height * height;
    float blocked = 0;
    for (int32_t k = 0; k < p->normal_rays; k++) {
        const float z2 =
            height * height + rest * ((float)k + stratum) / (float)p->normal_rays;
        blocked += crv__march(f, origin, crv__raised(n, t, z2), beta);
    }
    return p->normal_rays ? rest * blocked / (float)p->normal_rays : 0;
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const crv__vec3 n = crv__normal_at(f, x, y);
    const crv__vec3 P = crv__unproject(p, x, y, *crv__plane_at(&f->depth[0], x, y));
    const crv__vec3 origin = crv__lift(p, P, n);
    crv__vec3 tangent, bitangent;
    crv__tangents(n, &tangent, &bitangent);

    float occlusion = 0;
    for (int32_t i = 0; i < p->directions; i++) {
        const crv__vec3 t = crv__slice_tangent(f, noise, i, tangent, bitangent);
        const horizon h = trace_horizon(f, origin, n, t, noise->beta);
        occlusion += h.occlusion
                     + normal_occlusion(f, origin, n, t, h.height, crv__stratum(noise, i),
                                        noise->beta);
    }
    return 1 - occlusion / (float)p->directions;
}

static const char *const OPTIONS[] = {
    "falloff",   "tau",         "u",           "directions",
    "steps",     "normal_rays", "attenuation", "growing_sphere",
    "thickness", NULL};

const crv__method crv__method_hsao = {
    .info = {.name = "hsao",
             .title = "Horizon-split ambient occlusion",
             .paper = "Dimitrov, Bavoil, Sainz 2008: Horizon-Split Ambient Occlusion",
             .weighting = CRV_WEIGHTING_COSINE,
             .options = OPTIONS},
    .accessibility = accessibility,
    .presets = {
        "directions=4 steps=6 normal_rays=1", "directions=7 steps=12 normal_rays=1",
        "directions=12 steps=12 normal_rays=2", "directions=24 steps=24 normal_rays=4",
        "directions=7 steps=12 normal_rays=1 falloff=linear thickness=0 "
        "filter=gauss5 filter_slope=off filter_normal=180"}};
