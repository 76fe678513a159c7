/* SPDX-License-Identifier: MIT */
/*
 * The scalar reference of the deinterleaved structure, written from its description: 16
 * pixels of a row, every fourth column of a span of 64, share a few buckets of projected
 * radii, four an octave and for vo sixteen, of which one serves its neighbours. Samples
 * of hbao and alchemy that are 32 pixels away or more are at multiples of 4 pixels.
 */
#include "deinterleaved_reference.h"

#include "deinterleaved_samples.h"

#include "core/falloff.h"
#include "core/gbuffer.h"
#include "core/setup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LANES = 16, PHASES = 4, SPAN = LANES * PHASES, OCTAVES = 14 };

typedef struct reference {
    const simd_case *c;
    crv__params params;
    crv__frame frame;
    float background;  /* the depth from which on there is no surface */
    int32_t left, top; /* of the buffers' first pixel in the picture's spans and phases */
} reference;

static int32_t wrapped(int32_t value, int32_t size)
{
    return (value % size + size) % size;
}

static int is_surface(const reference *s, int32_t x, int32_t y)
{
    return x >= 0 && x < s->params.width
           && *crv__plane_at(&s->frame.depth[0], x, y) < s->background;
}

/* Whether a method marches in directions; others have the points of a pattern. */
static bool in_slices(const crv_options *options)
{
    return !crv__method_of(options->method)->pattern_fill;
}

/* Buckets of an octave. */
static int32_t fineness(const simd_case *c)
{
    return strcmp(c->options.method->name, "vo") == 0 ? 16 : 4;
}

/* What the radii of a phase are multiplied with before they are sorted into buckets. */
static float scale_of(const reference *s, int32_t px, int32_t py)
{
    static const int RANK[4][4] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    return exp2f((((float)RANK[py][px] + 0.5f) / 16 - 0.5f) / (float)fineness(s->c));
}

/* The vertical projected radius in pixels. */
static float radius_at(const reference *s, int32_t x, int32_t y)
{
    const crv__params *p = &s->params;
    const float d = *crv__plane_at(&s->frame.depth[0], x, y);
    return p->radius * p->fy * (p->orthographic ? 1 : 1 / d);
}

/* Buckets part the space between powers of two evenly, the first begins at 1/2. -1: no
 * surface, or beyond all. */
static int32_t bucket_at(const reference *s, int32_t x, int32_t y)
{
    const crv__params *p = &s->params;
    if (!is_surface(s, x, y))
        return -1;
    float radius = radius_at(s, x, y);
    const int32_t parts = fineness(s->c);
    if (!(radius < 0.5f * (1 << OCTAVES) * exp2f(-0.5f / (float)parts) * 0.99f))
        return -1;
    if (in_slices(&s->c->options)) {
        const float cap =
            p->fx > p->fy ? p->max_radius_px * (p->fy / p->fx) : p->max_radius_px;
        radius = fminf(radius, cap);
    }
    radius =
        fmaxf(radius * scale_of(s, (x + s->left) % PHASES, (y + s->top) % PHASES), 0.5f);
    int exponent;
    const float mantissa = 2 * frexpf(radius, &exponent);
    return parts * exponent + (int32_t)((mantissa - 1) * (float)parts);
}

/* The bucket that serves the pixel: of the group's buckets in rising order, the lowest
 * and the two above it share one; of three the middle one, of two that of more pixels. */
static int32_t serving_bucket(const reference *s, int32_t x, int32_t y)
{
    const int32_t own = bucket_at(s, x, y);
    const int32_t column = x + s->left, first = column / SPAN * SPAN + column % PHASES;
    int32_t buckets[LANES], low = -1;
    for (int32_t i = 0; i < LANES; i++)
        buckets[i] = bucket_at(s, first + i * PHASES - s->left, y);
    do {
        int32_t next = INT32_MAX, counts[3] = {0};
        for (int32_t i = 0; i < LANES; i++) {
            if (buckets[i] > low && buckets[i] < next)
                next = buckets[i];
        }
        for (int32_t i = 0; i < LANES; i++) {
            if (buckets[i] >= next && buckets[i] <= next + 2)
                counts[buckets[i] - next]++;
        }
        low = next + 2;
        if (own <= low)
            return counts[2] || counts[1] > counts[0] ? next + 1 : next;
    } while (1);
}

/* The radius of the middle depth of a bucket. */
static float radius_of(const reference *s, int32_t bucket)
{
    const int32_t parts = fineness(s->c);
    const float octave = exp2f((float)(bucket / parts - 1));
    const float low = octave * (1 + (float)(bucket % parts) / (float)parts),
                high = octave * (1 + (float)(bucket % parts + 1) / (float)parts);
    return 2 * low * high / (low + high);
}

