/* SPDX-License-Identifier: MIT */
/*
 * Pictures: sky light that accessibility darkens, and one key light that it does not.
 */
#include "raycast.h"
#include "reference.h"
#include "sky.h"

typedef struct lighting {
    const scene *scene;
    const scene_gbuffer *gbuffer;
    const reference *traced; /* or NULL */
    scene_axes axes;
    scene_lighting light;
    sky_table table;
    vec3 sky[3]; /* the sky's axes in world space */
    vec3 to_key;
    vec3 key_colour;
    bool has_key;
} lighting;

static vec3 multiply(vec3 a, vec3 b)
{
    return v3(a.x * b.x, a.y * b.y, a.z * b.z);
}

static vec3 to_sky(const lighting *l, vec3 v)
{
    return v3(v3_dot(v, l->sky[0]), v3_dot(v, l->sky[1]), v3_dot(v, l->sky[2]));
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

/* How open a surface is to each colour of the sky, and to where. */
typedef struct opening {
    vec3 accessibility;
    vec3 bent_normal; /* view space; zero: the normal */
} opening;

static vec3 view_to_world(const lighting *l, vec3 v)
{
    return v3_along(v3_along(v3_scale(l->axes.right, v.x), l->axes.up, v.y), l->axes.back,
                    v.z);
}

/* user: a lighting. */
static void traced_radiance(const void *user, const float direction[3], float rgb[3])
{
    const lighting *l = user;
    v3_store(sky_lighting_radiance(&l->light, to_sky(l, v3_from(direction))), rgb);
}

static vec3 traced_irradiance(const lighting *l, int32_t x, int32_t y)
{
    const crv_gbuffer_desc *d = &l->gbuffer->desc;
    float rgb[3];
    reference_irradiance(l->traced, x - d->guard_left, y - d->guard_top, traced_radiance,
                         l, rgb);
    return v3_from(rgb);
}

static vec3 irradiance_through(const lighting *l, vec3 normal, const opening *open)
{
    const vec3 bent = open->bent_normal;
    if (!(v3_dot(bent, bent) > 0.0))
        return multiply(sky_irradiance(&l->light, &l->table, to_sky(l, normal)),
                        open->accessibility);
    return sky_open_irradiance(&l->light, &l->table,
                               to_sky(l, view_to_world(l, v3_normalise(bent))),
                               open->accessibility);
}

static vec3 shade_pixel(const lighting *l, int32_t x, int32_t y, const opening *open)
{
    const scene_gbuffer *g = l->gbuffer;
    size_t pixel = (size_t)y * (size_t)g->desc.width + (size_t)x;
    double depth = (double)g->depth[0][pixel];
    pixel_ray ray = ray_through_pixel(&g->camera, &l->axes, x, y);
    if (!(depth > 0.0 && isfinite(depth)))
        return sky_radiance(&l->light, to_sky(l, v3_normalise(ray.direction)));
    vec3 normal = view_to_world(l, v3_from(g->normals + 3 * pixel));
    vec3 point = v3_along(ray.origin, ray.direction, depth);
    vec3 light = v3_scale(l->traced ? traced_irradiance(l, x, y)
                                    : irradiance_through(l, normal, open),
                          1.0 / SCENE_PI);
    double facing = v3_dot(normal, l->to_key);
    if (l->has_key && facing > 0.0
        && !in_shadow(l, shadow_origin(l, point, normal, depth)))
        light = v3_along(light, l->key_colour, facing);
    return multiply(v3_from(g->albedo + 3 * pixel), light);
}

/* One channel stands for all three. */
static vec3 vector_at(const crv_const_image *image, int32_t x, int32_t y)
{
    const int32_t step = image->channels > 1 ? 1 : 0;
    return v3((double)*crv_const_image_at(image, x, y, 0),
              (double)*crv_const_image_at(image, x, y, step),
              (double)*crv_const_image_at(image, x, y, 2 * step));
}

static void shade_row(const lighting *l, const scene_occlusion *occlusion,
                      const crv_image *rgb, int32_t y)
{
    const crv_gbuffer_desc *d = &l->gbuffer->desc;
    for (int32_t x = 0; x < rgb->width; x++) {
        opening open = {.accessibility = {1.0, 1.0, 1.0}};
        if (occlusion->accessibility.data)
            open.accessibility = vector_at(&occlusion->accessibility, x, y);
        if (occlusion->bent_normal.data)
            open.bent_normal = vector_at(&occlusion->bent_normal, x, y);
        vec3 colour = shade_pixel(l, x + d->guard_left, y + d->guard_top, &open);
        *crv_image_at(rgb, x, y, 0) = (float)colour.x;
        *crv_image_at(rgb, x, y, 1) = (float)colour.y;
        *crv_image_at(rgb, x, y, 2) = (float)colour.z;
    }
}

static bool covers(int32_t width, int32_t height, const crv_gbuffer_desc *d)
{
    return width == d->width - d->guard_left - d->guard_right
           && height == d->height - d->guard_top - d->guard_bottom;
}

static bool fits(const crv_const_image *image, const crv_gbuffer_desc *d,
                 bool may_be_grey)
{
    return !image->data
           || (covers(image->width, image->height, d)
               && (image->channels == 3 || (may_be_grey && image->channels == 1)));
}

/* The axes' images under the shortest turn that takes +Y to the zenith. */
static void turn_sky(vec3 up, vec3 axes[3])
{
    vec3 pivot = v3(up.z, 0.0, -up.x); /* +Y x up */
    for (int i = 0; i < 3; i++) {
        vec3 axis = v3(i == 0, i == 1, i == 2);
        vec3 once = v3_cross(pivot, axis);
        axes[i] = v3_along(v3_along(axis, once, 1.0), v3_cross(pivot, once),
                           1.0 / (1.0 + up.y));
        /* Straight down there is no shortest way: half a turn about X. */
        if (up.y < -1.0 + 1e-9)
            axes[i] = v3(axis.x, -axis.y, -axis.z);
    }
}

static vec3 unit_or(const float given[3], vec3 otherwise)
{
    vec3 v = v3_normalise(v3_from(given));
    return v3_dot(v, v) > 0.5 ? v : otherwise;
}

static void prepare(lighting *l, const scene_lighting *given)
{
    vec3 view_up = v3_normalise(v3_from_double(l->gbuffer->view.up));
    l->light = given ? *given : scene_lighting_default();
    turn_sky(unit_or(l->light.sky_up, view_up), l->sky);
    if (l->light.sky == SCENE_SKY_GRADIENT)
        sky_fill_table(&l->table);
    vec3 shoulder = v3_normalise(v3_along(
        v3_along(v3_scale(l->axes.right, -0.62), view_up, 0.8), l->axes.back, 0.42));
    l->to_key = unit_or(l->light.key_direction, shoulder);
    l->key_colour = v3_from(l->light.key_colour);
    l->has_key = v3_dot(l->key_colour, l->key_colour) > 0.0;
}

int scene_shade(const scene *s, const scene_gbuffer *g, const scene_lighting *light,
                const scene_occlusion *occlusion, const crv_image *rgb, int32_t threads,
                const crv_logger *log)
{
    const scene_occlusion given = occlusion ? *occlusion : (scene_occlusion){0};
    lighting l = {.scene = s, .gbuffer = g, .traced = given.traced};
    if (!rgb->data || rgb->channels != 3 || !covers(rgb->width, rgb->height, &g->desc)
        || !fits(&given.accessibility, &g->desc, true)
        || !fits(&given.bent_normal, &g->desc, false)
        || !scene_axes_of_view(&g->view, g->origin, &l.axes)) {
        scene_log(log, CRV_LOG_ERROR, "picture",
                  "does not fit the G-buffer; give it the size inside the guard band");
        return -1;
    }
    prepare(&l, light);
    int32_t done = 0;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 2) num_threads(scene_thread_count(threads))
#else
    (void)threads;
#endif
    for (int32_t y = 0; y < rgb->height; y++) {
        shade_row(&l, &given, rgb, y);
        scene_tell_row(l.light.watch, l.light.user, &done);
    }
    return 0;
}
