/* SPDX-License-Identifier: MIT */
/*
 * Ground-truth ambient occlusion.
 * Jorge Jimenez, Xian-Chun Wu, Angelo Pesce, Adrian Jarabo: Practical Realtime Strategies
 * for Accurate Indirect Occlusion, SIGGRAPH 2016 courses.
 *
 * In every slice through the eye (slice.h) the horizon h is the smallest angle theta from
 * V at which a surface is seen, at first that of the tangent. Everything below it is
 * blocked:
 *
 *     occ = 1 - F(h)/Ft                             without falloff
 *     occ = Sum (u - u') W(r),   u = F/Ft           attenuation slab
 *
 * The second sums over the samples that lower the horizon from u to u': each weighs the
 * directions that it is first to block. Samples beyond the radius are ignored.
 *
 * The paper has cosine weighting without falloff; instead it blends the cosine of distant
 * samples towards that of the tangent.
 */
#include "core/registry.h"
#include "methods/slice.h"

/* A slice so far. */
typedef struct horizon {
    float cosine;
    float open; /* u of the horizon: the share above it */
    float occlusion;
    float weight; /* W of the horizon's own sample */
} horizon;

static void add_sample(horizon *h, const crv__params *p, const crv__slice_site *site,
                       const crv__slice *s, crv__vec2 point)
{
    const float x = point.x, z = point.y, r = sqrtf(x * x + z * z), cosine = z / r;
    if (!(x > 0 && r < p->radius && cosine > h->cosine))
        return;
    const float open = crv__slice_share(p, site, s, cosine, x / r);
    const float W = crv__falloff(p, r * p->inv_radius);
    h->occlusion += fmaxf(0, h->open - open) * W;
    h->cosine = cosine;
    h->open = fminf(h->open, open);
    h->weight = W;
}

static float blocked_share(const crv__frame *f, const crv__slice_site *site,
                           const crv__slice *s)
{
    const crv__params *p = f->params;
    horizon h = {.cosine = s->cos_tangent, .open = 1};
    for (int32_t i = 0; i < p->steps; i++) {
        crv__slice_texel texel;
        if (!crv__slice_texel_at(p, site, s, i, &texel))
            break;
        for (int32_t layer = 0; layer < p->layers; layer++) {
            const float d = crv__slice_depth(f, layer, &texel);
            if (d < INFINITY)
                add_sample(&h, p, site, s, crv__slice_point(p, site, s, &texel, d));
        }
    }
    return p->attenuation == CRV_ATTENUATION_SLAB ? h.occlusion : (1 - h.open) * h.weight;
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    return crv__slices_open(f, x, y, blocked_share);
}

static const char *const OPTIONS[] = {"falloff",     "tau",    "u",
                                      "directions",  "steps",  "spacing",
                                      "attenuation", "border", "max_radius_px",
                                      "weighting",   NULL};

const crv__method crv__method_gtao = {
    .info = {.name = "gtao",
             .title = "Ground-truth ambient occlusion",
             .paper =
                 "Jimenez, Wu, Pesce, Jarabo 2016: Practical Realtime Strategies for "
                 "Accurate Indirect Occlusion",
             .weighting = CRV_WEIGHTING_COSINE,
             .options = OPTIONS},
    .accessibility = accessibility,
    .presets = {"directions=4 steps=4", "directions=8 steps=8", "directions=12 steps=12",
                "directions=24 steps=24",
                "directions=2 steps=6 falloff=none border=background filter=box4"}};
