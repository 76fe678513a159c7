/* SPDX-License-Identifier: MIT */
#include "raycast.h"

#include <stdlib.h>
#include <string.h>

#define MAX_THREADS 1024

static int refuse(const crv_logger *log, const char *text)
{
    scene_log(log, CRV_LOG_ERROR, "view", "%s", text);
    return -1;
}

static int check_sizes(const scene_gbuffer_request *r, const crv_logger *log)
{
    int64_t band = 2 * (int64_t)r->guard_px;
    if (r->width < 1 || r->height < 1 || r->guard_px < 0 || r->width + band > CRV_MAX_SIZE
        || r->height + band > CRV_MAX_SIZE) {
        scene_log(
            log, CRV_LOG_ERROR, "view",
            "cannot be %d x %d with a guard band of %d; width and height are 1 to %d "
            "with the band included",
            (int)r->width, (int)r->height, (int)r->guard_px, CRV_MAX_SIZE);
        return -1;
    }
    if (r->layers < 1 || r->layers > CRV_MAX_LAYERS)
        return refuse(log, "has an impossible number of layers; give 1 to 4");
    if (r->threads < 0 || r->threads > MAX_THREADS)
        return refuse(log, "has an impossible number of threads; give 0 to 1024");
    return 0;
}

/* The camera of the whole buffer, guard band included. */
static int make_camera(const scene_gbuffer_request *r, const double origin[3],
                       scene_axes *axes, crv_camera *out, const crv_logger *log)
{
    const scene_view *v = &r->view;
    crv_camera camera;
    if (v->projection == CRV_ORTHOGRAPHIC) {
        if (!(v->view_height > 0.0f) || !isfinite(v->view_height))
            return refuse(log, "has no height; give a view height above 0");
        camera = crv_camera_orthographic(r->width, r->height, v->view_height);
    } else {
        if (!(v->vfov_rad > 0.0f) || !((double)v->vfov_rad < SCENE_PI))
            return refuse(log,
                          "has an impossible field of view; give an angle above 0 and "
                          "below 180 degrees");
        camera = crv_camera_perspective(r->width, r->height, v->vfov_rad);
    }
    if (!(camera.fx_px > 0.0f) || !isfinite(camera.fx_px) || !(camera.fy_px > 0.0f)
        || !isfinite(camera.fy_px))
        return refuse(log, "is too narrow or too wide for a camera; change its height or "
                           "field of view");
    if (!scene_axes_of_view(v, origin, axes))
        return refuse(log, "cannot look from eye to target; give an eye that is not the "
                           "target, and an up that is not along the view");
    camera = crv_camera_crop(&camera, -r->guard_px, -r->guard_px);
    v3_store(axes->right, camera.world_to_view);
    v3_store(axes->up, camera.world_to_view + 3);
    v3_store(axes->back, camera.world_to_view + 6);
    *out = camera;
    return 0;
}

static int allocate(const scene_gbuffer_request *r, scene_gbuffer *g)
{
    size_t width = (size_t)r->width + 2 * (size_t)r->guard_px;
    size_t height = (size_t)r->height + 2 * (size_t)r->guard_px;
    size_t pixels = width * height;
    if (pixels > SIZE_MAX / (3 * sizeof(float)))
        return -1;
    for (int32_t layer = 0; layer < r->layers; layer++)
        if (!(g->depth[layer] = malloc(pixels * sizeof(float))))
            return -1;
    g->normals = malloc(3 * pixels * sizeof(float));
    g->albedo = malloc(3 * pixels * sizeof(float));
    if (r->texture_frames) {
        g->uv = malloc(2 * pixels * sizeof(float));
        g->tangent = malloc(3 * pixels * sizeof(float));
        g->bitangent = malloc(3 * pixels * sizeof(float));
        if (!g->uv || !g->tangent || !g->bitangent)
            return -1;
    }
    return g->normals && g->albedo ? 0 : -1;
}

static void set_desc(const scene_gbuffer_request *r, crv_gbuffer_desc *desc)
{
    crv_gbuffer_desc_init(desc, sizeof *desc, r->width + 2 * r->guard_px,
                          r->height + 2 * r->guard_px);
    desc->layers = r->layers;
    desc->layer_kind = r->layer_kind;
    desc->guard_left = desc->guard_top = r->guard_px;
    desc->guard_right = desc->guard_bottom = r->guard_px;
}

static vec3 to_view(const scene_axes *axes, vec3 v)
{
    return v3(v3_dot(v, axes->right), v3_dot(v, axes->up), v3_dot(v, axes->back));
}

static void store_texture(const scene_axes *axes, const texture_frame *f, size_t pixel,
                          scene_gbuffer *g)
{
    g->uv[2 * pixel] = f ? (float)f->u : NAN;
    g->uv[2 * pixel + 1] = f ? (float)f->v : NAN;
    v3_store(f ? to_view(axes, f->tangent) : v3(0.0, 0.0, 0.0), g->tangent + 3 * pixel);
    v3_store(f ? to_view(axes, f->bitangent) : v3(0.0, 0.0, 0.0),
             g->bitangent + 3 * pixel);
}

