/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "reference_internal.h"
#include "reference_sheets.h"
#include "sampling.h"

/*
 * Rays begin off the surface on the viewer's side, along the triangle's own normal, by
 * this share of the largest length that took part in rounding: coordinates, depth, and
 * the size of the triangles, whose planes the ray caster knows to about 2e-7 of it. Ten
 * ulps keep a plane from shading itself; a gap or contact smaller than that is lost.
 */
#define OFFSET_SHARE 1e-6f

/* From here on one pixel is worth handing to a thread. */
enum { MANY_RAYS = 500 };

static int refuse(const crv_logger *log, const char *text)
{
    scene_log(log, CRV_LOG_ERROR, "reference", "%s", text);
    return -1;
}

static bool in_range(float value, float low, float high)
{
    return value >= low && value <= high; /* false for NaN */
}

static int check_options(const reference_options *o, const crv_logger *log)
{
    if (!in_range(o->radius, 1e-30f, 1e18f))
        return refuse(log, "has an impossible radius; give one above 0");
    if (!in_range(o->thickness, 0.0f, 1e3f))
        return refuse(log, "has an impossible thickness; give 0 to 1000 radii");
    if (o->rays < 1 || o->rays > REFERENCE_MAX_RAYS)
        return refuse(log, "has an impossible number of rays; give 1 to 65536");
    if (!in_range(o->max_error, 0.0f, 1.0f))
        return refuse(log, "has an impossible error to stop at; give 0 to 1");
    if (!in_range(o->tau, 0.0f, 1e6f) || !in_range(o->u, 1e-6f, 1e6f))
        return refuse(log, "has an impossible falloff; give tau 0 or more, u above 0");
    return 0;
}

static float largest_length(const scene *s)
{
    float largest = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        float corner = fmaxf(fabsf(s->lower[axis]), fabsf(s->upper[axis]));
        largest = fmaxf(largest, fmaxf(corner, s->upper[axis] - s->lower[axis]));
    }
    return largest;
}

static bool allocate(reference *r)
{
    size_t count = (size_t)r->width * (size_t)r->height;
    r->accessibility = calloc(count, REFERENCE_FLOATS * sizeof(float));
    r->error = r->accessibility ? r->accessibility + count : NULL;
    r->bent_normal = r->error ? r->error + count : NULL;
    if (r->options.all_falloffs)
        r->falloffs = calloc(count, REFERENCE_FALLOFFS * 2 * sizeof(float));
    return r->accessibility && (r->falloffs || !r->options.all_falloffs);
}

int reference_create(const scene *s, const scene_gbuffer *g, const reference_options *o,
                     reference **out, const crv_logger *log)
{
    const crv_gbuffer_desc *d = &g->desc;
    reference *r;
    if (check_options(o, log))
        return -1;
    r = calloc(1, sizeof *r);
    if (!r)
        return refuse(log, "out of memory; close other programs");
    *r = (reference){.scene = s, .occluders = s, .gbuffer = g, .options = *o};
    r->width = d->width - d->guard_left - d->guard_right;
    r->height = d->height - d->guard_top - d->guard_bottom;
    r->offset = s ? OFFSET_SHARE * largest_length(s) : 0.0f;
    if (!scene_axes_of_view(&g->view, g->origin, &r->axes) || !allocate(r)) {
        reference_free(r);
        return refuse(log, "out of memory; make the picture smaller");
    }
    if (o->kind == REFERENCE_VISIBLE) {
        double thickness = o->thickness > 0.0f ? (double)o->thickness : 1.0;
        if (reference_make_sheets(g, (double)o->radius, thickness, &r->sheets, log)) {
            reference_free(r);
            return -1;
        }
        r->occluders = r->sheets;
    }
    if (r->offset > 0.01f * o->radius)
        scene_log(log, CRV_LOG_WARNING, "reference",
                  "the radius %g is so small for this scene that rays begin %.2g of it "
                  "off the surface; leave out what makes the scene large",
                  (double)o->radius, (double)(r->offset / o->radius));
    *out = r;
    return 0;
}

void reference_free(reference *r)
{
    if (!r)
        return;
    scene_free(r->sheets);
    free(r->accessibility);
    free(r->falloffs);
    free(r);
}

void reference_restart(reference *r, uint32_t seed)
{
    r->options.seed = seed;
    r->fingerprint = 0;
    r->done = 0;
}

static vec3 to_world(const scene_axes *axes, vec3 v)
{
    return v3_along(v3_along(v3_scale(axes->right, v.x), axes->up, v.y), axes->back, v.z);
}

static void turn_to_view(const scene_axes *axes, float v[3])
{
    const vec3 w = v3_from(v);
    v3_store(v3(v3_dot(w, axes->right), v3_dot(w, axes->up), v3_dot(w, axes->back)), v);
}

static double offset_at(const reference *r, double depth)
{
    return fmax((double)r->offset, (double)OFFSET_SHARE * depth);
}

/* The surface of the scene itself; false: background. */
static bool find_point(const reference *r, const pixel_ray *ray, reference_point *out)
{
    surface_hit hit;
    if (!find_surface(r->scene, ray, 0.0f, &hit))
        return false;
    vec3 side = hit.from_back ? v3_scale(hit.face, -1.0) : hit.face;
    out->normal = surface_normal(r->scene, ray, &hit, r->options.normals);
    out->origin = v3_along(v3_along(ray->origin, ray->direction, hit.depth), side,
                           offset_at(r, hit.depth));
    return true;
}

/* The vertex of layer 0's sheet. A depth buffer's surface never folds back over the
 * viewing ray, so towards the viewer is off the surface whatever its slope; a slanted
 * one needs more of it. */
