/* SPDX-License-Identifier: MIT */
/*
 * Alchemy ambient obscurance.
 * Morgan McGuire, Brian Osman, Michael Bukowski, Padraic Hennessy: The Alchemy
 * Screen-Space Ambient Obscurance Algorithm, HPG 2011.
 *
 * With the falloff u t / max(u, t)^2 the normalisation of v = S - P cancels out of the
 * integrand. Over s samples of a disk of the radius around P, parallel to the image,
 *
 *     A = max(0, 1 - 2 sigma/s Sum max(0, v.n - d beta) / (v.v + eps))^k      (eq. 10)
 *
 * sigma and k are the options intensity and contrast, which are applied after every
 * method.
 *
 * In the paper sigma is a length and eps an area, in metres (1 m, 1e-4 m^2), for a radius
 * of 0.5 m. Here both are relative to the radius, so that the unit of the scene does not
 * matter:
 *
 *     sigma = R intensity,    eps = R^2 alchemy_eps
 *
 * The preset `paper` sets the numbers of the paper's picture: intensity 2, eps 4e-4.
 */
#include "core/pattern.h"
#include "core/registry.h"
#include "methods/march.h"

/* Samples for a projected radius: in `bands` steps from samples/bands to all of them. */
static int32_t sample_count(const crv__params *p, float radius_px)
{
    const float band = ceilf((float)p->bands * radius_px / p->band_px);
    const int32_t used =
        band < (float)p->bands ? (band > 1 ? (int32_t)band : 1) : p->bands;
    return (p->samples * used + p->bands - 1) / p->bands;
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const float d = *crv__plane_at(&f->depth[0], x, y);
    const crv__vec3 P = crv__unproject(p, x, y, d), n = crv__normal_at(f, x, y);
    const float unit = p->orthographic ? 1 : d;
    const float radius_x = p->radius * p->fx / unit, radius_y = p->radius * p->fy / unit;
    const int32_t count = sample_count(p, fmaxf(radius_x, radius_y));
    const float eps = p->alchemy_eps * p->radius * p->radius;

    float sum = 0;
    for (int32_t i = 0; i < count; i++) {
        const float *point =
            f->pattern + 4 * i; /* unit disk; prefixes are well spread too */
        const crv__vec2 disk = crv__turned(noise, point[0], point[1]);
        const float sx = (float)x + 0.5f + disk.x * radius_x;
        const float sy = (float)y + 0.5f - disk.y * radius_y;
        if (!(sx >= 0 && sx < (float)p->width && sy >= 0 && sy < (float)p->height))
            continue;
        for (int32_t layer = 0; layer < p->layers; layer++) {
            const int32_t u = (int32_t)sx, v = (int32_t)sy;
            const float depth = *crv__plane_at(&f->depth[layer], u, v);
            if (!(depth < INFINITY))
                continue;
            const crv__vec3 to = crv__sub(crv__unproject(p, u, v, depth), P);
            const float squared = crv__dot(to, to);
            if (!(squared <= p->radius * p->radius))
                continue; /* H(R - r) of eq. 9; a layer behind may lie within */
            sum += fmaxf(0, crv__dot(to, n) - d * p->alchemy_bias) / (squared + eps);
            break;
        }
    }
    return 1 - 2 * p->radius * sum / (float)count;
}

static void pattern_fill(const crv_options *options, float *points)
{
    crv__pattern_disk(points, options->samples, options->seed);
}

static const char *const OPTIONS[] = {"samples",      "bands",       "band_px",
                                      "alchemy_bias", "alchemy_eps", NULL};

const crv__method crv__method_alchemy = {
    .info =
        {.name = "alchemy",
         .title = "Alchemy ambient obscurance",
         .paper =
             "McGuire, Osman, Bukowski, Hennessy 2011: The Alchemy Screen-Space Ambient "
             "Obscurance Algorithm",
         .weighting = CRV_WEIGHTING_COSINE,
         .options = OPTIONS},
    .accessibility = accessibility,
    .pattern_fill = pattern_fill,
    .presets = {"samples=6", "samples=12", "samples=32", "samples=128",
                "samples=12 bands=3 intensity=2 alchemy_eps=4e-4 filter=bilateral13 "
                "filter_slope=off filter_normal=180"}};
