/* SPDX-License-Identifier: MIT */
/* Depth encodings, converted once on the way in to planar depth with background INFINITY.
 */
#include "core/camera.h"
#include "core/gbuffer.h"

#include <math.h>
#include <string.h>

const char *crv_depth_encoding_name(crv_depth_encoding encoding)
{
    static const char *const NAMES[] = {
        [CRV_DEPTH_PLANAR] = "planar",
        [CRV_DEPTH_RADIAL] = "radial",
        [CRV_DEPTH_HARDWARE] = "hardware",
        [CRV_DEPTH_REVERSED] = "reversed",
        [CRV_DEPTH_DISPARITY] = "disparity",
        [CRV_DEPTH_NORMALISED] = "normalised",
        [CRV_DEPTH_NORMALISED_REVERSED] = "normalised-reversed",
        [CRV_DEPTH_GL] = "gl",
        [CRV_DEPTH_LOGARITHMIC] = "logarithmic",
    };
    return (unsigned)encoding < sizeof NAMES / sizeof NAMES[0] ? NAMES[encoding] : NULL;
}

bool crv_depth_encoding_find(const char *name, crv_depth_encoding *encoding)
{
    for (int i = 0; name && encoding && crv_depth_encoding_name((crv_depth_encoding)i);
         i++) {
        if (strcmp(crv_depth_encoding_name((crv_depth_encoding)i), name) == 0) {
            *encoding = (crv_depth_encoding)i;
            return true;
        }
    }
    return false;
}

crv_depth_format crv_depth_format_planar(void)
{
    return (crv_depth_format){CRV_DEPTH_PLANAR, 0, 0, INFINITY};
}

typedef struct depth_job {
    crv_gbuffer *gbuffer;
    const crv_texels *texels;
    int32_t layer;
    crv__depth_map map;
} depth_job;

static double planar_between_planes(const crv__depth_map *map, double v)
{
    if (v == (double)map->end || !(v >= (double)map->low && v <= 1))
        return INFINITY;
    const double affine = map->a + map->b * v;
    if (map->is_linear)
        return affine;
    return affine > 0 ? 1 / affine : INFINITY;
}

static double planar_depth(const crv__depth_map *map, int32_t x, int32_t y, double v)
{
    const crv_camera *c = map->camera;
    switch (map->format.encoding) {
    case CRV_DEPTH_PLANAR:
        return v < (double)map->format.background ? v : INFINITY;
    case CRV_DEPTH_RADIAL: {
        if (!(v < (double)map->format.background))
            return INFINITY;
        if (c->projection == CRV_ORTHOGRAPHIC)
            return v;
        const double u = (x + 0.5 - (double)c->cx_px) / (double)c->fx_px;
        const double w = (y + 0.5 - (double)c->cy_px) / (double)c->fy_px;
        return v / sqrt(1 + u * u + w * w);
    }
    case CRV_DEPTH_HARDWARE:
    case CRV_DEPTH_REVERSED:
    case CRV_DEPTH_NORMALISED:
    case CRV_DEPTH_NORMALISED_REVERSED:
    case CRV_DEPTH_GL:
        return planar_between_planes(map, v);
    case CRV_DEPTH_DISPARITY:
        return 1 / v;
    case CRV_DEPTH_LOGARITHMIC:
        return v < 1 ? exp2(map->b * v) - 1 : INFINITY;
    }
    return INFINITY;
}

float crv__depth_map_apply(const crv__depth_map *map, int32_t x, int32_t y, float v)
{
    const float d = (float)planar_depth(map, x, y, (double)v);
    return d > 0 && d < INFINITY ? d : INFINITY; /* NaN fails both */
}

void crv__depth_row(const crv__depth_map *map, const crv__texel_row *from, int32_t y,
                    int32_t count, float *out)
{
    for (int32_t x = 0; x < count; x++)
        out[x] = crv__depth_map_apply(map, x, y, crv__texel_at(from, x, 0));
}

static void convert_row(void *data, uint32_t row)
{
    const depth_job *job = data;
    const int32_t y = (int32_t)row;
    float *out = crv__plane_at(&job->gbuffer->depth[job->layer], 0, y);
    const crv__texel_row from = crv__texels_row(job->texels, y);
    job->gbuffer->context->conversions->depth_row(&job->map, &from, y,
                                                  job->gbuffer->desc.width, out);
}

static bool is_reversed(crv_depth_encoding encoding)
{
    return encoding == CRV_DEPTH_REVERSED || encoding == CRV_DEPTH_NORMALISED_REVERSED;
}

static bool is_normalised(crv_depth_encoding encoding)
{
    return encoding == CRV_DEPTH_NORMALISED || encoding == CRV_DEPTH_NORMALISED_REVERSED;
}

