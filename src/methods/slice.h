/* SPDX-License-Identifier: MIT */
/*
 * Slices through the eye: what gtao and bitmask share.
 *
 * The hemisphere over P is cut by half planes that hold the direction V to the eye; each
 * is seen as a line in the image, so that the depth buffer holds all that is known of it.
 *
 *     V = -P/|P|   (orthographic: the z axis)      a = max(n.V, 0.02)
 *     D = (cos phi, sin phi, 0),   phi = 2 pi (k + u)/Nd,   u the pixel's rotation
 *     T = norm(D - (D.V) V)        b = n.T         w = 1/(1 - (D.V)^2)
 *
 * In the slice, directions are theta from V towards T. The measure up to theta is
 *
 *     cosine:   F(theta) = Int (n.w) sin = (a sin^2 + b (theta - sin cos))/2
 *     uniform:  F(theta) = Int sin       = 1 - cos
 *
 * and ends at the tangent tt, where n.w = 0: cos tt = -b/sqrt(a^2 + b^2), Ft = F(tt). w
 * is how densely the slices lie around P seen at equal angles in the image. With occ the
 * blocked share of a slice's measure,
 *
 *     A = 1 - Sum w Ft occ / Sum w Ft
 *
 * a ratio: an open plane is 1 exactly, for any Nd.
 *
 * The bent normal (bent.h) sums directions w = T sin + V cos over each slice, times its
 * weight. Up to theta that is
 *
 *     cosine:   G(theta) = Int (n.w) w sin
 *                        = T (a sin^3 + b (2 - 3 cos + cos^3))/3
 *                        + V (b sin^3 + a (1 - cos^3))/3
 *     uniform:  G(theta) = Int w sin = (T (theta - sin cos) + V sin^2)/2
 *
 * Samples lie at t = (R f/d) ((i + j_k)/Ns)^2 px (spacing quadratic), at least 1, snapped
 * to texel centres, because depth belongs to texel centres only. That turns them a little
 * out of the slice; they are moved back onto it parallel to the tangent plane, so that a
 * plane stays one:
 *
 *     v = S - P,   x = v.T,   z = (v.n - b x)/a - e ds/d
 *
 * 1/a multiplies what depth and normals are off by at grazing angles. So P is raised by
 * e: along n, that is up to a quarter of a pixel's footprint at its depth, and nothing if
 * V is within 60 degrees of n. A plane stays open, for then it lies below the tangent.
 *
 *     e = d max(1/fx, 1/fy) max(0, 1/4 - a/2)/a      orthographic: without d and ds/d
 */
#ifndef CRV_METHODS_SLICE_H
#define CRV_METHODS_SLICE_H

#include "core/border.h"
#include "core/falloff.h"
#include "methods/bent.h"

#include <stdbool.h>

/* The shaded point. */
typedef struct crv__slice_site {
    int32_t x, y;
    float depth;
    float unit; /* of offsets on the image plane: the depth; orthographic: 1 */
    crv__vec3 n;
    crv__vec3 ray; /* view ray at unit depth */
    crv__vec3 V;
    float a;
    float lift;     /* e/d; orthographic: e */
    float nearness; /* 1/unit, less if the radius would project beyond max_radius_px */
} crv__slice_site;

typedef struct crv__slice {
    crv__vec3 T;
    float b, weight;
    float cos_tangent, sin_tangent;
    float total;          /* Ft */
    float inverse;        /* 1 / Ft */
    float step_x, step_y; /* unit vector in the image, to the right and down */
    float length_px;      /* the radius along it */
    float jitter;         /* j_k in [0, 1): of the samples */
    float sector_offset;  /* zeta_k in [0, 1): of bitmask's sectors */
} crv__slice;

static inline crv__slice_site crv__slice_site_at(const crv__frame *f, int32_t x,
                                                 int32_t y)
{
    const crv__params *p = f->params;
    const float d = *crv__plane_at(&f->depth[0], x, y);
    crv__slice_site site = {.x = x,
                            .y = y,
                            .depth = d,
                            .unit = p->orthographic ? 1 : d,
                            .n = crv__normal_at(f, x, y),
                            .ray = {0, 0, -1},
                            .V = {0, 0, 1}};
    if (!p->orthographic) {
        site.ray.x = ((float)x + 0.5f - p->cx) * p->inv_fx;
        site.ray.y = -((float)y + 0.5f - p->cy) * p->inv_fy;
        const float inverse = 1 / sqrtf(crv__dot(site.ray, site.ray));
        site.V = (crv__vec3){-site.ray.x * inverse, -site.ray.y * inverse, inverse};
    }
    site.a = fmaxf(crv__dot(site.n, site.V), 0.02f);
    site.lift = fmaxf(p->inv_fx, p->inv_fy) * fmaxf(0, 0.25f - 0.5f * site.a) / site.a;
    const float largest = fmaxf(p->fx, p->fy) * p->radius / site.unit;
    site.nearness = 1 / site.unit;
    if (largest > p->max_radius_px)
        site.nearness *= p->max_radius_px / largest;
    return site;
}

