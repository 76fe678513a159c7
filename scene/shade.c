/* SPDX-License-Identifier: MIT */
/*
 * A plain outdoor light: enough to judge ambient occlusion in a picture, no more.
 */
#include "raycast.h"

/* Linear radiance. Sky and ground light add up with the key light to less than 1 on white
 * paper that faces both. */
static const vec3 sky_light = {0.30, 0.36, 0.46};
static const vec3 ground_light = {0.17, 0.15, 0.13};
static const vec3 key_light = {0.66, 0.60, 0.50};
static const vec3 zenith = {0.22, 0.36, 0.62};
static const vec3 horizon = {0.66, 0.74, 0.84};

typedef struct lighting {
    const scene *scene;
    const scene_gbuffer *gbuffer;
    scene_axes axes;
    vec3 up;     /* of the world, as the view has it */
    vec3 to_key; /* over the viewer's left shoulder */
} lighting;

static vec3 mix(vec3 a, vec3 b, double t)
{
    return v3_along(a, v3_sub(b, a), t);
}

static vec3 multiply(vec3 a, vec3 b)
{
    return v3(a.x * b.x, a.y * b.y, a.z * b.z);
}

static vec3 sky_colour(const lighting *l, vec3 direction)
{
    double height = v3_dot(v3_normalize(direction), l->up);
    return mix(horizon, zenith, sqrt(fmin(fmax(height, 0.0), 1.0)));
}

/* Rays begin off the surface by a share of the pixel's footprint, which is what the depth
 * of a smooth-shaded, faceted surface is uncertain by. */
static vec3 shadow_origin(const lighting *l, vec3 point, vec3 normal, double depth)
{
    const crv_camera *c = &l->gbuffer->camera;
    double footprint =
        (c->projection == CRV_PERSPECTIVE ? depth : 1.0) / (double)c->fy_px;
    double largest = fmax(fabs(point.x), fmax(fabs(point.y), fabs(point.z)));
    return v3_along(point, normal, fmax(0.5 * footprint, 1e-5 * largest));
}

static bool in_shadow(const lighting *l, vec3 origin)
{
    struct RTCRay ray = {0};
    ray.org_x = (float)origin.x;
    ray.org_y = (float)origin.y;
    ray.org_z = (float)origin.z;
    ray.dir_x = (float)l->to_key.x;
    ray.dir_y = (float)l->to_key.y;
    ray.dir_z = (float)l->to_key.z;
    ray.tfar = INFINITY;
    ray.mask = UINT32_MAX;
    return embree_occluded(l->scene->rtc, &ray);
}

static vec3 shade_pixel(const lighting *l, int32_t x, int32_t y, double accessibility)
{
    const scene_gbuffer *g = l->gbuffer;
    size_t pixel = (size_t)y * (size_t)g->desc.width + (size_t)x;
    double depth = (double)g->depth[0][pixel], facing;
    pixel_ray ray = ray_through_pixel(&g->camera, &l->axes, x, y);
    vec3 n, normal, point, light;
    if (!(depth > 0.0 && isfinite(depth)))
        return sky_colour(l, ray.direction);
    n = v3_from(g->normals + 3 * pixel);
    normal = v3_along(v3_along(v3_scale(l->axes.right, n.x), l->axes.up, n.y),
                      l->axes.back, n.z);
    point = v3_along(ray.origin, ray.direction, depth);
    light = v3_scale(mix(ground_light, sky_light, 0.5 + 0.5 * v3_dot(normal, l->up)),
                     accessibility);
    facing = v3_dot(normal, l->to_key);
    if (facing > 0.0 && !in_shadow(l, shadow_origin(l, point, normal, depth)))
        light = v3_along(light, key_light, facing);
    return multiply(v3_from(g->albedo + 3 * pixel), light);
}

static void shade_row(const lighting *l, const crv_image *accessibility,
                      const crv_image *rgb, int32_t y)
{
    const crv_gbuffer_desc *d = &l->gbuffer->desc;
    for (int32_t x = 0; x < rgb->width; x++) {
        double open = accessibility ? (double)*crv_image_at(accessibility, x, y, 0) : 1.0;
        vec3 colour = shade_pixel(l, x + d->guard_left, y + d->guard_top, open);
        *crv_image_at(rgb, x, y, 0) = (float)colour.x;
        *crv_image_at(rgb, x, y, 1) = (float)colour.y;
        *crv_image_at(rgb, x, y, 2) = (float)colour.z;
    }
}

static bool covers(const crv_image *image, const crv_gbuffer_desc *d, int32_t channels)
{
    return image->data && image->channels == channels
           && image->width == d->width - d->guard_left - d->guard_right
           && image->height == d->height - d->guard_top - d->guard_bottom;
}

int scene_shade(const scene *s, const scene_gbuffer *g, const crv_image *accessibility,
                const crv_image *rgb, int32_t threads, const crv_logger *log)
{
    lighting l = {.scene = s, .gbuffer = g};
    if (!covers(rgb, &g->desc, 3)
        || (accessibility && !covers(accessibility, &g->desc, 1))
        || !scene_axes_of_view(&g->view, &l.axes)) {
        scene_log(log, CRV_LOG_ERROR, "picture",
                  "does not fit the G-buffer; give it the size inside the guard band");
        return -1;
    }
    l.up = v3_normalize(v3_from(g->view.up));
    l.to_key = v3_normalize(
        v3_along(v3_along(v3_scale(l.axes.right, -0.62), l.up, 0.8), l.axes.back, 0.42));
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 2) num_threads(scene_thread_count(threads))
#else
    (void)threads;
#endif
    for (int32_t y = 0; y < rgb->height; y++)
        shade_row(&l, accessibility, rgb, y);
    return 0;
}
