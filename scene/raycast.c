/* SPDX-License-Identifier: MIT */
/*
 * Embree finds the triangle in float; where the exact ray meets that triangle's plane is
 * then computed in double, so that the depth of a plane is a plane to float precision.
 */
#include "raycast.h"

/* Surfaces closer than this, relative to their depth, are one surface: above the float
 * error of finding a surface again, below the thickness of anything that is drawn. */
#define SAME_SURFACE 1e-5f
/* The same for rays that begin close to a surface far from the world's origin, relative
 * to the largest coordinate. */
#define SAME_SURFACE_OF_SCENE 5e-7f

pixel_ray ray_through_pixel(const crv_camera *camera, const scene_axes *axes, int32_t x,
                            int32_t y)
{
    double u = ((double)x + 0.5 - (double)camera->cx_px) / (double)camera->fx_px;
    double v = -((double)y + 0.5 - (double)camera->cy_px) / (double)camera->fy_px;
    vec3 offset = v3_along(v3_scale(axes->right, u), axes->up, v);
    vec3 forward = v3_scale(axes->back, -1.0);
    pixel_ray ray = {axes->eye, forward};
    if (camera->projection == CRV_ORTHOGRAPHIC)
        ray.origin = v3_add(axes->eye, offset);
    else
        ray.direction = v3_add(forward, offset);
    return ray;
}

static void get_corners(const mesh *m, uint32_t triangle, vec3 corner[3])
{
    for (int i = 0; i < 3; i++)
        corner[i] = mesh_position(m, m->indices[3 * (size_t)triangle + (size_t)i]);
}

static void refine(const mesh *m, const pixel_ray *ray, surface_hit *hit)
{
    vec3 corner[3];
    get_corners(m, hit->triangle, corner);
    hit->face = v3_normalise(
        v3_cross(v3_sub(corner[1], corner[0]), v3_sub(corner[2], corner[0])));
    const double along = v3_dot(hit->face, ray->direction);
    const double depth = v3_dot(hit->face, v3_sub(corner[0], ray->origin)) / along;
    hit->from_back = along > 0.0;
    /* The plane of a triangle that is seen edge-on says little: keep what was found. */
    hit->depth = fabs(depth - (double)hit->found) <= 1e-3 * (double)hit->found
                     ? depth
                     : (double)hit->found;
}

static struct RTCRayHit query_beyond(const pixel_ray *ray, float beyond)
{
    struct RTCRayHit query = {0};
    query.ray.org_x = (float)ray->origin.x;
    query.ray.org_y = (float)ray->origin.y;
    query.ray.org_z = (float)ray->origin.z;
    query.ray.dir_x = (float)ray->direction.x;
    query.ray.dir_y = (float)ray->direction.y;
    query.ray.dir_z = (float)ray->direction.z;
    query.ray.tfar = INFINITY;
    query.ray.mask = UINT32_MAX;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    /* Depth is positive: a surface in the eye itself is not seen. */
    query.ray.tnear = fmaxf(beyond, 1e-30f);
    return query;
}

