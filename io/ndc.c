/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "ndc.h"

typedef struct vec3 {
    double x, y, z;
} vec3;

static double dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec3 cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static vec3 scaled(vec3 a, double s)
{
    return (vec3){a.x * s, a.y * s, a.z * s};
}

static vec3 minus(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* Splits a into its length and its direction; false if it has none. */
static bool split(vec3 a, double *length, vec3 *direction)
{
    *length = sqrt(dot(a, a));
    if (!isfinite(*length) || !(*length > 1e-30))
        return false;
    *direction = scaled(a, 1.0 / *length);
    return true;
}

/* The world-space coefficients of one output coordinate of a row-vector matrix. */
static vec3 column(const float m[16], int c)
{
    return (vec3){(double)m[c], (double)m[4 + c], (double)m[8 + c]};
}

static void store_rotation(float out[9], vec3 right, vec3 up, vec3 back)
{
    const double m[9] = {right.x, right.y, right.z, up.x,  up.y,
                         up.z,    back.x,  back.y,  back.z};
    for (int i = 0; i < 9; i++)
        out[i] = (float)m[i];
}

int io__rotation_from_world_to_camera(const float world_to_camera[16], float rotation[9])
{
    vec3 axis[3];
    for (int c = 0; c < 3; c++) {
        double length;
        if (!split(column(world_to_camera, c), &length, &axis[c]))
            return -1;
    }
    if (fabs(dot(axis[0], axis[1])) > 1e-3 || fabs(dot(axis[0], axis[2])) > 1e-3
        || fabs(dot(axis[1], axis[2])) > 1e-3)
        return -1;
    /* OpenEXR's camera space is left-handed and looks along +Z; some renderers write the
     * right-handed one that looks along -Z. Both have x right and y up, so the third axis
     * follows from them. */
    store_rotation(rotation, axis[0], axis[1], cross(axis[0], axis[1]));
    return 0;
}

/* x = scale_x right + centre_x, likewise y: a projection once the direction of view is
 * known. */
typedef struct ndc_mapping {
    double scale_x, scale_y, centre_x, centre_y;
    bool y_up;
} ndc_mapping;

static int finish(const ndc_mapping *n, bool is_signed, int32_t width, int32_t height,
                  crv_camera *camera)
{
    const double half = is_signed ? 0.5 : 1.0, shift = is_signed ? 0.5 : 0.0;
    const double centre_x = n->centre_x * half + shift;
    double centre_y = n->centre_y * half + shift;
    if (n->y_up)
        centre_y = 1.0 - centre_y;
    camera->fx_px = (float)(n->scale_x * half * width);
    camera->fy_px = (float)(n->scale_y * half * height);
    camera->cx_px = (float)(centre_x * width);
    camera->cy_px = (float)(centre_y * height);
    return isfinite(camera->fx_px) && isfinite(camera->fy_px) && isfinite(camera->cx_px)
                   && isfinite(camera->cy_px) && camera->fx_px > 0.0f
                   && camera->fy_px > 0.0f
               ? 0
               : -1;
}

/* The range that the mapping has in all likelihood. OpenEXR's own is 0 to 1 with y down;
 * a matrix with y up is one of clip coordinates, -1 to 1, unless its centre lies exactly
 * in the middle of the other range. */
static bool looks_signed(const ndc_mapping *n, bool has_centre)
{
    const bool in_middle =
        has_centre && fabs(n->centre_x - 0.5) < 1e-4 && fabs(n->centre_y - 0.5) < 1e-4;
    return n->y_up && !in_middle;
}

/* What worldToCamera says is up; 0 if it says nothing. Its y is up in every convention,
 * where the third axis may point either way. */
static bool find_up(const io_camera_metadata *metadata, vec3 *up)
{
    double length;
    return metadata->has_world_to_camera
           && split(column(metadata->world_to_camera, 1), &length, up);
}

/* Both readings of a mapping, the likelier first. */
static int finish_both(const ndc_mapping *n, bool has_centre, crv_camera *camera,
                       int32_t width, int32_t height, vec3 rows[3], io__ndc_camera out[2])
{
    const bool first = looks_signed(n, has_centre);
    int count = 0;
    for (int i = 0; i < 2; i++) {
        io__ndc_camera *made = &out[count];
        made->is_signed = i == 0 ? first : !first;
        if (finish(n, made->is_signed, width, height, camera))
            continue;
        made->camera = *camera;
        const double m[9] = {rows[0].x, rows[0].y, rows[0].z, rows[1].x, rows[1].y,
                             rows[1].z, rows[2].x, rows[2].y, rows[2].z};
        memcpy(made->to_view, m, sizeof made->to_view);
        count++;
    }
    return count;
}

static int perspective(const io_camera_metadata *metadata, int32_t width, int32_t height,
                       io__ndc_camera out[2])
{
    const float *m = metadata->world_to_ndc;
    crv_camera camera = {.projection = CRV_PERSPECTIVE};
    ndc_mapping n;
    double length;
    vec3 forward, right, image_y, known;
    if (!split(column(m, 3), &length, &forward))
        return 0;
    const vec3 x = scaled(column(m, 0), 1.0 / length);
    const vec3 y = scaled(column(m, 1), 1.0 / length);
    n.centre_x = dot(x, forward);
    n.centre_y = dot(y, forward);
    if (!split(minus(x, scaled(forward, n.centre_x)), &n.scale_x, &right)
        || !split(minus(y, scaled(forward, n.centre_y)), &n.scale_y, &image_y)
        || fabs(dot(right, image_y)) > 1e-3)
        return 0;
    /* Of a right-handed world, unless worldToCamera knows better. */
    vec3 up = cross(right, forward);
    if (find_up(metadata, &known) && dot(known, up) < -0.9)
        up = scaled(up, -1.0);
    n.y_up = dot(image_y, up) > 0.0;
    vec3 rows[3] = {right, up, scaled(forward, -1.0)};
    return finish_both(&n, true, &camera, width, height, rows, out);
}

static int orthographic(const io_camera_metadata *metadata, int32_t width, int32_t height,
                        io__ndc_camera out[2])
{
    const float *m = metadata->world_to_ndc;
    crv_camera camera = {.projection = CRV_ORTHOGRAPHIC};
    const double w = (double)m[15];
    double length;
    vec3 right, image_y, forward, known;
    ndc_mapping n = {.scale_x = 0.0};
    if (!isfinite(w) || w == 0.0
        || !split(scaled(column(m, 0), 1.0 / w), &n.scale_x, &right)
        || !split(scaled(column(m, 1), 1.0 / w), &n.scale_y, &image_y)
        || fabs(dot(right, image_y)) > 1e-3)
        return 0;
    /* z of NDC grows with the distance, so that it tells where the view goes. */
    vec3 up = scaled(image_y, -1.0);
    if (find_up(metadata, &known))
        up = dot(known, image_y) > 0.0 ? image_y : up;
    else if (split(scaled(column(m, 2), 1.0 / w), &length, &forward))
        up = dot(cross(right, forward), image_y) > 0.0 ? image_y : up;
    n.y_up = dot(image_y, up) > 0.0;
    vec3 rows[3] = {right, up, cross(right, up)};
    const int count = finish_both(&n, false, &camera, width, height, rows, out);
    /* Positions may be shifted as a whole without changing the result, so that the
     * principal point is free. */
    for (int i = 0; i < count; i++) {
        out[i].camera.cx_px = 0.5f * (float)width;
        out[i].camera.cy_px = 0.5f * (float)height;
    }
    return count;
}

bool io__is_identity(const float m[16])
{
    for (int i = 0; i < 16; i++)
        if (fabsf(m[i] - (i % 5 == 0 ? 1.0f : 0.0f)) > 1e-6f)
            return false;
    return true;
}

int io__cameras_from_ndc(const io_camera_metadata *metadata, int32_t display_width,
                         int32_t display_height, io__ndc_camera out[2])
{
    const float *m = metadata->world_to_ndc;
    if (!metadata->has_world_to_ndc || io__is_identity(m))
        return 0;
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return 0;
    const vec3 w = column(m, 3);
    const vec3 x = column(m, 0);
    const bool parallel = dot(w, w) <= 1e-12 * dot(x, x);
    return parallel ? orthographic(metadata, display_width, display_height, out)
                    : perspective(metadata, display_width, display_height, out);
}