/*
 * theta - sin cos of the angle of these cosine and sine. Without a branch or root:
 *
 *     theta - sin cos = pi/2 - (asin c + c s) = pi/2 - c Q(s)
 *
 * with Q of degree 3, within 6e-4.
 */
static inline float crv__slice_segment(float cosine, float sine)
{
    const float Q =
        1.57020562f + sine * (0.02568289f + sine * (0.60547927f - sine * 0.20501906f));
    return 1.57079633f - cosine * Q;
}

/* F at the angle of these cosine and sine. */
static inline float crv__slice_measure(const crv__params *p, float a, float b,
                                       float cosine, float sine)
{
    if (p->weighting == CRV_WEIGHTING_UNIFORM)
        return 1 - cosine;
    return 0.5f * (a * sine * sine + b * crv__slice_segment(cosine, sine));
}

/* G at this angle: x along T, y along V. */
static inline crv__vec2 crv__slice_vector(const crv__params *p, float a, float b,
                                          float cosine, float sine)
{
    if (p->weighting == CRV_WEIGHTING_UNIFORM)
        return (crv__vec2){0.5f * crv__slice_segment(cosine, sine), 0.5f * sine * sine};
    const float sine3 = sine * sine * sine, rest = 1 - cosine;
    /* 2 - 3 c + c^3 and 1 - c^3, without the difference of what is nearly alike. */
    const float along_T = rest * rest * (2 + cosine),
                along_V = rest * (1 + cosine + cosine * cosine);
    return (crv__vec2){(a * sine3 + b * along_T) * (1.0f / 3),
                       (b * sine3 + a * along_V) * (1.0f / 3)};
}

/* u = F/Ft at the angle of the point (x, z), x > 0; at most 1. */
static inline float crv__slice_share(const crv__params *p, const crv__slice_site *site,
                                     const crv__slice *s, float cosine, float sine)
{
    const float F = crv__slice_measure(p, site->a, s->b, cosine, sine);
    return fminf(1, fmaxf(0, F * s->inverse));
}

/* The k-th slice; false where its measure is nothing. */
static inline bool crv__slice_at(const crv__frame *f, const crv__slice_site *site,
                                 const crv__noise_texel *noise, int32_t k, crv__slice *s)
{
    const crv__params *p = f->params;
    const crv__vec2 D = crv__direction(f, noise, k);
    const crv__vec3 V = site->V;
    const float DV = D.x * V.x + D.y * V.y, squared = 1 - DV * DV;
    const float scale = 1 / sqrtf(squared);
    s->T = (crv__vec3){(D.x - DV * V.x) * scale, (D.y - DV * V.y) * scale,
                       -DV * V.z * scale};
    s->b = crv__dot(site->n, s->T);
    s->weight = 1 / squared;
    const float inverse = 1 / sqrtf(site->a * site->a + s->b * s->b);
    s->cos_tangent = -s->b * inverse;
    s->sin_tangent = site->a * inverse;
    s->total = crv__slice_measure(p, site->a, s->b, s->cos_tangent, s->sin_tangent);
    s->inverse = 1 / s->total;
    const float px_x = D.x * p->fx, px_y = -D.y * p->fy;
    const float length = sqrtf(px_x * px_x + px_y * px_y);
    s->step_x = px_x / length;
    s->step_y = px_y / length;
    s->length_px = p->radius * site->nearness * length;
    s->jitter = crv__stratum(noise, k);
    const float offset = noise->sector_offset + 0.754878f * (float)k;
    s->sector_offset = offset - floorf(offset);
    /* Focal lengths whose squares are no floats have no direction in the image. */
    return s->total > 1e-7f && length > 0 && length < INFINITY;
}

/* The texel of a sample, and the cell of the spacing that the sample stands for. */
typedef struct crv__slice_texel {
    int32_t u, v;
    float near, far; /* the cell's ends, in units of the sample's distance */
} crv__slice_texel;

static inline float crv__slice_spaced(const crv__params *p, float t)
{
    t /= (float)p->steps;
    return p->spacing == CRV_SPACING_QUADRATIC ? t * t : t;
}

/* The i-th sample. false where it is farther off than pictures are large. */
static inline bool crv__slice_texel_at(const crv__params *p, const crv__slice_site *site,
                                       const crv__slice *s, int32_t i,
                                       crv__slice_texel *texel)
{
    const float t = fmaxf(1, crv__slice_spaced(p, (float)i + s->jitter) * s->length_px);
    if (!(t < (float)(4 * CRV_MAX_SIZE)))
        return false;
    texel->u = (int32_t)floorf((float)site->x + 0.5f + t * s->step_x);
    texel->v = (int32_t)floorf((float)site->y + 0.5f + t * s->step_y);
    texel->near =
        fminf(1, fmaxf(0.5f, crv__slice_spaced(p, (float)i) * s->length_px) / t);
    texel->far = fmaxf(1, crv__slice_spaced(p, (float)(i + 1)) * s->length_px / t);
    return true;
}

/* The first layer's depth beyond the borders: planes go on, up to a third of the border's
 * own. Beyond three times that there is nothing: less than the plane's depth would be in
 * front of it. */