static bool take_hit(const scene *s, const pixel_ray *ray, const struct RTCRayHit *query,
                     surface_hit *hit)
{
    if (query->hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    hit->triangle = query->hit.primID;
    hit->found = query->ray.tfar;
    refine(&s->mesh, ray, hit);
    return true;
}

bool find_surface(const scene *s, const pixel_ray *ray, float beyond, surface_hit *hit)
{
    struct RTCRayHit query = query_beyond(ray, beyond);
    embree_intersect(s->rtc, &query);
    return take_hit(s, ray, &query, hit);
}

static float largest_coordinate(const scene *s)
{
    float largest = 0.0f;
    for (int axis = 0; axis < 3; axis++)
        largest = fmaxf(largest, fmaxf(fabsf(s->lower[axis]), fabsf(s->upper[axis])));
    return largest;
}

/* How far apart along the ray two surfaces are at least. */
static float same_surface(const scene *s, const surface_hit *hit)
{
    return fmaxf(SAME_SURFACE * hit->found,
                 SAME_SURFACE_OF_SCENE * largest_coordinate(s));
}

bool find_next_surface(const scene *s, const pixel_ray *ray, surface_hit *hit)
{
    uint32_t before = hit->triangle;
    float beyond = hit->found + same_surface(s, hit);
    do {
        beyond = nextafterf(beyond, INFINITY);
        if (!find_surface(s, ray, beyond, hit))
            return false;
        beyond = hit->found;
    } while (hit->triangle == before); /* a ray meets a triangle once */
    return true;
}

typedef struct facing_query {
    embree_context context; /* first, so that the filter finds the rest */
    const mesh *mesh;
    vec3 direction;
    bool back;
    const uint32_t *past;
    int past_count;
} facing_query;

/* A filter, because a plain query tells only one of triangles that coincide. */
static void keep_facing(const struct RTCFilterFunctionNArguments *arguments)
{
    const facing_query *q = (const facing_query *)(const void *)arguments->context;
    /* The packet of one ray has the layout of a single hit. */
    uint32_t triangle = ((const struct RTCHit *)(const void *)arguments->hit)->primID;
    vec3 corner[3];
    get_corners(q->mesh, triangle, corner);
    vec3 face = v3_cross(v3_sub(corner[1], corner[0]), v3_sub(corner[2], corner[0]));
    bool keep = (v3_dot(face, q->direction) > 0.0) == q->back;
    for (int i = 0; i < q->past_count; i++)
        keep = keep && q->past[i] != triangle;
    if (!keep)
        arguments->valid[0] = 0;
}

bool find_facing_surface(const scene *s, const pixel_ray *ray, bool back,
                         const uint32_t *past, int past_count, surface_hit *hit)
{
    facing_query q = {.mesh = &s->mesh,
                      .direction = ray->direction,
                      .back = back,
                      .past = past,
                      .past_count = past_count};
    float step = same_surface(s, hit);
    /* What touches the surface with its other side may be found a little before it. */
    float beyond = hit->from_back == back ? hit->found + step : hit->found - step;
    double depth = hit->depth;
    struct RTCRayHit query = query_beyond(ray, beyond);
    embree_intersect_filtered(s->rtc, &query, keep_facing, &q.context);
    if (!take_hit(s, ray, &query, hit))
        return false;
    hit->depth = fmax(hit->depth, depth);
    return true;
}

void prefer_front(const scene *s, const pixel_ray *ray, surface_hit *hit)
{
    surface_hit front = *hit;
    if (hit->from_back && find_facing_surface(s, ray, false, NULL, 0, &front)
        && front.found <= hit->found + same_surface(s, hit))
        *hit = front;
}

/* Weights of the corners at the point where the ray meets the triangle's plane. */
static void get_barycentrics(const vec3 corner[3], vec3 point, double weight[3])
{
    vec3 a = v3_sub(corner[1], corner[0]), b = v3_sub(corner[2], corner[0]);
    vec3 p = v3_sub(point, corner[0]), normal = v3_cross(a, b);
    double area = v3_dot(normal, normal);
    double u = v3_dot(v3_cross(p, b), normal) / area;
    double v = v3_dot(v3_cross(a, p), normal) / area;
    weight[1] = fmin(fmax(u, 0.0), 1.0);
    weight[2] = fmin(fmax(v, 0.0), 1.0 - weight[1]);
    weight[0] = 1.0 - weight[1] - weight[2];
}

void surface_weights(const scene *s, const pixel_ray *ray, const surface_hit *hit,
                     vec3 corner[3], double weight[3])
{
    get_corners(&s->mesh, hit->triangle, corner);
    get_barycentrics(corner, v3_along(ray->origin, ray->direction, hit->depth), weight);
}

vec3 surface_normal(const scene *s, const pixel_ray *ray, const surface_hit *hit,
                    scene_normals kind)
{
    const mesh *m = &s->mesh;
    const uint32_t *index = m->indices + 3 * (size_t)hit->triangle;
    vec3 seen = hit->from_back ? v3_scale(hit->face, -1.0) : hit->face;
    vec3 corner[3], sum = v3(0.0, 0.0, 0.0), normal = v3(0.0, 0.0, 0.0);
    double weight[3];
    if (kind == SCENE_NORMALS_FACE)
        return seen;
    surface_weights(s, ray, hit, corner, weight);
    for (int i = 0; i < 3; i++) {
        vec3 n = mesh_normal(m, index[i]);
        normal = v3_along(normal, n, weight[i]);
        sum = v3_add(sum, n);
    }
    normal = v3_normalise(normal);
    if (!(v3_dot(normal, normal) > 0.5))
        return seen;
    /* Turned as a whole with the triangle: where its normals and its winding disagree the
     * normals, too, are for the side that is seen. */
    return v3_dot(sum, seen) < 0.0 ? v3_scale(normal, -1.0) : normal;
}
