/* SPDX-License-Identifier: MIT */
/*
 * Volumetric obscurance by line samples.
 * Bradford Loos, Peter-Pike Sloan: Volumetric Obscurance, I3D 2010; the main comparison
 * of McGuire, Osman, Bukowski, Hennessy 2011.
 *
 * Lines along z of clip space pierce the full sphere of the radius around P. Each is open
 * from where it enters the sphere to the surface:
 *
 *     A = min(1, 2 Sum(open length) / Sum(chord length))
 *
 * Samples are pairs mirrored at P. Under a perspective camera a plane is linear in the
 * inverse of depth. Lengths are therefore measured in d - d^2/z, which is z - d to first
 * order: then each pair is exactly half open if the surface is any plane through P.
 */
#include "core/pattern.h"
#include "core/registry.h"
#include "methods/march.h"

/* The part of the chord [-half, half] in front of the surface at depth z, P being at
 * depth d. */
static float open_part(const crv__params *p, float d, float z, float half)
{
    /* d^2 of a far background would overflow. */
    const float behind = p->orthographic ? z - d : d - d * (d / z);
    return z < INFINITY ? fminf(fmaxf(behind, -half), half) + half : 2 * half;
}

/* The open length of a line: in front of the first layer, and, if layers are solid,
 * between a back and the next front. */
static float open_length(const crv__frame *f, int32_t u, int32_t v, float d, float half)
{
    const crv__params *p = f->params;
    if (!crv__plane_holds(&f->depth[0], u, v))
        return 2 * half;
    float open = 0, closed = 0; /* `closed`: how far the line is decided */
    for (int32_t layer = 0; layer < p->layers; layer += 2) {
        const float front = open_part(p, d, *crv__plane_at(&f->depth[layer], u, v), half);
        open += fmaxf(0, front - closed);
        if (!p->layers_solid || layer + 1 >= p->layers)
            return open;
        closed = fmaxf(front,
                       open_part(p, d, *crv__plane_at(&f->depth[layer + 1], u, v), half));
    }
    return open + 2 * half - closed;
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const float d = *crv__plane_at(&f->depth[0], x, y), unit = p->orthographic ? 1 : d;
    const float radius_x = p->radius * p->fx / unit, radius_y = p->radius * p->fy / unit;
    /* Pixels farther out than this are background anyway, and would not fit an integer.
     */
    if (!(fmaxf(radius_x, radius_y) < 1e9f))
        return 1;
    float open = 0, total = 0;
    for (int32_t i = 0; i < p->samples; i++) {
        const float *point = f->pattern + 4 * i;
        const crv__vec2 disk = crv__turned(noise, point[0], point[1]);
        const int32_t u = x + (int32_t)lrintf(disk.x * radius_x);
        const int32_t v = y - (int32_t)lrintf(disk.y * radius_y);
        /* The chord of the line through the texel's centre. */
        const float offset_x = (float)(u - x) / radius_x,
                    offset_y = (float)(v - y) / radius_y;
        const float rest = 1 - offset_x * offset_x - offset_y * offset_y;
        if (!(rest > 0))
            continue;
        const float half = p->radius * sqrtf(rest);
        open += open_length(f, u, v, d, half);
        total += 2 * half;
    }
    return total > 0 ? fminf(1, 2 * open / total) : 1;
}

static void pattern_fill(const crv_options *options, float *points)
{
    crv__pattern_disk_pairs(points, options->samples, options->seed);
}

static const char *const OPTIONS[] = {"samples", NULL};

const crv__method crv__method_vo = {
    .info = {.name = "vo",
             .title = "Volumetric obscurance by line samples",
             .paper = "Loos, Sloan 2010: Volumetric Obscurance",
             .weighting = CRV_WEIGHTING_UNIFORM,
             .options = OPTIONS},
    .volumetric = 1,
    .accessibility = accessibility,
    .pattern_fill = pattern_fill,
    .presets = {"samples=6", "samples=12", "samples=32", "samples=128",
                "samples=12 filter=bilateral13 filter_slope=off filter_normal=180"}};