/* methods/vo.c, with lines where another radius puts them. */
static float vo(const reference *s, int32_t x, int32_t y, float radius)
{
    const crv__params *p = &s->params;
    const crv__noise_texel *noise = crv__noise_at(&s->frame, x, y);
    const float d = *crv__plane_at(&s->frame.depth[0], x, y);
    const float unit = p->orthographic ? 1 : d;
    float open = 0, total = 0;
    for (int32_t i = 0; i < p->samples; i++) {
        const crv__vec2 disk =
            crv__turned(noise, s->frame.pattern[4 * i], s->frame.pattern[4 * i + 1]);
        const float du = rintf(disk.x * (radius * (p->fx * p->inv_fy))),
                    dv = rintf(-disk.y * radius);
        const float across = du * p->inv_fx * unit, up = dv * p->inv_fy * unit;
        const float rest = p->radius * p->radius - across * across - up * up;
        if (!(rest > 0))
            continue;
        const float half = sqrtf(rest);
        total += 2 * half;
        const float u = (float)x + du, v = (float)y + dv;
        float z = INFINITY;
        if (u >= 0 && v >= 0 && u < (float)p->width && v < (float)p->height)
            z = *crv__plane_at(&s->frame.depth[0], (int32_t)u, (int32_t)v);
        if (z < s->background)
            open +=
                fminf(fmaxf(p->orthographic ? z - d : d - d * d / z, -half), half) + half;
        else
            open += 2 * half;
    }
    return total > 0 ? fminf(1, 2 * open / total) : 1;
}

/* The surface at a step from (x, y) in a layer; INFINITY where there is none. */
static float depth_at(const reference *s, int32_t layer, int32_t x, int32_t y,
                      const float step[2])
{
    const float u = (float)x + step[0], v = (float)y + step[1];
    if (!(u >= 0 && v >= 0 && u < (float)s->params.width && v < (float)s->params.height))
        return INFINITY;
    const float z = *crv__plane_at(&s->frame.depth[layer], (int32_t)u, (int32_t)v);
    return z < s->background ? z : INFINITY;
}

/* A slice of hbao so far, as in methods/hbao.c. */
typedef struct slice {
    float horizon, occlusion, weight;
} slice;

/* The point v from P, at `offset` on the image plane, may raise a slice's horizon. */
static void raise_horizon(slice *sum, const crv__params *p, crv__vec3 ray, crv__vec3 n,
                          crv__vec3 offset, crv__vec3 v)
{
    const float r = sqrtf(crv__dot(v, v));
    const float along = crv__dot(n, offset), facing = -crv__dot(n, ray);
    const crv__vec3 T = {facing * offset.x + along * ray.x,
                         facing * offset.y + along * ray.y, along * ray.z};
    const float length = sqrtf(crv__dot(T, T));
    if (!(r < p->radius) || r == 0 || !(length > 0))
        return;
    /* The tangent's angle and the bias, by the sines and cosines of both. */
    const float sine = T.z / length, cosine = sqrtf(T.x * T.x + T.y * T.y) / length;
    if (cosine * p->cos_bias <= sine * p->sin_bias)
        return;
    const float h = v.z / r - (sine * p->cos_bias + cosine * p->sin_bias);
    if (h <= sum->horizon)
        return;
    sum->weight = crv__falloff(p, r * p->inv_radius);
    sum->occlusion += (h - sum->horizon) * sum->weight;
    sum->horizon = h;
}

/* methods/hbao.c with samples where another radius and the grid put them. */
static float hbao(const reference *s, int32_t x, int32_t y, float radius)
{
    const crv__params *p = &s->params;
    const crv__noise_texel *noise = crv__noise_at(&s->frame, x, y);
    const float d = *crv__plane_at(&s->frame.depth[0], x, y);
    const crv__vec3 P = crv__unproject(p, x, y, d), n = crv__normal_at(&s->frame, x, y);
    const crv__vec3 ray =
        p->orthographic ? (crv__vec3){0, 0, -1} : (crv__vec3){P.x / d, P.y / d, -1};
    float occlusion = 0;
    for (int32_t k = 0; k < p->directions; k++) {
        const crv__vec2 to = crv__direction(&s->frame, noise, k);
        slice sum = {0, 0, 0};
        for (int32_t i = 0; i < p->steps; i++) {
            float t = ((float)i + 0.5f + 0.5f * noise->beta) / (float)p->steps, step[2];
            t *= p->spacing == CRV_SPACING_QUADRATIC ? t : 1;
            reference_texel(t * (to.x * (radius * (p->fx * p->inv_fy))),
                            t * (-to.y * radius), step);
            const crv__vec3 offset = {step[0] * p->inv_fx, -step[1] * p->inv_fy, 0};
            for (int32_t layer = 0; layer < p->layers && !(step[0] == 0 && step[1] == 0);
                 layer++) {
                const float z = depth_at(s, layer, x, y, step);
                if (z < INFINITY)
                    raise_horizon(&sum, p, ray, n, offset,
                                  crv__sub(crv__unproject(p, x + (int32_t)step[0],
                                                          y + (int32_t)step[1], z),
                                           P));
            }
        }
        occlusion += p->attenuation == CRV_ATTENUATION_SLAB ? sum.occlusion
                                                            : sum.horizon * sum.weight;
    }
    return 1 - occlusion / (float)p->directions;
}

