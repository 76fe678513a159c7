/* SPDX-License-Identifier: MIT */
/*
 * camera.h: how pixels map to view space.
 *
 * View space is right-handed with the camera at the origin, looking down -Z, +X to the
 * right and +Y up. d is planar depth, d = -z > 0. The centre of pixel (i, j), row 0 on
 * top, is at (i + 0.5, j + 0.5). Then
 *
 *     perspective    x =  (i + 0.5 - cx) / fx * d
 *                    y = -(j + 0.5 - cy) / fy * d
 *                    z = -d
 *
 *     orthographic   x =  (i + 0.5 - cx) / fx
 *                    y = -(j + 0.5 - cy) / fy
 *                    z = -d
 */
#ifndef CREVICE_CAMERA_H
#define CREVICE_CAMERA_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum crv_projection { CRV_PERSPECTIVE = 0, CRV_ORTHOGRAPHIC = 1 } crv_projection;

/* A plain value; copy it freely. Pixels are those of the G-buffer, guard band included.
 */
typedef struct crv_camera {
    crv_projection projection;
    /* Focal length in pixels (perspective), or pixels per scene unit (orthographic); > 0.
     * The two differ where pixels are not square. */
    float fx_px, fy_px;
    float cx_px; /* principal point, from the left edge; may lie outside the image */
    float cy_px; /* principal point, from the top edge */
    /* Rotation from world to view space, row-major: view = M * world. Read only for
     * normals given in world space. The identity by default. */
    float world_to_view[9];
} crv_camera;

/* A perspective camera with square pixels and a centred principal point. vfov_rad is the
 * full vertical field of view, in (0, pi). Checks nothing; crv_gbuffer_set_camera() does.
 * Thread-safe. */
CRV_API crv_camera crv_camera_perspective(int32_t width, int32_t height, float vfov_rad);

/* An orthographic camera with square pixels and a centred view that is view_height scene
 * units high (> 0). Thread-safe. */
CRV_API crv_camera crv_camera_orthographic(int32_t width, int32_t height,
                                           float view_height);

/*
 * The camera of a projection matrix as graphics APIs use it: column-major, clip = M *
 * view, view space as above, perspective or orthographic, off-centre too. Clip-space y up
 * (OpenGL, Direct3D) or down (Vulkan without flip) is recognised by the sign of M[5]. How
 * the matrix maps z does not matter here; say it in crv_depth_format. world_to_view is
 * set to the identity. Returns CRV_ERROR_INVALID_ARGUMENT where out or m is NULL, a size
 * is out of range or the matrix is neither kind of projection. Thread-safe.
 */
CRV_API crv_status crv_camera_from_projection(crv_camera *out, const float m[16],
                                              int32_t width, int32_t height);

/* Sets world_to_view for a camera at eye that looks at target, `up` pointing upwards in
 * the image. CRV_ERROR_INVALID_ARGUMENT where eye equals target or up is parallel to the
 * view. Thread-safe. */
CRV_API crv_status crv_camera_look_at(crv_camera *camera, const float eye[3],
                                      const float target[3], const float up[3]);

/* The camera of the part of an image whose top left pixel is (x, y): moves the principal
 * point. Negative x, y widen the image: a guard band of g pixels is crv_camera_crop(c,
 * -g, -g). Thread-safe. */
CRV_API crv_camera crv_camera_crop(const crv_camera *camera, int32_t x, int32_t y);

#ifdef __cplusplus
}
#endif
#endif
