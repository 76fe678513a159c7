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
 *
 * The bent normal has the same weights (G of slice.h):
 *
 *     K = G(tt) - G(h)                              without falloff
 *     K = Sum (G(h') - G(h)) W(r),   O = G(tt) - K  attenuation slab
 *
 * Sums are vectors of view space from the start: none is turned afterwards.
 */
#include "core/registry.h"
#include "methods/slice.h"

/* A slice so far. */
typedef struct horizon {
    float cosine;
    float open; /* u of the horizon: the share above it */
    float occlusion;
    float weight;      /* W of the horizon's own sample */
    crv__vec2 vector;  /* G of the horizon */
    crv__vec2 blocked; /* K */
} horizon;

static void add_vector(horizon *h, crv__vec2 vector, float W)
{
    h->blocked.x += (h->vector.x - vector.x) * W;
    h->blocked.y += (h->vector.y - vector.y) * W;
    h->vector = vector;
}

static void add_sample(horizon *h, const crv__params *p, const crv__slice_site *site,
                       const crv__slice *s, crv__vec2 point, bool with_vectors)
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
    if (with_vectors)
        add_vector(h, crv__slice_vector(p, site->a, s->b, cosine, x / r), W);
}

static crv__slice_vectors vectors_of(const horizon *h, const crv__params *p,
                                     crv__vec2 all)
{
    crv__vec2 K = h->blocked;
    if (p->attenuation == CRV_ATTENUATION_HORIZON)
        K = (crv__vec2){(all.x - h->vector.x) * h->weight,
                        (all.y - h->vector.y) * h->weight};
    return (crv__slice_vectors){.open = {all.x - K.x, all.y - K.y}, .blocked = K};
}

static float blocked_share(const crv__frame *f, const crv__slice_site *site,
                           const crv__slice *s, crv__slice_vectors *vectors)
{
    const crv__params *p = f->params;
    crv__vec2 all = {0, 0};
    if (vectors)
        all = crv__slice_vector(p, site->a, s->b, s->cos_tangent, s->sin_tangent);
    horizon h = {.cosine = s->cos_tangent, .open = 1, .vector = all};
    for (int32_t i = 0; i < p->steps; i++) {
        crv__slice_texel texel;
        if (!crv__slice_texel_at(p, site, s, i, &texel))
            break;
        for (int32_t layer = 0; layer < p->layers; layer++) {
            const float d = crv__slice_depth(f, layer, &texel);
            if (d < INFINITY)
                add_sample(&h, p, site, s, crv__slice_point(p, site, s, &texel, d),
                           vectors);
        }
    }
    if (vectors)
        *vectors = vectors_of(&h, p, all);
    return p->attenuation == CRV_ATTENUATION_SLAB ? h.occlusion : (1 - h.open) * h.weight;
}

static float estimate(const crv__frame *f, int32_t x, int32_t y, crv__vec3 *bent)
{
    return crv__slices_open(f, x, y, blocked_share, bent);
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    return estimate(f, x, y, NULL);
}

static const char *const OPTIONS[] = {"falloff",     "tau",         "u",
                                      "directions",  "steps",       "spacing",
                                      "attenuation", "border",      "max_radius_px",
                                      "weighting",   "bent_normal", NULL};

const crv__method crv__method_gtao = {
    .info = {.name = "gtao",
             .title = "Ground-truth ambient occlusion",
             .paper =
                 "Jimenez, Wu, Pesce, Jarabo 2016: Practical Realtime Strategies for "
                 "Accurate Indirect Occlusion",
             .weighting = CRV_WEIGHTING_COSINE,
             .options = OPTIONS,
             .bent_normal = 1},
    .accessibility = accessibility,
    .estimate = estimate,
    .presets = {"directions=4 steps=4", "directions=8 steps=8", "directions=12 steps=12",
                "directions=24 steps=24",
                "directions=2 steps=6 falloff=none border=background filter=box4"}};
