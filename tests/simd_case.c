/* SPDX-License-Identifier: MIT */
/* Random frames and options for the test of the kernels. */
#include "simd.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

simd_random simd_random_make(uint64_t seed, uint64_t stream, uint64_t index)
{
    /* Hashed one after the other, or neighbouring seeds would share their numbers. */
    const uint64_t parts[3] = {seed, stream, index};
    simd_random r = {0};
    for (int i = 0; i < 3; i++) {
        r.state ^= parts[i];
        const uint64_t high = simd_bits(&r);
        r.state = high << 32 | simd_bits(&r);
    }
    return r;
}

/* splitmix64 (Steele, Lea, Flood 2014) */
uint32_t simd_bits(simd_random *r)
{
    uint64_t z = r->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (uint32_t)(z >> 32);
}

double simd_unit(simd_random *r)
{
    return simd_bits(r) / 4294967296.0;
}

int32_t simd_int(simd_random *r, int32_t low, int32_t high)
{
    return low + (int32_t)(simd_unit(r) * ((double)high - low + 1));
}

double simd_float(simd_random *r, double low, double high)
{
    return low + (high - low) * simd_unit(r);
}

double simd_log(simd_random *r, double low, double high)
{
    return exp(simd_float(r, log(low), log(high)));
}

int simd_chance(simd_random *r, int32_t n)
{
    return simd_int(r, 1, n) == 1;
}

/* ---- options ---- */

/* Ranges that matter where the table's are too wide: a case has few pixels, and its
 * samples are paid for one by one. Powers of small numbers would make a rounding error
 * visible, which is not the kernels' affair. */
static const struct {
    const char *key;
    double low, high;
    int logarithmic;
} RANGES[] = {{"tau", 0, 10, 0},           {"u", 1e-3, 1, 1},
              {"directions", 1, 9, 0},     {"steps", 1, 9, 0},
              {"normal_rays", 0, 3, 0},    {"samples", 1, 40, 0},
              {"thickness", 0.02, 5, 1},   {"max_radius_px", 0.5, 60, 1},
              {"band_px", 1, 200, 1},      {"alchemy_bias", 1e-5, 0.1, 1},
              {"alchemy_eps", 1e-6, 1, 1}, {"intensity", 0, 3, 0},
              {"contrast", 1, 4, 0},       {"filter_depth", 1e-3, 10, 1},
              {"seed", 0, 1e6, 0}};

static double random_value(simd_random *r, const crv_option *option)
{
    double low = option->min, high = option->max;
    int logarithmic = 0;
    for (size_t i = 0; i < sizeof RANGES / sizeof RANGES[0]; i++) {
        if (strcmp(option->key, RANGES[i].key) == 0) {
            low = RANGES[i].low;
            high = RANGES[i].high;
            logarithmic = RANGES[i].logarithmic;
        }
    }
    if (strcmp(option->key, "noise_size") == 0) {
        static const int32_t SIZES[] = {1, 2, 3, 4, 5, 8, 16, 64};
        return simd_chance(r, 2) ? 4 : SIZES[simd_int(r, 0, 7)];
    }
    if (option->type != CRV_OPTION_FLOAT)
        return simd_int(r, (int32_t)low, (int32_t)high);
    /* Where 0 means "none", it is tried as well. */
    if (option->min <= 0 && simd_chance(r, 3))
        return 0;
    return logarithmic ? simd_log(r, low, high) : simd_float(r, low, high);
}

/* Every option that is read gets a value of its own, but for the radius. */
static void random_options(simd_random *r, crv_options *options)
{
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        char text[64];
        /* noise_index, bent_normal: below, so that cases are those from before them. */
        if (strcmp(option->key, "radius") == 0 || strcmp(option->key, "noise_index") == 0
            || strcmp(option->key, "bent_normal") == 0
            || !crv_option_applies(option, options->method, options->filter))
            continue;
        const double value = random_value(r, option);
        if (option->type == CRV_OPTION_CHOICE)
            snprintf(text, sizeof text, "%s", option->choices[(int)value]);
        else
            snprintf(text, sizeof text, "%.9g", value);
        crv_options_set(options, option->key, text, NULL);
    }
    simd_random aside = *r;
    options->noise_index = simd_int(&aside, 0, 1 << 20);
    options->bent_normal = options->method->bent_normal && simd_chance(&aside, 2);
    /* Without limits the shared code would hide the kernels' values. */
    if (simd_chance(r, 2))
        options->intensity = options->contrast = 1;
}

/* ---- frames ---- */

