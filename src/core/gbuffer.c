/* SPDX-License-Identifier: MIT */
/* The G-buffer's life: sizes, memory, state, and what goes in and out as it is. */
#include "core/gbuffer.h"

#include "base/structs.h"
#include "core/camera.h"

#include <math.h>
#include <string.h>

static const crv__struct DESC = {.name = "gbuffer desc",
                                 .init = "crv_gbuffer_desc_init()",
                                 .first = CRV__SIZE_TO(crv_gbuffer_desc, layer_kind),
                                 .size = sizeof(crv_gbuffer_desc)};

crv_status crv_gbuffer_desc_init(crv_gbuffer_desc *desc, size_t struct_size,
                                 int32_t width, int32_t height)
{
    const crv_gbuffer_desc defaults = {.width = width, .height = height, .layers = 1};
    return crv__struct_init(&DESC, desc, struct_size, &defaults);
}

bool crv_gbuffer_desc_equal(const crv_gbuffer_desc *first, const crv_gbuffer_desc *second)
{
    crv_gbuffer_desc a = {.layers = 1}, b = {.layers = 1};
    if (crv__struct_take(&DESC, NULL, first, &a)
        || crv__struct_take(&DESC, NULL, second, &b))
        return false;
    return a.width == b.width && a.height == b.height && a.layers == b.layers
           && a.layer_kind == b.layer_kind && a.guard_left == b.guard_left
           && a.guard_top == b.guard_top && a.guard_right == b.guard_right
           && a.guard_bottom == b.guard_bottom && a.origin_x == b.origin_x
           && a.origin_y == b.origin_y;
}

crv_status crv__gbuffer_desc_take(const crv_logger *logger, const crv_gbuffer_desc *from,
                                  crv_gbuffer_desc *desc)
{
    *desc = (crv_gbuffer_desc){.layers = 1};
    const crv_status status = crv__struct_take(&DESC, logger, from, desc);
    if (status)
        return status;
    if (desc->width < 1 || desc->height < 1 || desc->width > CRV_MAX_SIZE
        || desc->height > CRV_MAX_SIZE)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "gbuffer: %d x %d; width and height are from 1 to %d",
                         desc->width, desc->height, CRV_MAX_SIZE);
    if (desc->layers < 1 || desc->layers > CRV_MAX_LAYERS)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "gbuffer: %d layers; 1 to %d", desc->layers, CRV_MAX_LAYERS);
    if (desc->layer_kind != CRV_LAYERS_SURFACES && desc->layer_kind != CRV_LAYERS_SOLID)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "gbuffer: layer kind %d is neither surfaces nor solid",
                         (int)desc->layer_kind);
    const int32_t guards[4] = {desc->guard_left, desc->guard_right, desc->guard_top,
                               desc->guard_bottom};
    for (int i = 0; i < 4; i++) {
        if (guards[i] < 0 || guards[i] >= CRV_MAX_SIZE)
            return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                             "gbuffer: a guard band of %d px; 0 or more", guards[i]);
    }
    if (guards[0] + guards[1] >= desc->width || guards[2] + guards[3] >= desc->height)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "gbuffer: the guard band leaves nothing of %d x %d", desc->width,
                         desc->height);
    return CRV_OK;
}

static int create_planes(crv_gbuffer *g)
{
    const crv_allocator *allocator = &g->context->allocator;
    for (int i = 0; i < g->desc.layers; i++) {
        if (crv__plane_create(&g->depth[i], allocator, 0, 0, g->desc.width,
                              g->desc.height))
            return -1;
    }
    for (int i = 0; i < 3; i++) {
        if (crv__plane_create(&g->normal[i], allocator, 0, 0, g->desc.width,
                              g->desc.height))
            return -1;
    }
    return 0;
}