/* methods/alchemy.c likewise: its points stand for another radius' disk. */
static float alchemy(const reference *s, int32_t x, int32_t y, float radius)
{
    const crv__params *p = &s->params;
    const crv__noise_texel *noise = crv__noise_at(&s->frame, x, y);
    const float d = *crv__plane_at(&s->frame.depth[0], x, y);
    const crv__vec3 P = crv__unproject(p, x, y, d), n = crv__normal_at(&s->frame, x, y);
    const float own = radius_at(s, x, y), ratio = radius / own;
    const float band =
        ceilf((float)p->bands * own * fmaxf(1, p->fx * p->inv_fy) / p->band_px);
    const int32_t used = (int32_t)fmaxf(fminf(band, (float)p->bands), 1);
    const int32_t count = (p->samples * used + p->bands - 1) / p->bands;
    float sum = 0;
    for (int32_t i = 0; i < count; i++) {
        const crv__vec2 disk =
            crv__turned(noise, s->frame.pattern[4 * i], s->frame.pattern[4 * i + 1]);
        float step[2];
        reference_texel(disk.x * (radius * (p->fx * p->inv_fy)), -disk.y * radius, step);
        for (int32_t layer = 0; layer < p->layers && !(step[0] == 0 && step[1] == 0);
             layer++) {
            const float z = depth_at(s, layer, x, y, step);
            if (!(z < INFINITY))
                continue;
            const crv__vec3 v = crv__sub(
                crv__unproject(p, x + (int32_t)step[0], y + (int32_t)step[1], z), P);
            const float squared = crv__dot(v, v), radius2 = p->radius * p->radius;
            if (!(squared <= radius2))
                continue;
            sum += fmaxf(0, crv__dot(v, n) - d * p->alchemy_bias)
                   / (squared + p->alchemy_eps * radius2);
            break;
        }
    }
    return 1 - 2 * p->radius * sum / (float)count * ratio * ratio;
}

static bool knows_one_layer(const crv_method *method)
{
    return crv__method_of(method)->volumetric || strcmp(method->name, "bitmask") == 0;
}

/* Whether plans like this one have the deinterleaved structure: see
 * crv__deinterleaved_create(). */
static int has_structure(const simd_case *c)
{
    const crv_options *o = &c->options;
    const bool slices = in_slices(o);
    const int32_t samples = slices ? o->directions * o->steps : o->samples;
    const bool paired =
        (strcmp(o->method->name, "hbao") == 0 || strcmp(o->method->name, "vo") == 0)
        && (slices ? o->directions : o->samples) % 2 == 0;
    const double table = 48.0 * samples / (1 + paired) * 16 * OCTAVES * fineness(c);
    return (o->noise_size == 1 || o->noise_size == 2 || o->noise_size == 4)
           && c->desc.layers <= (knows_one_layer(o->method) ? 1 : 3)
           && table <= (2 << 20); /* more only where the picture is large */
}

/* With the specification's own samples. */
static float exact_at(const reference *s, int32_t x, int32_t y, crv__vec3 *bent)
{
    const crv__method *method = crv__method_of(s->c->options.method);
    return bent ? method->estimate(&s->frame, x, y, bent)
                : method->accessibility(&s->frame, x, y);
}

static float value_at(reference *s, int32_t x, int32_t y, int structure, int *has_bucket,
                      crv__vec3 *bent)
{
    const char *name = s->c->options.method->name;
    float a = 1;
    *has_bucket = 0;
    if (is_surface(s, x, y)) {
        *has_bucket = structure && bucket_at(s, x, y) >= 0;
        const float radius =
            *has_bucket ? radius_of(s, serving_bucket(s, x, y))
                              / scale_of(s, (x + s->left) % PHASES, (y + s->top) % PHASES)
                        : 0;
        if (!*has_bucket)
            a = exact_at(s, x, y, bent);
        else if (strcmp(name, "bitmask") == 0)
            a = reference_bitmask(&s->frame, x, y, radius, bent);
        else if (strcmp(name, "gtao") == 0)
            a = reference_gtao(&s->frame, x, y, radius, bent);
        else if (strcmp(name, "vo") == 0)
            a = vo(s, x, y, radius);
        else
            a = strcmp(name, "hbao") == 0 ? hbao(s, x, y, radius)
                                          : alchemy(s, x, y, radius);
    }
    const crv_options *o = &s->c->options;
    return powf(fminf(fmaxf(1 - o->intensity * (1 - a), 0), 1), o->contrast);
}

