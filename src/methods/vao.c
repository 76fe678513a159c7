/* SPDX-License-Identifier: MIT */
/*
 * Volumetric ambient occlusion.
 * Laszlo Szirmay-Kalos, Tamas Umenhoffer, Balazs Toth, Laszlo Szecsi, Mateu Sbert:
 * Volumetric Ambient Occlusion for Real-Time Rendering and Games, IEEE CG&A 2010.
 *
 * The open share of the volume of the tangent sphere: radius R/2, centre P + n R/2. N
 * pipes along z of clip space pierce it. dz_i is the length of the part outside the
 * surface:
 *
 *     A = Sum dz_i / F                                                    (eq. 6, 7)
 *
 *     F = 2 R N / 3                     normaliser analytic: the sphere's exact volume
 *     F = Sum of the chords' lengths    weighted: weighted importance sampling
 *
 * If a ray meets the surface at most once within R, this is cosine-weighted occlusion
 * with the cubic falloff.
 *
 * A pipe's disk point is snapped to a texel, and the pipe is that texel's view ray: on it
 * the depth buffer is exact. The chord is that of the snapped ray.
 */
#include "core/pattern.h"
#include "core/registry.h"
#include "methods/characteristic.h"
#include "methods/pipe.h"

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const crv__site site = crv__site_at(f, x, y);
    const float radius = 0.5f * p->radius;
    const crv__vec3 offset = {site.n.x * radius, site.n.y * radius, site.n.z * radius};
    float open = 0, chords = 0;
    for (int32_t i = 0; i < p->samples; i++) {
        crv__pipe pipe;
        if (!crv__pipe_through(p, x, y, site.P, offset, radius, f->pattern + 4 * i, noise,
                               &pipe))
            continue;
        open += crv__pipe_outside(f, &site, &pipe);
        chords += pipe.exit - pipe.entry;
    }
    if (p->normaliser == CRV_NORMALISER_ANALYTIC)
        return open / (2.0f / 3.0f * p->radius * (float)p->samples);
    return chords > 0 ? open / chords : 1;
}

static void pattern_fill(const crv_options *options, float *points)
{
    crv__pattern_disk(points, options->samples, options->seed);
}

static const char *const OPTIONS[] = {"samples", "normaliser", "characteristic", NULL};

const crv__method crv__method_vao = {
    .info =
        {.name = "vao",
         .title = "Volumetric ambient occlusion",
         .paper =
             "Szirmay-Kalos, Umenhoffer, Toth, Szecsi, Sbert 2010: Volumetric Ambient "
             "Occlusion for Real-Time Rendering and Games",
         .weighting = CRV_WEIGHTING_COSINE,
         .options = OPTIONS},
    .volumetric = 1,
    .accessibility = accessibility,
    .pattern_fill = pattern_fill,
    .presets = {"samples=6", "samples=12", "samples=32", "samples=128",
                "samples=8 filter=box4 filter_slope=off filter_normal=180"}};