static bool is_between_planes(crv_depth_encoding encoding)
{
    return encoding == CRV_DEPTH_HARDWARE || encoding == CRV_DEPTH_REVERSED
           || encoding == CRV_DEPTH_GL || is_normalised(encoding);
}

/* The affine map of a depth between planes. Standard: v = 0 at near, 1 at far; reversed:
 * 1 - v; GL: 2 v - 1. */
static void set_coefficients(crv__depth_map *map)
{
    const crv_depth_encoding encoding = map->format.encoding;
    const double near_depth = (double)map->format.z_near,
                 far_depth = (double)map->format.z_far;
    map->is_linear =
        is_normalised(encoding) || map->camera->projection == CRV_ORTHOGRAPHIC;
    const double at_near = map->is_linear ? near_depth : 1 / near_depth;
    const double at_far =
        map->is_linear ? far_depth : 1 / far_depth; /* 0 if far is infinite */
    const bool reversed = is_reversed(encoding);
    map->a = reversed ? at_far : at_near;
    map->b = reversed ? at_near - at_far : at_far - at_near;
    map->end = reversed ? 0 : 1;
    if (encoding == CRV_DEPTH_GL) {
        map->low = -1;
        map->a += 0.5 * map->b;
        map->b *= 0.5;
    }
}

static crv_status check_format(const crv_logger *logger, const crv_camera *camera,
                               const crv_depth_format *format)
{
    const crv_depth_encoding encoding = format->encoding;
    if (encoding < CRV_DEPTH_PLANAR || encoding > CRV_DEPTH_LOGARITHMIC)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT, "depth: unknown encoding %d",
                         (int)encoding);
    if ((encoding == CRV_DEPTH_PLANAR || encoding == CRV_DEPTH_RADIAL)
        && !(format->background > 0))
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "depth: background %g is not positive; use INFINITY for none",
                         (double)format->background);
    if (encoding == CRV_DEPTH_LOGARITHMIC) {
        if (format->z_far > 0 && isfinite(format->z_far))
            return CRV_OK;
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "depth: far %g; logarithmic depth needs a positive, finite one",
                         (double)format->z_far);
    }
    if (!is_between_planes(encoding))
        return CRV_OK;
    const bool linear = is_normalised(encoding) || camera->projection == CRV_ORTHOGRAPHIC;
    const bool near_valid = isfinite(format->z_near) && (linear || format->z_near > 0);
    const bool far_valid =
        format->z_far > format->z_near && (isfinite(format->z_far) || !linear);
    if (near_valid && far_valid)
        return CRV_OK;
    return crv__fail(
        logger, CRV_ERROR_INVALID_ARGUMENT,
        "depth: near %g and far %g; hardware depth needs 0 < near < far, far finite "
        "for an orthographic camera and for normalised depth",
        (double)format->z_near, (double)format->z_far);
}

crv_status crv__depth_map_init(crv__depth_map *map, const crv_logger *logger,
                               const crv_camera *camera, const crv_depth_format *format)
{
    *map = (crv__depth_map){.camera = camera,
                            .format = format ? *format : crv_depth_format_planar()};
    const crv_status status = check_format(logger, camera, &map->format);
    if (status)
        return status;
    if (is_between_planes(map->format.encoding))
        set_coefficients(map);
    else if (map->format.encoding == CRV_DEPTH_LOGARITHMIC)
        map->b = log2(1 + (double)map->format.z_far);
    return CRV_OK;
}

/* ---- depth that cannot be right ---- */

enum { LOOKED_AT = 128 }; /* pixels of a row and of a column */

typedef struct depth_census {
    int32_t total, background, outside; /* outside: what the encoding cannot hold */
    int32_t at_ends, beyond_one;        /* exactly 0 or 1; finite and above 1 */
} depth_census;

static depth_census take_census(const crv__depth_map *map, const crv_texels *texels)
{
    const bool between = is_between_planes(map->format.encoding)
                         || map->format.encoding == CRV_DEPTH_LOGARITHMIC;
    const int32_t step_x = (texels->width + LOOKED_AT - 1) / LOOKED_AT;
    const int32_t step_y = (texels->height + LOOKED_AT - 1) / LOOKED_AT;
    depth_census c = {.total = 0};
    for (int32_t y = step_y / 2; y < texels->height; y += step_y) {
        const crv__texel_row row = crv__texels_row(texels, y);
        for (int32_t x = step_x / 2; x < texels->width; x += step_x) {
            const float v = crv__texel_at(&row, x, 0);
            c.total++;
            c.background += !(crv__depth_map_apply(map, x, y, v) < INFINITY);
            if (!isfinite(v))
                continue;
            c.outside += v < map->low || (between && v > 1);
            c.at_ends += v == 0 || v == 1;
            c.beyond_one += v > 1;
        }
    }
    return c;
}

static double percent(int32_t part, int32_t whole)
{
    return 100.0 * part / whole;
}

