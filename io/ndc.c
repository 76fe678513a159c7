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

/* x = scale * right + centre, likewise y: what a projection comes to once the direction
 * of view is known. */
typedef struct ndc_mapping {
    double scale_x, scale_y, centre_x, centre_y;
    bool y_up, signed_range; /* -1 to 1 */
} ndc_mapping;

static int finish(const ndc_mapping *n, int32_t width, int32_t height, crv_camera *camera)
{
    const double half = n->signed_range ? 0.5 : 1.0;
    const double shift = n->signed_range ? 0.5 : 0.0;
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

static int perspective(const float m[16], int32_t width, int32_t height,
                       crv_camera *camera)
{
    ndc_mapping n;
    double length;
    vec3 forward, right, image_y;
    if (!split(column(m, 3), &length, &forward))
        return -1;
    const vec3 x = scaled(column(m, 0), 1.0 / length);
    const vec3 y = scaled(column(m, 1), 1.0 / length);
    n.centre_x = dot(x, forward);
    n.centre_y = dot(y, forward);
    if (!split(minus(x, scaled(forward, n.centre_x)), &n.scale_x, &right)
        || !split(minus(y, scaled(forward, n.centre_y)), &n.scale_y, &image_y)
        || fabs(dot(right, image_y)) > 1e-3)
        return -1;
    const vec3 up = cross(right, forward);
    n.y_up = dot(image_y, up) > 0.0;
    /* The picture's centre has 0.5 in a range from 0 to 1, and 0 in one from -1 to 1. */
    n.signed_range = fabs(n.centre_x) < 0.25 && fabs(n.centre_y) < 0.25;
    camera->projection = CRV_PERSPECTIVE;
    store_rotation(camera->world_to_view, right, up, scaled(forward, -1.0));
    return finish(&n, width, height, camera);
}

static int orthographic(const io_camera_metadata *metadata, int32_t width, int32_t height,
                        crv_camera *camera)
{
    const float *m = metadata->world_to_ndc;
    const double w = (double)m[15];
    float rotation[9];
    vec3 right, image_y;
    /* Positions may be shifted as a whole without changing the result, so that the
     * principal point is free. */
    ndc_mapping n = {.centre_x = 0.5, .centre_y = 0.5};
    if (!isfinite(w) || w == 0.0
        || !split(scaled(column(m, 0), 1.0 / w), &n.scale_x, &right)
        || !split(scaled(column(m, 1), 1.0 / w), &n.scale_y, &image_y)
        || fabs(dot(right, image_y)) > 1e-3)
        return -1;
    if (metadata->has_world_to_camera
        && !io__rotation_from_world_to_camera(metadata->world_to_camera, rotation)) {
        const vec3 known = {(double)rotation[3], (double)rotation[4],
                            (double)rotation[5]};
        n.y_up = dot(known, image_y) > 0.0;
    }
    const vec3 up = n.y_up ? image_y : scaled(image_y, -1.0);
    camera->projection = CRV_ORTHOGRAPHIC;
    store_rotation(camera->world_to_view, right, up, cross(right, up));
    return finish(&n, width, height, camera);
}

int io__camera_from_ndc(const io_camera_metadata *metadata, int32_t display_width,
                        int32_t display_height, crv_camera *camera)
{
    const float *m = metadata->world_to_ndc;
    crv_camera made;
    memset(&made, 0, sizeof made);
    if (!metadata->has_world_to_ndc)
        return -1;
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return -1;
    const vec3 w = column(m, 3);
    const vec3 x = column(m, 0);
    const bool parallel = dot(w, w) <= 1e-12 * dot(x, x);
    const int result = parallel
                           ? orthographic(metadata, display_width, display_height, &made)
                           : perspective(m, display_width, display_height, &made);
    if (!result)
        *camera = made;
    return result;
}