static crv_camera random_camera(simd_random *r, const crv_gbuffer_desc *desc)
{
    crv_camera camera =
        crv_camera_perspective(desc->width, desc->height, (float)simd_log(r, 0.2, 2.5));
    if (simd_chance(r, 4))
        camera = crv_camera_orthographic(desc->width, desc->height,
                                         (float)simd_log(r, 1e-2, 1e2));
    if (simd_chance(r, 2)) { /* pixels that are not square */
        camera.fx_px *= (float)simd_log(r, 0.4, 2.5);
    }
    if (simd_chance(r, 2)) { /* off the axis, even off the image */
        camera.cx_px += (float)(simd_float(r, -1, 1) * desc->width);
        camera.cy_px += (float)(simd_float(r, -1, 1) * desc->height);
    }
    return camera;
}

/*
 * Squares of lengths below 1e-19 are denormal, and estimates of their roots know no such
 * numbers: no scene is that small. Of vao's spheres the eye must not be a part of the
 * surface, or rounding decides whether they are in front of it; nor of slices through the
 * eye, or rounding decides on which side of P it is.
 */
static float nonsense(simd_random *r, const simd_case *c, float d)
{
    const float values[] = {NAN,    INFINITY, -INFINITY, 0,     -0.0f, -1,
                            1e-15f, 1e-10f,   1e-3f * d, 1e20f, 1e30f, 3e38f};
    if (!simd_chance(r, 3))
        return d;
    const float value = values[simd_int(r, 0, 11)];
    const int at_eye = value > 0 && value < 1e-3f * d;
    const char *name = c->options.method->name;
    const bool is_excluded = strcmp(name, "vao") == 0 || strcmp(name, "gtao") == 0
                             || strcmp(name, "bitmask") == 0;
    return at_eye && is_excluded ? d : value;
}

static void fill_layer(simd_random *r, const simd_case *c, float *out, simd_scene scene,
                       double near_depth, double radius)
{
    const int32_t width = c->desc.width, height = c->desc.height;
    const double slope_x = simd_float(r, -0.02, 0.02),
                 slope_y = simd_float(r, -0.02, 0.02);
    const double wave = simd_float(r, 0, 0.5) * radius;
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            double d = near_depth;
            if (scene == SIMD_SMOOTH || scene == SIMD_BOXES || scene == SIMD_NONSENSE)
                d += near_depth * (slope_x * x + slope_y * y)
                     + wave * (sin(0.31 * x) + cos(0.23 * y + 0.1 * x));
            if (scene == SIMD_NOISE)
                d += simd_float(r, 0, 4) * radius;
            const float depth = (float)d;
            out[y * width + x] = scene == SIMD_NONSENSE ? nonsense(r, c, depth) : depth;
        }
    }
    for (int32_t i = 0; scene == SIMD_BOXES && i < 12; i++) {
        const int32_t x0 = simd_int(r, 0, width - 1), x1 = simd_int(r, x0, width);
        const int32_t y0 = simd_int(r, 0, height - 1), y1 = simd_int(r, y0, height);
        const float d = simd_chance(r, 4)
                            ? INFINITY
                            : (float)(near_depth + simd_float(r, -2, 2) * radius);
        for (int32_t y = y0; y < y1; y++) {
            for (int32_t x = x0; x < x1; x++)
                out[y * width + x] = d;
        }
    }
}

/* Layers behind the first, of any thickness; here and there without order, or missing. */
static void fill_further(simd_random *r, const simd_case *c, const float *before,
                         float *out, double radius)
{
    const int32_t count = c->desc.width * c->desc.height;
    const double gap = simd_float(r, 0, 2) * radius;
    for (int32_t i = 0; i < count; i++) {
        out[i] = before[i] + (float)(gap * simd_unit(r));
        if (simd_chance(r, 10))
            out[i] = simd_chance(r, 2) ? INFINITY : before[i] - (float)(0.5 * gap);
    }
}

static void fill_normals(simd_random *r, simd_case *c)
{
    const int32_t count = c->desc.width * c->desc.height;
    const double tilt = simd_float(r, 0, 1.5);
    for (int32_t i = 0; i < count; i++) {
        float *n = c->normals + 3 * i;
        n[0] = (float)(tilt * simd_float(r, -1, 1));
        n[1] = (float)(tilt * simd_float(r, -1, 1));
        n[2] = 1;
        if (simd_chance(r, 50)) /* reconstructed */
            n[simd_int(r, 0, 2)] = NAN;
    }
}

