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
 * samples. Its front lies three tenths of the way to t_lo, moved parallel to the tangent
 * plane; its back lies at t_hi. Both are clipped to the sphere of the radius.
 *
 *     xf = x (1 - 0.3 (1 - t_lo/t))    zf = min(z - (b/a)(xf - x), sqrt(R^2 - xf^2))
 *     xb = x t_hi/t                    zb = max(z - h, -sqrt(R^2 - xf^2))
 *
 * Each newly set bit weighs W. The nearer of them lie at the front, at r; the farther at
 * the body's side, at x:  W(r - 0.7 (r - x) |new|/|bits|),  r = min(|(x, z)|, R).
 *
 * For the bent normal a sector counts as the mean direction of the four sectors that it
 * is grouped with, g = 0 to 7 from V on. A group lies at the angle theta_g from V:
 *
 *     O = Ft/32 Sum (4 - W_g) w_g,   K = Ft/32 Sum W_g w_g,   W_g: weights of its bits
 *     w_g = T sin theta_g + V cos theta_g
 *
 *     uniform:  cos theta_g = 1 - u_g (1 - cos tt),   u_g = (g + 1/2)/8
 *     cosine:   theta_g = tt/2 (1 + v_g (1 - t (0.13 + 0.1 t) (1 - v_g^2))),
 *               t = 2 tt/pi - 1
 *
 * With cosine weighting F has no inverse in closed form. Measured from the middle between
 * V and the tangent it is odd,
 *
 *     F - Ft/2 = (r sin(2 d)/2 + b d)/2,   d = theta - tt/2,   r = sqrt(a^2 + b^2)
 *
 * so that v_g is, too. v_g are the means for b = 0, where d = asin(2 u - 1)/2; the cubic
 * term is fitted to the other b. theta_g is within 0.4 degrees of the group's mean
 * direction where V is within 70 degrees of the normal, and within 2.4 degrees at most.
 */
#include "core/registry.h"
#include "methods/slice.h"
#include "methods/width.h"

enum { SECTORS = 32, GROUPS = 8, GROUP_SECTORS = SECTORS / GROUPS };

/* A slice so far. */
typedef struct sectors {
    uint32_t mask;
    float occlusion;
    float blocked[GROUPS]; /* W_g */
    float start;           /* x0 */
    float last_x, last_z;  /* of the sample before */
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
                     const crv__slice *s, const body *b, bool with_vectors)
{
    const float R = p->radius;
    const float front_x = b->x * (1 - 0.3f * (1 - b->texel->near));
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
    for (uint32_t g = 0; with_vectors && g < GROUPS; g++)
        to->blocked[g] += W * count(new_bits >> GROUP_SECTORS * g & 0xf);
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
                      const crv__slice *s, const crv__slice_texel *texel,
                      bool with_vectors)
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
            add_body(to, p, site, s, &(body){texel, point.x, point.y, h}, with_vectors);
        layer += 1 + p->layers_solid;
        d = layer < p->layers ? crv__slice_depth(f, layer, texel) : INFINITY;
    }
}

/* w_g: x along T, y along V. */
static crv__vec2 group_direction(const crv__params *p, const crv__slice *s, int32_t g)
{
    if (p->weighting == CRV_WEIGHTING_UNIFORM) {
        const float u = ((float)g + 0.5f) / GROUPS;
        const float cosine = 1 - u * (1 - s->cos_tangent);
        return (crv__vec2){sqrtf(fmaxf(0, 1 - cosine * cosine)), cosine};
    }
    static const float MEANS[GROUPS] = {-0.69591f, -0.43203f, -0.2455f, -0.08f,
                                        0.08f,     0.2455f,   0.43203f, 0.69591f};
    const float tangent = crv__slice_segment(s->cos_tangent, s->sin_tangent)
                          + s->cos_tangent * s->sin_tangent;
    const float v = MEANS[g], t = 0.63661977f * tangent - 1;
    const float theta =
        0.5f * tangent * (1 + v * (1 - t * (0.13f + 0.1f * t) * (1 - v * v)));
    return (crv__vec2){sinf(theta), cosf(theta)};
}

static crv__slice_vectors vectors_of(const sectors *found, const crv__params *p,
                                     const crv__slice *s)
{
    crv__slice_vectors sum = {{0, 0}, {0, 0}};
    const float measure = s->total / SECTORS;
    for (int32_t g = 0; g < GROUPS; g++) {
        const crv__vec2 w = group_direction(p, s, g);
        const float blocked = measure * found->blocked[g],
                    open = measure * (GROUP_SECTORS - found->blocked[g]);
        sum.open.x += open * w.x;
        sum.open.y += open * w.y;
        sum.blocked.x += blocked * w.x;
        sum.blocked.y += blocked * w.y;
    }
    return sum;
}

static float blocked_share(const crv__frame *f, const crv__slice_site *site,
                           const crv__slice *s, crv__slice_vectors *vectors)
{
    sectors found = {0};
    for (int32_t i = 0; i < f->params->steps; i++) {
        crv__slice_texel texel;
        if (!crv__slice_texel_at(f->params, site, s, i, &texel))
            break;
        add_texel(&found, f, site, s, &texel, vectors);
    }
    if (vectors)
        *vectors = vectors_of(&found, f->params, s);
    return found.occlusion;
}

static float estimate(const crv__frame *f, int32_t x, int32_t y, crv__vec3 *bent)
{
    return crv__slices_open(f, x, y, blocked_share, bent);
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    return estimate(f, x, y, NULL);
}

static const crv__map *map(const crv_options *options)
{
    return options->thickness_rule == CRV_THICKNESS_WIDTH ? &crv__map_width : NULL;
}

static const char *const OPTIONS[] = {"falloff",
                                      "tau",
                                      "u",
                                      "directions",
                                      "steps",
                                      "spacing",
                                      "thickness_rule",
                                      "thickness",
                                      "weighting",
                                      "border",
                                      "max_radius_px",
                                      "bent_normal",
                                      NULL};

const crv__method crv__method_bitmask = {
    .info = {.name = "bitmask",
             .title = "Visibility bit mask with grown thickness",
             .paper =
                 "Therrien, Levesque, Gilet 2023: Screen Space Indirect Lighting with "
                 "Visibility Bitmask",
             .weighting = CRV_WEIGHTING_COSINE,
             .options = OPTIONS,
             .bent_normal = 1},
    .accessibility = accessibility,
    .estimate = estimate,
    .map = map,
    .presets = {"directions=3 steps=6", "directions=5 steps=7", "directions=6 steps=10",
                "directions=16 steps=32",
                "directions=2 steps=8 thickness_rule=constant falloff=none "
                "border=background"}};
