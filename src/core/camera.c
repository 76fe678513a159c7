/* SPDX-License-Identifier: MIT */
#include "core/camera.h"

#include "base/log.h"
#include "crevice/image.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const float IDENTITY[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static crv_camera centred(crv_projection projection, int32_t width, int32_t height,
                          double f)
{
    crv_camera camera = {.projection = projection,
                         .fx_px = (float)f,
                         .fy_px = (float)f,
                         .cx_px = (float)width * 0.5f,
                         .cy_px = (float)height * 0.5f};
    memcpy(camera.world_to_view, IDENTITY, sizeof IDENTITY);
    return camera;
}

crv_camera crv_camera_perspective(int32_t width, int32_t height, float vfov_rad)
{
    const double vfov = (double)vfov_rad;
    const bool is_angle = vfov > 0 && vfov < 3.14159;
    return centred(CRV_PERSPECTIVE, width, height,
                   is_angle ? 0.5 * height / tan(0.5 * vfov) : (double)NAN);
}

crv_camera crv_camera_orthographic(int32_t width, int32_t height, float view_height)
{
    return centred(CRV_ORTHOGRAPHIC, width, height, height / (double)view_height);
}

static double normalize(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return length;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

crv_status crv_camera_look_at(crv_camera *camera, const float eye[3],
                              const float target[3], const float up[3])
{
    if (!camera || !eye || !target || !up)
        return CRV_ERROR_INVALID_ARGUMENT;
    double back[3], upward[3], right[3];
    for (int i = 0; i < 3; i++) {
        back[i] = (double)eye[i] - target[i];
        upward[i] = up[i];
    }
    /* Written so that NaN fails too. */
    if (!(normalize(back) > 0) || !(normalize(upward) > 0))
        return CRV_ERROR_INVALID_ARGUMENT;
    cross(upward, back, right);
    if (!(normalize(right) > 1e-6))
        return CRV_ERROR_INVALID_ARGUMENT;
    cross(back, right, upward);
    for (int i = 0; i < 3; i++) {
        camera->world_to_view[i] = (float)right[i];
        camera->world_to_view[3 + i] = (float)upward[i];
        camera->world_to_view[6 + i] = (float)back[i];
    }
    return CRV_OK;
}

crv_camera crv_camera_crop(const crv_camera *camera, int32_t x, int32_t y)
{
    crv_camera cropped = {.projection = CRV_PERSPECTIVE};
    if (camera)
        cropped = *camera;
    cropped.cx_px -= (float)x;
    cropped.cy_px -= (float)y;
    return cropped;
}

/* Reflections included: normals of left-handed worlds are turned by one. */
static bool is_orthonormal(const float m[9])
{
    const float tolerance = 1e-3f;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j <= i; j++) {
            float dot = 0;
            for (int k = 0; k < 3; k++)
                dot += m[3 * i + k] * m[3 * j + k];
            if (!(fabsf(dot - (i == j ? 1.0f : 0.0f)) <= tolerance))
                return false;
        }
    }
    return true;
}

crv_status crv__camera_check(const crv_logger *logger, const crv_camera *camera)
{
    if (!camera)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT, "camera: NULL");
    if (camera->projection != CRV_PERSPECTIVE && camera->projection != CRV_ORTHOGRAPHIC)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "camera: projection %d is neither perspective nor orthographic",
                         (int)camera->projection);
    if (!(camera->fx_px > 0) || !(camera->fy_px > 0) || !isfinite(camera->fx_px)
        || !isfinite(camera->fy_px) || !isfinite(camera->cx_px)
        || !isfinite(camera->cy_px))
        return crv__fail(
            logger, CRV_ERROR_INVALID_ARGUMENT,
            "camera: fx %g, fy %g, cx %g, cy %g px; fx and fy must be positive and "
            "all finite (a field of view is in radians, between 0 and pi: degrees times "
            "0.01745)",
            (double)camera->fx_px, (double)camera->fy_px, (double)camera->cx_px,
            (double)camera->cy_px);
    if (!is_orthonormal(camera->world_to_view))
        return crv__fail(
            logger, CRV_ERROR_INVALID_ARGUMENT,
            "camera: world_to_view is neither a rotation nor a reflection; for the "
            "identity begin with crv_camera_perspective()");
    return CRV_OK;
}
