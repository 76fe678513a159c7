/* SPDX-License-Identifier: MIT */
/*
 * Screen-space ambient occlusion of CryEngine 2.
 * Martin Mittring: Finding Next Gen: CryEngine 2, SIGGRAPH 2007 courses; the baseline of
 * Szirmay-Kalos et al. 2010 (Figure 11).
 *
 * Points are distributed in the whole sphere of the radius around P. A is the share of
 * them in front of the stored depth. Half the sphere lies behind any surface, so a flat
 * wall is 0.5, as in the original; the option `rescale` doubles A.
 */
#include "core/pattern.h"
#include "core/registry.h"
#include "methods/characteristic.h"

#include <math.h>

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const crv__vec3 P = crv__unproject(p, x, y, *crv__plane_at(&f->depth[0], x, y));
    int32_t outside = 0;
    for (int32_t i = 0; i < p->samples; i++) {
        const float *point = f->pattern + 4 * i;
        const crv__vec2 turned = crv__turned(noise, point[0], point[1]);
        const crv__vec3 offset = {turned.x, turned.y, point[2]};
        outside += crv__outside_depth(f, crv__add_scaled(P, offset, p->radius), INFINITY);
    }
    const float share = (float)outside / (float)p->samples;
    return p->rescale ? fminf(1, 2 * share) : share;
}

/* Uniform in the ball, -p after each p: a plane through P has exactly half of them behind
 * it. */
static void pattern_fill(const crv_options *options, float *points)
{
    const double pi = 3.14159265358979323846;
    crv__pattern_cube(points, options->samples, options->seed);
    for (int32_t i = options->samples - 1; i >= 0; i--) {
        const float *source = points + 4 * (i / 2);
        const double z = 2 * (double)source[0] - 1, angle = 2 * pi * (double)source[1];
        const double sign = i % 2 ? -1 : 1;
        const double r = sign * cbrt((double)source[2]), xy = sqrt(fmax(0, 1 - z * z));
        points[4 * i] = (float)(r * xy * cos(angle));
        points[4 * i + 1] = (float)(r * xy * sin(angle));
        points[4 * i + 2] = (float)(r * z);
        points[4 * i + 3] = 1;
    }
}

static const char *const OPTIONS[] = {"samples", "rescale", NULL};

const crv__method crv__method_ssao = {
    .info = {.name = "ssao",
             .title = "Screen-space ambient occlusion of CryEngine 2",
             .paper = "Mittring 2007: Finding Next Gen: CryEngine 2",
             .weighting = CRV_WEIGHTING_UNIFORM,
             .options = OPTIONS},
    .volumetric = 1,
    .accessibility = accessibility,
    .pattern_fill = pattern_fill,
    .presets = {"samples=8", "samples=16", "samples=32", "samples=128",
                "samples=8 filter=box4 filter_slope=off filter_normal=180"}};