static bool find_sheet_point(const reference *r, const pixel_ray *ray, size_t pixel,
                             reference_point *out)
{
    double depth = (double)r->gbuffer->depth[0][pixel];
    vec3 to_viewer = v3_scale(v3_normalise(ray->direction), -1.0);
    if (!(depth > 0.0 && isfinite(depth)))
        return false;
    out->normal =
        v3_normalise(to_world(&r->axes, v3_from(r->gbuffer->normals + 3 * pixel)));
    if (!(v3_dot(out->normal, out->normal) > 0.5))
        out->normal = to_viewer;
    const double facing = fmax(v3_dot(out->normal, to_viewer), 0.01);
    out->origin = v3_along(v3_along(ray->origin, ray->direction, depth), to_viewer,
                           offset_at(r, depth) / facing);
    return true;
}

/* The surface in a pixel inside the guard band; false: background. */
static bool find_pixel(const reference *r, int32_t x, int32_t y, reference_point *out)
{
    const crv_gbuffer_desc *d = &r->gbuffer->desc;
    int32_t column = x + d->guard_left, row = y + d->guard_top;
    size_t pixel = (size_t)row * (size_t)d->width + (size_t)column;
    pixel_ray ray = ray_through_pixel(&r->gbuffer->camera, &r->axes, column, row);
    return r->options.kind == REFERENCE_VISIBLE ? find_sheet_point(r, &ray, pixel, out)
                                                : find_point(r, &ray, out);
}

/* The pixel's own random numbers. */
static uint64_t stream_of(const reference *r, int32_t x, int32_t y)
{
    uint64_t index = (uint64_t)y * (uint64_t)r->width + (uint64_t)x;
    return sampling_mix(index ^ sampling_mix(r->options.seed));
}

static void estimate_pixel(const reference *r, int32_t x, int32_t y,
                           const crv_falloff *falloffs, int32_t count,
                           reference_value *out)
{
    reference_point point;
    for (int32_t k = 0; k < count; k++)
        out[k] = (reference_value){.accessibility = 1.0f};
    if (!find_pixel(r, x, y, &point))
        return;
    reference_trace(r, &point, stream_of(r, x, y), falloffs, count, out);
    for (int32_t k = 0; k < count; k++)
        turn_to_view(&r->axes, out[k].bent_normal);
}

reference_value reference_pixel(const reference *r, int32_t x, int32_t y)
{
    reference_value value;
    estimate_pixel(r, x, y, &r->options.falloff, 1, &value);
    return value;
}

void reference_irradiance(const reference *r, int32_t x, int32_t y,
                          reference_radiance radiance, const void *user, float rgb[3])
{
    reference_point point;
    vec3 sum = v3(0.0, 0.0, 0.0);
    if (find_pixel(r, x, y, &point))
        sum = reference_trace_light(r, &point, stream_of(r, x, y), radiance, user);
    v3_store(sum, rgb);
}

int64_t reference_total(const reference *r)
{
    return (int64_t)r->width * (int64_t)r->height;
}

int64_t reference_done(const reference *r)
{
    return r->done;
}

static size_t pixel_count(const reference *r)
{
    return (size_t)r->width * (size_t)r->height;
}

static void compute_pixel(reference *r, int64_t i)
{
    static const crv_falloff all[REFERENCE_FALLOFFS] = {
        CRV_FALLOFF_NONE,  CRV_FALLOFF_LINEAR,      CRV_FALLOFF_SQRT,
        CRV_FALLOFF_CUBIC, CRV_FALLOFF_EXPONENTIAL, CRV_FALLOFF_ALCHEMY};
    reference_value values[REFERENCE_FALLOFFS], value;
    int32_t x = (int32_t)(i % r->width), y = (int32_t)(i / r->width);
    if (r->options.all_falloffs) {
        estimate_pixel(r, x, y, all, REFERENCE_FALLOFFS, values);
        for (size_t k = 0; k < REFERENCE_FALLOFFS; k++) {
            r->falloffs[2 * k * pixel_count(r) + (size_t)i] = values[k].accessibility;
            r->falloffs[(2 * k + 1) * pixel_count(r) + (size_t)i] = values[k].error;
        }
        value = values[r->options.falloff];
    } else {
        value = reference_pixel(r, x, y);
    }
    r->accessibility[i] = value.accessibility;
    r->error[i] = value.error;
    memcpy(r->bent_normal + 3 * i, value.bent_normal, sizeof value.bent_normal);
}

void reference_advance(reference *r, int64_t pixels, int32_t threads)
{
    int64_t begin = r->done, left = reference_total(r) - begin;
    int64_t end = begin + (pixels < left ? pixels : left);
#ifdef _OPENMP
    const int32_t together = r->options.rays < MANY_RAYS ? 8 : 1;
#pragma omp parallel for schedule(dynamic, together)                                     \
    num_threads(scene_thread_count(threads))
#else
    (void)threads;
#endif
    for (int64_t i = begin; i < end; i++)
        compute_pixel(r, i);
    r->done = end;
}

const float *reference_accessibility(const reference *r)
{
    return r->accessibility;
}

const float *reference_error(const reference *r)
{
    return r->error;
}

const float *reference_bent_normal(const reference *r)
{
    return r->bent_normal;
}

const float *reference_falloff_accessibility(const reference *r, crv_falloff falloff)
{
    return r->falloffs + 2 * (size_t)falloff * pixel_count(r);
}

const float *reference_falloff_error(const reference *r, crv_falloff falloff)
{
    return r->falloffs + (2 * (size_t)falloff + 1) * pixel_count(r);
}
