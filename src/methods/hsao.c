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
 *
 * For the bent normal (bent.h) a slice has the measure 1. What lies below a height h is
 *
 *     Z(h) = Int 2 z (z n + sqrt(1 - z^2) t) dz = 2/3 (h^3 n + (1 - (1 - h^2)^(3/2)) t)
 *
 * Each rise of the horizon from h' to h blocks W (Z(h) - Z(h')); each ray above it has
 * the measure (1 - H^2)/Nn. Without rays all above is open.
 */
#include "core/falloff.h"
#include "core/registry.h"
#include "methods/march.h"

/* The horizon of one slice. */
typedef struct horizon {
    float height;      /* H: cosine between the horizon ray and n */
    float occlusion;   /* of all below, falloff applied */
    crv__vec2 below;   /* Z(H): x along t, y along n */
    crv__vec2 blocked; /* of it, falloff applied */
} horizon;

/* Z */
static crv__vec2 directions_below(float height)
{
    const float rest = fmaxf(0, 1 - height * height);
    return (crv__vec2){CRV__BENT_COSINE * (1 - rest * sqrtf(rest)),
                       CRV__BENT_COSINE * height * height * height};
}

/* Raises the horizon. */
static void raise(horizon *h, float height, float weight)
{
    const crv__vec2 below = directions_below(height);
    h->occlusion += (height * height - h->height * h->height) * weight;
    h->blocked.x += (below.x - h->below.x) * weight;
    h->blocked.y += (below.y - h->below.y) * weight;
    h->height = height;
    h->below = below;
}

static horizon trace_horizon(const crv__frame *f, crv__vec3 origin, crv__vec3 n,
                             crv__vec3 t, float beta)
{
    const crv__params *p = f->params;
    const float step = p->radius / (float)p->steps;
    horizon result = {0};
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
        raise(&result, height, weight);
        h = (crv__vec3){height * n.x + along_t * scale * t.x,
                        height * n.y + along_t * scale * t.y,
                        height * n.z + along_t * scale * t.z};
    }
    if (p->attenuation == CRV_ATTENUATION_HORIZON) {
        result.occlusion = result.height * result.height * weight;
        result.blocked = (crv__vec2){result.below.x * weight, result.below.y * weight};
    }
    return result;
}

/* What the rays above the horizon hit: z^2 stratified between H^2 and 1 (eq. 7 to 11).
 * Adds them to the sums, if those are not NULL. */
static float normal_occlusion(const crv__frame *f, crv__vec3 origin, crv__vec3 n,
                              crv__vec3 t, float height, float stratum, float beta,
                              crv__bent_sums *sums)
{
    const crv__params *p = f->params;
    const float rest = 1 - height * height;
    float blocked = 0;
    for (int32_t k = 0; k < p->normal_rays; k++) {
        const float z2 =
            height * height + rest * ((float)k + stratum) / (float)p->normal_rays;
        const crv__vec3 direction = crv__raised(n, t, z2);
        const float hit = crv__march(f, origin, direction, beta);
        blocked += hit;
        if (sums)
            crv__bent_add(sums, direction, rest / (float)p->normal_rays, hit);
    }
    return p->normal_rays ? rest * blocked / (float)p->normal_rays : 0;
}

static crv__vec3 in_slice(crv__vec3 n, crv__vec3 t, float along_t, float along_n)
{
    return (crv__vec3){along_t * t.x + along_n * n.x, along_t * t.y + along_n * n.y,
                       along_t * t.z + along_n * n.z};
}

/* Adds what lies below a slice's horizon and, without rays, above it. */
static void add_horizon(crv__bent_sums *sums, const crv__params *p, crv__vec3 n,
                        crv__vec3 t, const horizon *h)
{
    const crv__vec2 end = p->normal_rays > 0 ? h->below : directions_below(1);
    const crv__vec3 blocked = in_slice(n, t, h->blocked.x, h->blocked.y);
    const crv__vec3 all = in_slice(n, t, end.x, end.y);
    sums->blocked = crv__add_scaled(sums->blocked, blocked, 1);
    sums->open = crv__add_scaled(sums->open, crv__sub(all, blocked), 1);
}

static float estimate(const crv__frame *f, int32_t x, int32_t y, crv__vec3 *bent)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const crv__vec3 n = crv__normal_at(f, x, y);
    const crv__vec3 P = crv__unproject(p, x, y, *crv__plane_at(&f->depth[0], x, y));
    const crv__vec3 origin = crv__lift(p, P, n);
    crv__vec3 tangent, bitangent;
    crv__tangents(n, &tangent, &bitangent);

    float occlusion = 0;
    crv__bent_sums sums = {{0, 0, 0}, {0, 0, 0}};
    for (int32_t i = 0; i < p->directions; i++) {
        const crv__vec3 t = crv__slice_tangent(f, noise, i, tangent, bitangent);
        const horizon h = trace_horizon(f, origin, n, t, noise->beta);
        occlusion += h.occlusion
                     + normal_occlusion(f, origin, n, t, h.height, crv__stratum(noise, i),
                                        noise->beta, bent ? &sums : NULL);
        if (bent)
            add_horizon(&sums, p, n, t, &h);
    }
    const float A = 1 - occlusion / (float)p->directions;
    if (bent)
        *bent = crv__bent_normal(&sums, n, A, CRV__BENT_COSINE * (float)p->directions);
    return A;
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    return estimate(f, x, y, NULL);
}

static const char *const OPTIONS[] = {
    "falloff",   "tau",         "u",           "directions",
    "steps",     "normal_rays", "attenuation", "growing_sphere",
    "thickness", "bent_normal", NULL};

const crv__method crv__method_hsao = {
    .info = {.name = "hsao",
             .title = "Horizon-split ambient occlusion",
             .paper = "Dimitrov, Bavoil, Sainz 2008: Horizon-Split Ambient Occlusion",
             .weighting = CRV_WEIGHTING_COSINE,
             .options = OPTIONS,
             .bent_normal = 1},
    .accessibility = accessibility,
    .estimate = estimate,
    .presets = {
        "directions=4 steps=6 normal_rays=1", "directions=7 steps=12 normal_rays=1",
        "directions=12 steps=12 normal_rays=2", "directions=24 steps=24 normal_rays=4",
        "directions=7 steps=12 normal_rays=1 falloff=linear thickness=0 "
        "filter=gauss5 filter_slope=off filter_normal=180"}};