/* All layers' depths; hit: layer 0, if there is one. */
static void cast_layers(const scene *s, const scene_gbuffer_request *r,
                        const pixel_ray *ray, bool found, surface_hit hit, size_t pixel,
                        scene_gbuffer *g)
{
    uint32_t past[CRV_MAX_LAYERS];
    if (found && r->layer_kind == CRV_LAYERS_SOLID)
        prefer_front(s, ray, &hit);
    for (int32_t layer = 0; layer < r->layers; layer++) {
        if (found && layer > 0)
            found = r->layer_kind == CRV_LAYERS_SOLID
                        ? find_facing_surface(s, ray, layer % 2 == 1, past, layer, &hit)
                        : find_next_surface(s, ray, &hit);
        g->depth[layer][pixel] = found ? (float)hit.depth : INFINITY;
        past[layer] = hit.triangle;
    }
}

/* Layer 0 with all that is told of it, then the layers behind it. */
static void cast_pixel(const scene *s, const scene_gbuffer_request *r,
                       const scene_axes *axes, scene_gbuffer *g, int32_t x, int32_t y)
{
    size_t pixel = (size_t)y * (size_t)g->desc.width + (size_t)x;
    pixel_ray ray = ray_through_pixel(&g->camera, axes, x, y);
    surface_hit hit = {0};
    texture_frame frame;
    bool found = find_surface(s, &ray, 0.0f, &hit);
    vec3 normal = v3(0.0, 0.0, 0.0), albedo = normal;
    if (found) {
        normal = to_view(axes, surface_normal(s, &ray, &hit, r->normals));
        albedo = v3_from(s->mesh.palette[s->mesh.materials[hit.triangle]].albedo);
    }
    v3_store(normal, g->normals + 3 * pixel);
    v3_store(albedo, g->albedo + 3 * pixel);
    if (r->texture_frames)
        store_texture(axes,
                      found && surface_texture(s, &ray, &hit, &frame) ? &frame : NULL,
                      pixel, g);
    cast_layers(s, r, &ray, found, hit, pixel, g);
}

static bool is_stopped(const scene_gbuffer_request *r)
{
    return r->stop && atomic_load_explicit(r->stop, memory_order_relaxed);
}

int scene_render_gbuffer(const scene *s, const scene_gbuffer_request *request,
                         scene_gbuffer *out, const crv_logger *log)
{
    scene_gbuffer g = {.view = request->view};
    scene_axes axes;
    if (check_sizes(request, log)
        || make_camera(request, s->mesh.origin, &axes, &g.camera, log))
        return -1;
    memcpy(g.origin, s->mesh.origin, sizeof g.origin);
    /* What was rounded is told as it was used. */
    v3_store_double(v3_add(axes.eye, v3_from_double(g.origin)), g.view.eye);
    set_desc(request, &g.desc);
    if (allocate(request, &g)) {
        scene_gbuffer_free(&g);
        return refuse(log, "is too large for the memory there is; make it smaller");
    }
    const int32_t height = g.desc.height;
    int32_t done = 0;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 2)                                            \
    num_threads(scene_thread_count(request->threads))
#endif
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < g.desc.width && !is_stopped(request); x++)
            cast_pixel(s, request, &axes, &g, x, y);
        scene_tell_row(request->watch, request->user, &done);
    }
    if (is_stopped(request)) {
        scene_gbuffer_free(&g);
        return -1;
    }
    *out = g;
    return 0;
}

void scene_gbuffer_free(scene_gbuffer *g)
{
    if (!g)
        return;
    for (int layer = 0; layer < CRV_MAX_LAYERS; layer++)
        free(g->depth[layer]);
    free(g->normals);
    free(g->albedo);
    free(g->uv);
    free(g->tangent);
    free(g->bitangent);
    memset(g, 0, sizeof *g);
}

static crv_status fill(const scene_gbuffer *g, crv_gbuffer *gbuffer)
{
    crv_const_image normals =
        crv_const_image_packed(g->normals, g->desc.width, g->desc.height, 3);
    crv_status status = crv_gbuffer_set_camera(gbuffer, &g->camera);
    for (int32_t layer = 0; layer < g->desc.layers && status == CRV_OK; layer++) {
        crv_const_image depth =
            crv_const_image_packed(g->depth[layer], g->desc.width, g->desc.height, 1);
        status = crv_gbuffer_set_depth(gbuffer, layer, &depth, NULL);
    }
    if (status == CRV_OK)
        status = crv_gbuffer_set_normals(gbuffer, &normals, CRV_NORMAL_VIEW);
    return status;
}

crv_status scene_gbuffer_upload(const scene_gbuffer *g, struct crv_context *context,
                                crv_gbuffer **gbuffer)
{
    crv_gbuffer *filled = *gbuffer;
    crv_status status = CRV_OK;
    if (!filled)
        status = crv_gbuffer_create(context, &g->desc, &filled);
    if (status != CRV_OK)
        return status;
    status = fill(g, filled);
    if (status == CRV_OK)
        *gbuffer = filled;
    else if (!*gbuffer)
        crv_gbuffer_destroy(filled);
    return status;
}