/* One warning for a G-buffer, since frames of a shot are alike. Some odd pixels are left
 * alone. */
static void doubt_depth(crv_gbuffer *g, const depth_job *job)
{
    if (g->depth_doubted || job->layer > 0)
        return;
    const depth_census c = take_census(&job->map, job->texels);
    const crv_logger *logger = &g->context->logger;
    const bool is_distance = job->map.format.encoding == CRV_DEPTH_PLANAR
                             || job->map.format.encoding == CRV_DEPTH_RADIAL;
    g->depth_doubted = true;
    if (c.outside > c.total / 100)
        crv__log(logger, CRV_LOG_WARNING,
                 "depth: %.1f %% of it is outside of what its encoding can hold; is the "
                 "encoding right?",
                 percent(c.outside, c.total));
    else if (c.background == c.total)
        crv__log(logger, CRV_LOG_WARNING,
                 "depth: 100 %% of it is background, so that all is white; are its "
                 "encoding, near and far right?");
    else if (is_distance && c.beyond_one == 0 && c.at_ends > c.total / 100)
        crv__log(logger, CRV_LOG_WARNING,
                 "depth: none of it is above 1 and %.1f %% is exactly 0 or 1, as in a "
                 "depth buffer; is it really a distance in scene units?",
                 percent(c.at_ends, c.total));
    else
        g->depth_doubted = false;
}

static crv_status check_layer(const crv_gbuffer *g, int32_t layer)
{
    const crv_status status = crv__gbuffer_need_camera(g, "depth");
    if (status)
        return status;
    if (layer < 0 || layer >= g->desc.layers)
        return crv__fail(&g->context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "depth: layer %d of %d", layer, g->desc.layers);
    return CRV_OK;
}

static crv_status take_depth(crv_gbuffer *g, int32_t layer, const crv_texels *texels,
                             const crv_depth_format *format)
{
    depth_job job = {.gbuffer = g, .texels = texels, .layer = layer};
    const crv_status status =
        crv__depth_map_init(&job.map, &g->context->logger, &g->camera, format);
    if (status)
        return status;
    doubt_depth(g, &job);
    crv__run_rows(g->context, g->desc.height, convert_row, &job);
    g->has_depth |= 1u << layer;
    if (layer == 0)
        g->normals_ready = 0; /* those made from the depth before are out of date */
    return CRV_OK;
}

crv_status crv_gbuffer_set_depth(crv_gbuffer *g, int32_t layer,
                                 const crv_const_image *image,
                                 const crv_depth_format *format)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_status status = check_layer(g, layer);
    if (status == CRV_OK)
        status = crv__input_check(&g->context->logger, "depth", image, g->desc.width,
                                  g->desc.height, 1);
    if (status)
        return status;
    const crv_texels texels = crv__texels_of(image);
    return take_depth(g, layer, &texels, format);
}

crv_status crv_gbuffer_set_depth_texels(crv_gbuffer *g, int32_t layer,
                                        const crv_texels *texels,
                                        const crv_depth_format *format)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_status status = check_layer(g, layer);
    if (status == CRV_OK)
        status = crv__texels_check(&g->context->logger, "depth", texels, g->desc.width,
                                   g->desc.height, 1);
    return status ? status : take_depth(g, layer, texels, format);
}

typedef struct convert_job {
    const crv_const_image *from;
    const crv_image *to;
    crv__depth_map map;
} convert_job;

static void convert_image_row(void *data, uint32_t row)
{
    const convert_job *job = data;
    const int32_t y = (int32_t)row;
    for (int32_t x = 0; x < job->to->width; x++)
        *crv_image_at(job->to, x, y, 0) = crv__depth_map_apply(
            &job->map, x, y, *crv_const_image_at(job->from, x, y, 0));
}

crv_status crv_depth_convert(const crv_const_image *depth, const crv_depth_format *format,
                             const crv_camera *camera, const crv_image *planar,
                             const crv_logger *logger)
{
    const int32_t width = depth ? depth->width : 1, height = depth ? depth->height : 1;
    if (width < 1 || height < 1 || width > CRV_MAX_SIZE || height > CRV_MAX_SIZE)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "depth: %d x %d; width and height are from 1 to %d", width,
                         height, CRV_MAX_SIZE);
    convert_job job = {.from = depth, .to = planar};
    crv_status status = crv__camera_check(logger, camera);
    if (status == CRV_OK)
        status = crv__input_check(logger, "depth", depth, width, height, 1);
    if (status == CRV_OK)
        status = crv__output_check(logger, "planar depth", planar, width, height, 1);
    if (status == CRV_OK)
        status = crv__depth_map_init(&job.map, logger, camera, format);
    if (status)
        return status;
    crv__parallel_for(&(crv_parallel){.run = NULL}, 0, NULL, (uint32_t)height,
                      convert_image_row, &job);
    return CRV_OK;
}