static crv_gbuffer *make_gbuffer(const simd_case *c, crv_context *context)
{
    crv_gbuffer *g = NULL;
    int bad = crv_gbuffer_create(context, &c->desc, &g)
              || crv_gbuffer_set_camera(g, &c->camera);
    for (int32_t i = 0; !bad && i < c->desc.layers; i++) {
        const crv_const_image depth =
            crv_const_image_packed(c->depth[i], c->desc.width, c->desc.height, 1);
        bad = crv_gbuffer_set_depth(g, i, &depth, NULL) != CRV_OK;
    }
    if (!bad && c->normals) {
        const crv_const_image normals =
            crv_const_image_packed(c->normals, c->desc.width, c->desc.height, 3);
        bad = crv_gbuffer_set_normals(g, &normals, CRV_NORMAL_VIEW) != CRV_OK;
    }
    if (!bad && crv__gbuffer_prepare(g) == CRV_OK)
        return g;
    crv_gbuffer_destroy(g);
    return NULL;
}

static void fill_map(reference *s, const crv__setup *setup, crv__plane *plane)
{
    const crv__map *map = crv__setup_map(setup);
    const int32_t width = s->params.width, height = s->params.height;
    if (!map || crv__plane_create(plane, &setup->context->allocator, 0, 0, width, height))
        return;
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++)
            *crv__plane_at(plane, x, y) = map->value(&s->frame, x, y);
    }
    s->frame.map = plane;
}

/* What is as far as the background is none. */
static void cut_depth(reference *s)
{
    for (int32_t y = 0; y < s->params.height; y++) {
        for (int32_t x = 0; x < s->params.width; x++) {
            float *d = crv__plane_at(&s->frame.depth[0], x, y);
            *d = *d < s->background ? *d : INFINITY;
        }
    }
}

static void fill_result(reference *s, float *out, float *bents, int32_t *structured)
{
    const bool with_bent = s->c->options.bent_normal;
    const crv_gbuffer_desc *d = &s->c->desc;
    const int structure = has_structure(s->c);
    const crv__params *p = &s->params;
    s->background = !structure        ? INFINITY
                    : p->orthographic ? 1e18f
                                      : 1024 * p->radius * p->fy;
    *structured = 0;
    if (strcmp(s->c->options.method->name, "bitmask") == 0)
        cut_depth(s);
    for (int32_t y = d->guard_top; y < d->height - d->guard_bottom; y++) {
        for (int32_t x = d->guard_left; x < d->width - d->guard_right; x++) {
            int has_bucket;
            crv__vec3 bent = {NAN, NAN, NAN};
            *out++ = value_at(s, x, y, structure, &has_bucket, with_bent ? &bent : NULL);
            *structured += has_bucket;
            if (with_bent)
                memcpy(bents, &bent, sizeof bent);
            bents += with_bent ? 3 : 0;
        }
    }
}

float *deinterleaved_reference(const simd_case *c, int32_t *structured)
{
    const crv_gbuffer_desc *d = &c->desc;
    reference s = {.c = c,
                   .left = wrapped(d->origin_x - d->guard_left, SPAN),
                   .top = wrapped(d->origin_y - d->guard_top, PHASES)};
    crv_context *context = NULL;
    const int32_t width = d->width - d->guard_left - d->guard_right,
                  height = d->height - d->guard_top - d->guard_bottom;
    const size_t count = (size_t)width * (size_t)height;
    float *out = malloc((c->options.bent_normal ? 4 : 1) * count * sizeof *out);
    crv_gbuffer *g =
        crv_context_create(NULL, &context) == CRV_OK ? make_gbuffer(c, context) : NULL;
    *structured = 0;
    crv__setup setup = {0};
    crv__plane map = {0};
    if (out && g) {
        setup = crv__setup_make(context, &c->options, d);
        crv__setup_params(&setup, &s.params);
        crv__gbuffer_params(g, &s.params);
        s.params.use_depth = 1;
    }
    if (out && g && crv__setup_patterns(&setup) == CRV_OK) {
        s.frame = (crv__frame){.params = &s.params,
                               .depth = g->depth,
                               .normal = g->normal,
                               .noise = setup.noise,
                               .directions = setup.directions,
                               .pattern = setup.pattern};
        fill_map(&s, &setup, &map);
        fill_result(&s, out, out + count, structured);
        crv__setup_release(&setup);
        crv__plane_destroy(&map, &context->allocator);
    }
    crv_gbuffer_destroy(g);
    crv_context_destroy(context);
    return out;
}
