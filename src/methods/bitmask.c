/* SPDX-License-Identifier: MIT */
/*
 * Ambient occlusion by a visibility bit mask, with a thickness that grows with what is
 * seen.
 * Olivier Therrien, Yannick Levesque, Guillaume Gilet: Screen Space Indirect Lighting
 * with Visibility Bitmask, The Visual Computer 2023.
 *
 * Every slice through the eye (slice.h) is cut into 32 sectors of equal measure between V
 * and the tangent. A sample at (x, z) is the front of a body of thickness h. It blocks
 * the sectors from its front to its back; light passes behind it:
 *
 *     uf = F(front)/Ft,  ub = F(back)/Ft
 *     bits [ceil(32 uf - zeta_k), ceil(32 ub - zeta_k)),  occ = bits set/32
 *
 * The paper's thickness is a constant. Here a surface is taken to extend as far in depth
 * as it is seen to extend along the slice, and no farther than it is wide. x0 is the x
 * at which the current run of samples began. A new run begins after background, and if z
 * is more than 16 (x - x') above the sample before, which lies at x':
 *
 *     width:     h = max(0.1 R, min(2.5 (x - x0), width))    width: width.h
 *     run:       h = max(0.1 R, 2 (x - x0))
 *     constant:  h = thickness R
 *     layers:    h = the gap to the next layer, thickness R behind the last
 *
 * If layers are solid, the back gives h for every rule. If they are surfaces, the next
 * layer ends the body in front of it, and is itself a sheet of half the thickness.
 *
 * A sample stands for its cell [t_lo, t_hi] of the spacing, or light would leak between
 * samples. Its front lies a quarter of the way to t_lo, moved parallel to the tangent
 * plane; its back lies at t_hi. Both are clipped to the sphere of the radius.
 *
 *     xf = x (1 - (1 - t_lo/t)/4)    zf = min(z - (b/a)(xf - x), sqrt(R^2 - xf^2))
 *     xb = x t_hi/t                  zb = max(z - h, -sqrt(R^2 - xf^2))
 *
 * Each newly set bit weighs W. The nearer of them lie at the front, at r; the farther at
 * the body's side, at x:  W(r - 0.7 (r - x) |new|/|bits|),  r = min(|(x, z)|, R).
 */
#include "core/registry.h"
#include "methods/slice.h"
#include "methods/width.h"

enum { SECTORS = 32 };

/* A slice so far. */
typedef struct sectors {
    uint32_t mask;
    float occlusion;
    float start;          /* x0 */
    float last_x, last_z; /* of the sample before */
} sectors;

/* A surface seen at a texel. */
typedef struct body {
    const crv__slice_texel *texel;
    float x, z; /* of its front */
    float thickness;
} body;

/* u at the angle of (x, z); 1 below the tangent. */
static float share(const crv__params *p, const crv__slice_site *site, const crv__slice *s,
                   float x, float z)
{
    const float inverse = 1 / sqrtf(x * x + z * z);
    const float cosine = z * inverse;
    if (!(cosine > s->cos_tangent))
        return 1;
    return crv__slice_share(p, site, s, cosine, x * inverse);
}

/* All sectors from this one on. */
static uint32_t from(float sector)
{
    const float first = fmaxf(0, ceilf(sector));
    return first < SECTORS ? UINT32_MAX << (uint32_t)first : 0;
}

static float count(uint32_t bits)
{
    bits -= bits >> 1 & 0x55555555u; /* sums of neighbours, of pairs, of fours */
    bits = (bits & 0x33333333u) + (bits >> 2 & 0x33333333u);
    bits = (bits + (bits >> 4)) & 0x0f0f0f0fu;
    return (float)(bits * 0x01010101u >> 24);
}

static void add_body(sectors *to, const crv__params *p, const crv__slice_site *site,
                     const crv__slice *s, const body *b)
{
    const float R = p->radius;
    const float front_x = b->x * (1 - 0.25f * (1 - b->texel->near));
    const float back_x = b->x * b->texel->far;
    const float end = sqrtf(fmaxf(0, R * R - front_x * front_x));
    const float front_z = fminf(b->z - s->b / site->a * (front_x - b->x), end);
    const float back_z = fmaxf(b->z - b->thickness, -end);
    if (!(front_z > back_z))
        return;
    const uint32_t bits =
        from(SECTORS * share(p, site, s, front_x, front_z) - s->sector_offset)
        & ~from(SECTORS * share(p, site, s, back_x, back_z) - s->sector_offset);
    const uint32_t new_bits = bits & ~to->mask;
    if (!new_bits)
        return;
    to->mask |= bits;
    const float r = fminf(sqrtf(b->x * b->x + b->z * b->z), R);
    const float middle = r - 0.7f * (r - b->x) * count(new_bits) / count(bits);
    const float W = crv__falloff(p, fminf(middle * p->inv_radius, CRV__FALLOFF_END));
    to->occlusion += W * count(new_bits) / SECTORS;
}

