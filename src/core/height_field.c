/* SPDX-License-Identifier: MIT */
/* Fields of a G-buffer: what the host gives, and the relief's normals. */
#include "core/gbuffer.h"

#include <math.h>

/* The planes of the G-buffer's size: uv, tangent, bitangent, relief normal. */
enum { FRAME_PLANES = 11 };

static crv__plane *frame_plane(crv__field *field, int i)
{
    if (i < 2)
        return &field->uv[i];
    if (i < 5)
        return &field->tangent[i - 2];
    if (i < 8)
        return &field->bitangent[i - 5];
    return &field->relief_normal[i - 8];
}

void crv__height_field_release(crv_gbuffer *g)
{
    const crv_allocator *allocator = &g->context->allocator;
    for (int i = 0; i < FRAME_PLANES; i++)
        crv__plane_destroy(frame_plane(&g->field, i), allocator);
    crv__plane_destroy(&g->field.height, allocator);
}

crv_status crv_gbuffer_set_implicit(crv_gbuffer *g, crv_implicit_fn function, void *user)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_status status = crv__gbuffer_need_camera(g, "implicit surface");
    if (status)
        return status;
    g->field.implicit = function;
    g->field.user = user;
    g->has_field = function != NULL;
    return CRV_OK;
}

static crv_status check_field(const crv_gbuffer *g, const crv_height_field *field)
{
    const crv_logger *logger = &g->context->logger;
    const int32_t width = g->desc.width, height = g->desc.height;
    const crv_const_image *map = &field->height;
    if (!isfinite(field->scale)
        || (field->wrap != CRV_WRAP_REPEAT && field->wrap != CRV_WRAP_CLAMP))
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "height field: scale %g is not finite, or wrap %d unknown",
                         (double)field->scale, (int)field->wrap);
    if (map->width < 1 || map->height < 1 || map->width > CRV_MAX_SIZE
        || map->height > CRV_MAX_SIZE)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "height map: %d x %d; 1 to %d", map->width, map->height,
                         CRV_MAX_SIZE);
    crv_status status =
        crv__input_check(logger, "height map", map, map->width, map->height, 1);
    if (status == CRV_OK)
        status =
            crv__input_check(logger, "height field uv", &field->uv, width, height, 2);
    if (status == CRV_OK)
        status = crv__input_check(logger, "tangents", &field->tangent, width, height, 3);
    if (status == CRV_OK)
        status =
            crv__input_check(logger, "bitangents", &field->bitangent, width, height, 3);
    return status;
}

static int create_planes(crv_gbuffer *g, const crv_const_image *map)
{
    const crv_allocator *allocator = &g->context->allocator;
    for (int i = 0; i < FRAME_PLANES; i++) {
        crv__plane *plane = frame_plane(&g->field, i);
        if (!plane->data
            && crv__plane_create(plane, allocator, 0, 0, g->desc.width, g->desc.height))
            return -1;
    }
    crv__plane *height = &g->field.height;
    if (height->data && height->width == map->width && height->height == map->height)
        return 0;
    crv__plane_destroy(height, allocator);
    return crv__plane_create(height, allocator, 0, 0, map->width, map->height);
}

static void copy_channel(const crv_const_image *image, int32_t channel,
                         const crv__plane *out)
{
    for (int32_t y = 0; y < image->height; y++) {
        for (int32_t x = 0; x < image->width; x++)
            *crv__plane_at(out, x, y) = *crv_const_image_at(image, x, y, channel);
    }
}

/* A hole in the map is flat. */
static void fill_holes(const crv__plane *map)
{
    for (int32_t y = 0; y < map->height; y++) {
        for (int32_t x = 0; x < map->width; x++) {
            float *height = crv__plane_at(map, x, y);
            *height = isfinite(*height) ? *height : 0;
        }
    }
}

crv_status crv_gbuffer_set_height_field(crv_gbuffer *g, const crv_height_field *field)
{
    if (!g)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv_status status = crv__gbuffer_need_camera(g, "height field");
    if (status)
        return status;
    if (!field) {
        g->has_field = 0;
        return CRV_OK;
    }
    status = check_field(g, field);
    if (status)
        return status;
    g->has_field = 0;
    if (create_planes(g, &field->height))
        return crv__fail(&g->context->logger, CRV_ERROR_OUT_OF_MEMORY,
                         "height field: no memory for %d x %d", g->desc.width,
                         g->desc.height);
    for (int i = 0; i < 2; i++)
        copy_channel(&field->uv, i, &g->field.uv[i]);
    for (int i = 0; i < 3; i++) {
        copy_channel(&field->tangent, i, &g->field.tangent[i]);
        copy_channel(&field->bitangent, i, &g->field.bitangent[i]);
    }
    copy_channel(&field->height, 0, &g->field.height);
    fill_holes(&g->field.height);
    g->field.implicit = NULL;
    g->field.scale = field->scale;
    g->field.wrap = field->wrap;
    g->has_field = 1;
    g->relief_ready = 0;
    return CRV_OK;
}

/* The relief's normal is the gradient of p_z - h(p_x, p_y). */
static void finish_row(void *data, uint32_t row)
{
    crv_gbuffer *g = data;
    const int32_t y = (int32_t)row;
    for (int32_t x = 0; x < g->desc.width; x++) {
        crv__vec3 n = {*crv__plane_at(&g->normal[0], x, y),
                       *crv__plane_at(&g->normal[1], x, y),
                       *crv__plane_at(&g->normal[2], x, y)};
        const crv__local_frame local = crv__local_frame_at(&g->field, n, x, y);
        if (local.valid) {
            const crv__vec3 P = {0, 0, 0};
            crv__vec3 gradient;
            crv__field_value(&g->field, &local, P, P, &gradient);
            const float scale = 1 / sqrtf(crv__dot(gradient, gradient));
            n = (crv__vec3){gradient.x * scale, gradient.y * scale, gradient.z * scale};
        }
        *crv__plane_at(&g->field.relief_normal[0], x, y) = n.x;
        *crv__plane_at(&g->field.relief_normal[1], x, y) = n.y;
        *crv__plane_at(&g->field.relief_normal[2], x, y) = n.z;
    }
}

void crv__height_field_finish(crv_gbuffer *g)
{
    if (g->has_field && !g->field.implicit)
        crv__run_rows(g->context, g->desc.height, finish_row, g);
}