static void random_guard(simd_random *r, crv_gbuffer_desc *desc)
{
    if (simd_chance(r, 2))
        return;
    desc->guard_left = simd_int(r, 0, (desc->width - 1) / 3);
    desc->guard_right = simd_int(r, 0, (desc->width - 1) / 3);
    desc->guard_top = simd_int(r, 0, (desc->height - 1) / 3);
    desc->guard_bottom = simd_int(r, 0, (desc->height - 1) / 3);
    desc->origin_x = simd_int(r, -100, 100);
    desc->origin_y = simd_int(r, -100, 100);
}

/* The radius that spans `radius_px` at this depth. */
static float radius_of(const simd_case *c, double radius_px, double depth)
{
    const double unit = c->camera.projection == CRV_ORTHOGRAPHIC ? 1 : depth;
    return (float)fmin(fmax(radius_px * unit / (double)c->camera.fx_px, 1e-9), 1e9);
}

static void random_input(simd_random *r, simd_case *c)
{
    const int32_t count = c->desc.width * c->desc.height;
    for (int32_t i = 0; i < count; i++)
        c->input[i] = simd_chance(r, 20) ? NAN : (float)simd_unit(r);
}

simd_case *simd_case_make(simd_random *r, const crv_method *method,
                          const crv_filter *filter, int filter_only, int32_t size,
                          simd_scene scene)
{
    simd_case *c = calloc(1, sizeof *c);
    if (!c || crv_options_init(&c->options, sizeof c->options, method->name))
        return NULL;
    c->options.filter = filter;
    c->exact = 1;
    c->layout = simd_bits(r);
    random_options(r, &c->options);
    crv_gbuffer_desc_init(&c->desc, sizeof c->desc, simd_int(r, 1, size),
                          simd_int(r, 1, size));
    random_guard(r, &c->desc);
    if (simd_chance(r, 2))
        c->desc.layers = simd_int(r, 1, CRV_MAX_LAYERS);
    c->desc.layer_kind = simd_chance(r, 2) ? CRV_LAYERS_SOLID : CRV_LAYERS_SURFACES;
    c->camera = random_camera(r, &c->desc);
    /* From close-ups to far away, where a radius is a few roundings of depth. */
    const double depth = simd_log(r, 1e-2, 1e3);
    c->options.radius = radius_of(c, simd_log(r, 0.3, 1.5 * size), depth);
    const size_t count = (size_t)c->desc.width * (size_t)c->desc.height;
    for (int32_t i = 0; i < c->desc.layers; i++) {
        if (!(c->depth[i] = malloc(count * sizeof(float))))
            return NULL;
        if (i == 0)
            fill_layer(r, c, c->depth[0], scene, depth, (double)c->options.radius);
        else
            fill_further(r, c, c->depth[i - 1], c->depth[i], (double)c->options.radius);
    }
    if (!simd_chance(r, 3)) {
        if (!(c->normals = malloc(3 * count * sizeof(float))))
            return NULL;
        fill_normals(r, c);
    }
    /* Where depths are equal, samples of a slice are equally high but for rounding, and
     * it is chance which of them weighs the slice. */
    if (scene == SIMD_FLAT || scene == SIMD_BOXES)
        c->options.attenuation = CRV_ATTENUATION_SLAB;
    if (filter_only) {
        if (!(c->input = malloc(count * sizeof(float))))
            return NULL;
        random_input(r, c);
    }
    return c;
}

void simd_case_free(simd_case *c)
{
    if (!c)
        return;
    for (int32_t i = 0; i < CRV_MAX_LAYERS; i++)
        free(c->depth[i]);
    free(c->normals);
    free(c->input);
    free(c);
}

void simd_case_print(const simd_case *c)
{
    const crv_options *o = &c->options;
    const crv_gbuffer_desc *d = &c->desc;
    printf(
        "  %d x %d, guard %d %d %d %d, %d layers %s, %s, f %g %g, c %g %g, %s\n  %s",
        d->width, d->height, d->guard_left, d->guard_top, d->guard_right, d->guard_bottom,
        d->layers, d->layer_kind == CRV_LAYERS_SOLID ? "in pairs" : "of surfaces",
        c->camera.projection == CRV_ORTHOGRAPHIC ? "orthographic" : "perspective",
        (double)c->camera.fx_px, (double)c->camera.fy_px, (double)c->camera.cx_px,
        (double)c->camera.cy_px, c->normals ? "normals" : "no normals", o->method->name);
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        if (crv_option_applies(option, o->method, o->filter))
            printf(" %s=%.9g", option->key, crv_options_get(o, option));
    }
    printf(" filter=%s\n", o->filter ? o->filter->name : "none");
}