/* The thickness of the first surface at the texel by what is seen of it, and of sheets
 * behind it. */
static void seen_thickness(const sectors *so_far, const crv__frame *f,
                           const crv__slice_texel *texel, float x, float *first,
                           float *sheet)
{
    const crv__params *p = f->params;
    const float least = 0.1f * p->radius, run = x - so_far->start;
    float most = p->thickness;
    if (p->thickness_rule == CRV_THICKNESS_RUN)
        most = 2 * run;
    if (p->thickness_rule == CRV_THICKNESS_WIDTH)
        most = fminf(2.5f * run, crv__map_at(f, texel->u, texel->v));
    const bool grows = p->thickness_rule == CRV_THICKNESS_RUN
                       || p->thickness_rule == CRV_THICKNESS_WIDTH;
    *first = grows ? fmaxf(least, most) : most;
    *sheet = grows ? fmaxf(least, 0.5f * most) : most;
}

/* Length of the view ray through a texel over planar depth. */
static float ray_length(const crv__params *p, const crv__slice_texel *texel)
{
    if (p->orthographic)
        return 1;
    const crv__vec3 ray = crv__unproject(p, texel->u, texel->v, 1);
    return sqrtf(crv__dot(ray, ray));
}

/* The first surface at a texel, and those behind it. */
static void add_texel(sectors *to, const crv__frame *f, const crv__slice_site *site,
                      const crv__slice *s, const crv__slice_texel *texel)
{
    const crv__params *p = f->params;
    float d = crv__slice_depth(f, 0, texel);
    if (!(d < INFINITY)) {
        to->last_z = -INFINITY;
        return;
    }
    float thickness = 0, sheet = 0;
    for (int32_t layer = 0; layer < p->layers && d < INFINITY;) {
        const crv__vec2 point = crv__slice_point(p, site, s, texel, d);
        if (layer == 0) {
            if (point.y - to->last_z > 16 * (point.x - to->last_x))
                to->start = point.x;
            to->last_x = point.x;
            to->last_z = point.y;
            seen_thickness(to, f, texel, point.x, &thickness, &sheet);
        }
        float h = layer == 0 ? thickness : sheet;
        const float next =
            layer + 1 < p->layers ? crv__slice_depth(f, layer + 1, texel) : INFINITY;
        const float gap = (next - d) * ray_length(p, texel);
        if (gap < INFINITY)
            h = p->layers_solid || p->thickness_rule == CRV_THICKNESS_LAYERS
                    ? gap
                    : fminf(h, gap);
        if (point.x > 0)
            add_body(to, p, site, s, &(body){texel, point.x, point.y, h});
        layer += 1 + p->layers_solid;
        d = layer < p->layers ? crv__slice_depth(f, layer, texel) : INFINITY;
    }
}

static float blocked_share(const crv__frame *f, const crv__slice_site *site,
                           const crv__slice *s)
{
    sectors found = {0};
    for (int32_t i = 0; i < f->params->steps; i++) {
        crv__slice_texel texel;
        if (!crv__slice_texel_at(f->params, site, s, i, &texel))
            break;
        add_texel(&found, f, site, s, &texel);
    }
    return found.occlusion;
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    return crv__slices_open(f, x, y, blocked_share);
}

static const crv__map *map(const crv_options *options)
{
    return options->thickness_rule == CRV_THICKNESS_WIDTH ? &crv__map_width : NULL;
}

static const char *const OPTIONS[] = {
    "falloff",        "tau",       "u",         "directions", "steps",         "spacing",
    "thickness_rule", "thickness", "weighting", "border",     "max_radius_px", NULL};

const crv__method crv__method_bitmask = {
    .info = {.name = "bitmask",
             .title = "Visibility bit mask with grown thickness",
             .paper =
                 "Therrien, Levesque, Gilet 2023: Screen Space Indirect Lighting with "
                 "Visibility Bitmask",
             .weighting = CRV_WEIGHTING_COSINE,
             .options = OPTIONS},
    .accessibility = accessibility,
    .map = map,
    .presets = {"directions=2 steps=8", "directions=4 steps=8", "directions=4 steps=16",
                "directions=16 steps=32",
                "directions=2 steps=8 thickness_rule=constant falloff=none "
                "border=background"}};