static inline float crv__slice_beyond(const crv__frame *f, int32_t u, int32_t v)
{
    const crv__params *p = f->params;
    const int32_t right = p->width - 1, bottom = p->height - 1;
    const int32_t x = u < 0 ? 0 : u > right ? right : u;
    const int32_t y = v < 0 ? 0 : v > bottom ? bottom : v;
    const float d = *crv__plane_at(&f->depth[0], x, y);
    if (p->border == CRV_BORDER_BACKGROUND || !(d < INFINITY))
        return INFINITY;
    const float own = crv__border_linear(f, x, y);
    float w = own;
    if (u != x)
        w += crv__border_outward(f, x, y, u < 0 ? 1 : -1, 0, own) * fabsf((float)(u - x));
    if (v != y)
        w += crv__border_outward(f, x, y, 0, v < 0 ? 1 : -1, own) * fabsf((float)(v - y));
    if (p->orthographic)
        return w > 3 * own ? INFINITY : fmaxf(own / 3, w);
    return w < own / 3 ? INFINITY : 1 / fminf(3 * own, w);
}

static inline bool crv__slice_is_inside(const crv__params *p,
                                        const crv__slice_texel *texel)
{
    return texel->u >= 0 && texel->u < p->width && texel->v >= 0 && texel->v < p->height;
}

/* The depth of a layer at a texel; INFINITY: background. */
static inline float crv__slice_depth(const crv__frame *f, int32_t layer,
                                     const crv__slice_texel *texel)
{
    if (crv__slice_is_inside(f->params, texel))
        return *crv__plane_at(&f->depth[layer], texel->u, texel->v);
    return layer == 0 ? crv__slice_beyond(f, texel->u, texel->v) : INFINITY;
}

/* The surface at a texel and depth, on the slice: x from P along T, z towards the eye. */
static inline crv__vec2 crv__slice_point(const crv__params *p,
                                         const crv__slice_site *site, const crv__slice *s,
                                         const crv__slice_texel *texel, float depth)
{
    const crv__vec3 offset = {(float)(texel->u - site->x) * p->inv_fx,
                              -(float)(texel->v - site->y) * p->inv_fy, 0};
    crv__vec3 ray = site->ray;
    if (!p->orthographic) {
        ray.x += offset.x;
        ray.y += offset.y;
    }
    /* Small differences first: depth is large. */
    const float behind = depth - site->depth;
    const crv__vec3 v = {behind * ray.x + site->unit * offset.x,
                         behind * ray.y + site->unit * offset.y, -behind};
    const float x = crv__dot(v, s->T);
    const float lift = p->orthographic ? site->lift : site->lift * depth;
    return (crv__vec2){x, (crv__dot(v, site->n) - s->b * x) / site->a - lift};
}

/* O and K of a slice: x along T, y along V. */
typedef struct crv__slice_vectors {
    crv__vec2 open, blocked;
} crv__slice_vectors;

/* The blocked share of a slice's measure. vectors NULL: not wanted. */
typedef float (*crv__slice_fn)(const crv__frame *f, const crv__slice_site *site,
                               const crv__slice *s, crv__slice_vectors *vectors);

static inline crv__vec3 crv__slice_add(crv__vec3 sum, const crv__slice_site *site,
                                       const crv__slice *s, crv__vec2 vector)
{
    return crv__add_scaled(crv__add_scaled(sum, s->T, s->weight * vector.x), site->V,
                           s->weight * vector.y);
}

/* A of a pixel, the open share of all slices; and its bent normal, if bent is not NULL.
 */
static inline float crv__slices_of(const crv__frame *f, const crv__slice_site *site,
                                   crv__slice_fn blocked_share, crv__vec3 *bent)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, site->x, site->y);
    float blocked = 0, total = 0;
    crv__bent_sums sums = {{0, 0, 0}, {0, 0, 0}};
    for (int32_t k = 0; k < p->directions; k++) {
        crv__slice s;
        crv__slice_vectors vectors;
        if (!crv__slice_at(f, site, noise, k, &s))
            continue;
        blocked +=
            s.weight * s.total * blocked_share(f, site, &s, bent ? &vectors : NULL);
        total += s.weight * s.total;
        if (bent) {
            sums.open = crv__slice_add(sums.open, site, &s, vectors.open);
            sums.blocked = crv__slice_add(sums.blocked, site, &s, vectors.blocked);
        }
    }
    const float A = total > 0 ? 1 - blocked / total : 1;
    if (bent) {
        const float h =
            p->weighting == CRV_WEIGHTING_COSINE ? CRV__BENT_COSINE : CRV__BENT_UNIFORM;
        *bent = crv__bent_normal(&sums, site->n, A, h * total);
    }
    return A;
}

static inline float crv__slices_open(const crv__frame *f, int32_t x, int32_t y,
                                     crv__slice_fn blocked_share, crv__vec3 *bent)
{
    const crv__slice_site site = crv__slice_site_at(f, x, y);
    return crv__slices_of(f, &site, blocked_share, bent);
}

#endif