crv_status crv_gbuffer_create(crv_context *context, const crv_gbuffer_desc *desc,
                              crv_gbuffer **out)
{
    if (!context)
        return CRV_ERROR_INVALID_ARGUMENT;
    if (!out)
        return crv__fail(&context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "gbuffer: out is NULL");
    crv_gbuffer_desc full;
    const crv_status status = crv__gbuffer_desc_take(&context->logger, desc, &full);
    if (status)
        return status;
    crv_gbuffer *g = crv__allocate(&context->allocator, 1, sizeof *g);
    if (g) {
        g->context = context;
        context->children++;
        g->desc = full;
        if (create_planes(g) == 0) {
            *out = g;
            return CRV_OK;
        }
        crv_gbuffer_destroy(g);
    }
    return crv__fail(&context->logger, CRV_ERROR_OUT_OF_MEMORY,
                     "gbuffer: no memory for %d x %d with %d layers", full.width,
                     full.height, full.layers);
}

void crv_gbuffer_destroy(crv_gbuffer *g)
{
    if (!g)
        return;
    const crv_allocator *allocator = &g->context->allocator;
    for (int i = 0; i < CRV_MAX_LAYERS; i++)
        crv__plane_destroy(&g->depth[i], allocator);
    for (int i = 0; i < 3; i++)
        crv__plane_destroy(&g->normal[i], allocator);
    crv__height_field_release(g);
    g->context->children--;
    crv__release(allocator, g, 1, sizeof *g);
}

crv_status crv_gbuffer_set_camera(crv_gbuffer *g, const crv_camera *camera)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_status status = crv__camera_check(&g->context->logger, camera);
    if (status)
        return status;
    g->camera = *camera;
    g->has_camera = 1;
    g->has_depth = 0;
    g->has_normals = g->normals_ready = g->has_field = 0;
    return CRV_OK;
}

typedef struct normals_job {
    crv_gbuffer *gbuffer;
    const crv_texels *texels;
    float rotation[9];
} normals_job;

static void take_normals_row(void *data, uint32_t row)
{
    const normals_job *job = data;
    const int32_t y = (int32_t)row;
    const crv__texel_row from = crv__texels_row(job->texels, y);
    float *out[3];
    for (int i = 0; i < 3; i++)
        out[i] = crv__plane_at(&job->gbuffer->normal[i], 0, y);
    job->gbuffer->context->conversions->rotated_row(job->rotation, &from,
                                                    job->gbuffer->desc.width, out);
}

crv_status crv__gbuffer_need_camera(const crv_gbuffer *g, const char *what)
{
    if (g->has_camera)
        return CRV_OK;
    return crv__fail(&g->context->logger, CRV_ERROR_NOT_READY,
                     "%s: no camera yet; call crv_gbuffer_set_camera() first", what);
}

/* texels NULL: none. */
static crv_status take_normals(crv_gbuffer *g, const crv_texels *texels,
                               crv_normal_space space)
{
    static const float IDENTITY[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (texels && space != CRV_NORMAL_VIEW && space != CRV_NORMAL_WORLD)
        return crv__fail(&g->context->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "normals: space %d is neither view nor world", (int)space);
    if (texels) {
        normals_job job = {.gbuffer = g, .texels = texels};
        memcpy(job.rotation,
               space == CRV_NORMAL_WORLD ? g->camera.world_to_view : IDENTITY,
               sizeof job.rotation);
        crv__run_rows(g->context, g->desc.height, take_normals_row, &job);
    }
    g->has_normals = texels ? 1 : 0;
    g->normals_ready = 0;
    return CRV_OK;
}

crv_status crv_gbuffer_set_normals(crv_gbuffer *g, const crv_const_image *image,
                                   crv_normal_space space)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_status status = crv__gbuffer_need_camera(g, "gbuffer");
    if (status == CRV_OK && image)
        status = crv__input_check(&g->context->logger, "normals", image, g->desc.width,
                                  g->desc.height, 3);
    if (status)
        return status;
    const crv_texels texels = image ? crv__texels_of(image) : (crv_texels){.data = NULL};
    return take_normals(g, image ? &texels : NULL, space);
}

