/* SPDX-License-Identifier: MIT */
/*
 * Ambient occlusion by containment tests.
 * Laszlo Szirmay-Kalos, Tamas Umenhoffer, Balazs Toth, Laszlo Szecsi, Mateu Sbert:
 * Volumetric Ambient Occlusion for Real-Time Rendering and Games, IEEE CG&A 2010.
 *
 * A ray that meets the surface at most once within the radius is free up to r exactly
 * if its point at r lies outside. With mu = 1 - W,
 *
 *     A = 1/pi Int Int mu'(r) I(P + w r) cos dr dw                             (eq. 4)
 *       ~ 1/n Sum I(P + r_i w_i),                                              (eq. 5)
 *
 * directions w_i with cosine density, r_i = mu^-1(xi_i).
 *
 * If a ray may meet the surface more often, or what it enters is thin, the point at r is
 * not enough. With `steps` > 1, points between P and it are tested as well, and the ray
 * is free if all of them are outside. That is the visibility which eq. 4 replaces; with 1
 * the estimator is the paper's.
 *
 * mu is monotone for every falloff but `alchemy`, whose W first rises from 0 to 1 (mu
 * falls from 1 to 0) up to r = u: there half of the points integrate the falling part,
 * with negative weight, and the start mu(0) = 1 is added.
 */
#include "core/pattern.h"
#include "core/registry.h"
#include "methods/characteristic.h"

#include <math.h>

/* Whether the ray from the site to `offset` is free. */
static int is_free(const crv__frame *f, const crv__site *site, crv__vec3 offset,
                   float beta)
{
    const crv__params *p = f->params;
    for (int32_t i = 1; i < p->steps; i++) {
        const float part = ((float)i + 0.5f * beta) / (float)p->steps;
        if (!crv__outside(f, site,
                          crv__add_scaled(site->lifted, offset, part * p->radius)))
            return 0;
    }
    return crv__outside(f, site, crv__add_scaled(site->lifted, offset, p->radius));
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const crv__site site = crv__site_at(f, x, y);
    crv__vec3 tangent, bitangent;
    crv__tangents(site.n, &tangent, &bitangent);
    float sum = p->falloff == CRV_FALLOFF_ALCHEMY ? 1 : 0;
    for (int32_t i = 0; i < p->samples; i++) {
        const float *point =
            f->pattern + 4 * i; /* r_i * direction in radii, and its weight */
        const crv__vec2 turned = crv__turned(noise, point[0], point[1]);
        const crv__vec3 offset = {
            turned.x * tangent.x + turned.y * bitangent.x + point[2] * site.n.x,
            turned.x * tangent.y + turned.y * bitangent.y + point[2] * site.n.y,
            turned.x * tangent.z + turned.y * bitangent.z + point[2] * site.n.z};
        if (is_free(f, &site, offset, noise->beta))
            sum += point[3];
    }
    return sum;
}

/* mu^-1(xi) in radii for the monotone falloffs. */
static double inverse_membership(const crv_options *o, double xi)
{
    switch (o->falloff) {
    case CRV_FALLOFF_NONE:
        return 1;
    case CRV_FALLOFF_LINEAR:
        return xi;
    case CRV_FALLOFF_SQRT:
        return xi * xi;
    case CRV_FALLOFF_CUBIC:
        return cbrt(xi);
    case CRV_FALLOFF_EXPONENTIAL: /* the rest of the mass lies at the radius */
        return o->tau > 0 ? fmin(1, -log(1 - xi) / (double)o->tau) : 1;
    case CRV_FALLOFF_ALCHEMY: /* the rising part: mu = 1 - u/q from q = u on */
        return fmin(1, (double)o->u / (1 - xi));
    }
    return 1;
}

static void pattern_fill(const crv_options *options, float *points)
{
    const int32_t count = options->samples;
    const int32_t falling = options->falloff == CRV_FALLOFF_ALCHEMY ? count / 2 : 0;
    crv__pattern_cube(points, count, options->seed);
    for (int32_t i = 0; i < count; i++) {
        float *point = points + 4 * i;
        const int is_falling = i % 2 == 1 && falling > 0;
        double x, y;
        crv__concentric((double)point[0], (double)point[1], &x, &y);
        const double z = sqrt(fmax(0, 1 - x * x - y * y)); /* cosine density (Malley) */
        const double xi = (double)point[2];
        const double r =
            is_falling ? xi * (double)options->u : inverse_membership(options, xi);
        point[0] = (float)(r * x);
        point[1] = (float)(r * y);
        point[2] = (float)(r * z);
        point[3] = is_falling ? -1.0f / (float)falling : 1.0f / (float)(count - falling);
    }
}

static const char *const OPTIONS[] = {"samples",        "falloff", "tau",       "u",
                                      "characteristic", "steps",   "thickness", NULL};

const crv__method crv__method_containment = {
    .info =
        {.name = "containment",
         .title = "Ambient occlusion by containment tests",
         .paper =
             "Szirmay-Kalos, Umenhoffer, Toth, Szecsi, Sbert 2010: Volumetric Ambient "
             "Occlusion for Real-Time Rendering and Games",
         .weighting = CRV_WEIGHTING_COSINE,
         .options = OPTIONS},
    .volumetric = 1,
    .accessibility = accessibility,
    .pattern_fill = pattern_fill,
    .presets = {"samples=12 steps=3", "samples=24 steps=5", "samples=64 steps=8",
                "samples=256 steps=16",
                "samples=8 steps=1 falloff=none thickness=0 filter=box4 filter_slope=off "
                "filter_normal=180"}};