crv_status crv_gbuffer_set_normals_texels(crv_gbuffer *g, const crv_texels *texels,
                                          crv_normal_space space)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_status status = crv__gbuffer_need_camera(g, "gbuffer");
    if (status == CRV_OK && texels)
        status = crv__texels_check(&g->context->logger, "normals", texels, g->desc.width,
                                   g->desc.height, 3);
    return status ? status : take_normals(g, texels, space);
}

void crv__camera_params(const crv_gbuffer_desc *desc, const crv_camera *camera,
                        crv__params *p)
{
    p->width = desc->width;
    p->height = desc->height;
    p->layers = desc->layers;
    p->orthographic = camera->projection == CRV_ORTHOGRAPHIC;
    p->fx = camera->fx_px;
    p->fy = camera->fy_px;
    p->cx = camera->cx_px;
    p->cy = camera->cy_px;
    p->inv_fx = 1 / p->fx;
    p->inv_fy = 1 / p->fy;
}

void crv__gbuffer_params(const crv_gbuffer *g, crv__params *p)
{
    crv__camera_params(&g->desc, &g->camera, p);
}

static void finish_row(void *data, uint32_t row)
{
    crv_gbuffer *g = data;
    crv__params params = {0};
    crv__gbuffer_params(g, &params);
    g->context->conversions->normals_row(&params, &g->depth[0], g->normal, g->has_normals,
                                         (int32_t)row);
}

crv_status crv__gbuffer_prepare(crv_gbuffer *g)
{
    crv_status status = crv__gbuffer_need_camera(g, "gbuffer");
    if (status)
        return status;
    const uint32_t missing = ((1u << g->desc.layers) - 1) & ~g->has_depth;
    if (missing)
        return crv__fail(
            &g->context->logger, CRV_ERROR_NOT_READY,
            "gbuffer: depth of a layer is missing (layers to set, as bits: 0x%x); "
            "call crv_gbuffer_set_depth() after the camera",
            missing);
    if (!g->normals_ready) {
        crv__run_rows(g->context, g->desc.height, finish_row, g);
        g->normals_ready = 1;
        g->relief_ready = 0;
    }
    if (!g->relief_ready) {
        crv__height_field_finish(g);
        g->relief_ready = 1;
    }
    return CRV_OK;
}

crv_status crv_gbuffer_get_depth(crv_gbuffer *g, int32_t layer, const crv_image *image)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_logger *logger = &g->context->logger;
    if (layer < 0 || layer >= g->desc.layers)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT, "depth: layer %d of %d",
                         layer, g->desc.layers);
    crv_status status =
        crv__output_check(logger, "depth", image, g->desc.width, g->desc.height, 1);
    if (status == CRV_OK && !(g->has_depth >> layer & 1))
        status = crv__fail(logger, CRV_ERROR_NOT_READY,
                           "depth: layer %d has not been set", layer);
    if (status)
        return status;
    for (int32_t y = 0; y < g->desc.height; y++) {
        for (int32_t x = 0; x < g->desc.width; x++)
            *crv_image_at(image, x, y, 0) = *crv__plane_at(&g->depth[layer], x, y);
    }
    return CRV_OK;
}

crv_status crv_gbuffer_get_normals(crv_gbuffer *g, const crv_image *image)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_status status = crv__output_check(&g->context->logger, "normals", image,
                                          g->desc.width, g->desc.height, 3);
    if (status == CRV_OK)
        status = crv__gbuffer_prepare(g);
    if (status)
        return status;
    for (int32_t y = 0; y < g->desc.height; y++) {
        for (int32_t x = 0; x < g->desc.width; x++) {
            for (int i = 0; i < 3; i++)
                *crv_image_at(image, x, y, i) = *crv__plane_at(&g->normal[i], x, y);
        }
    }
    return CRV_OK;
}
