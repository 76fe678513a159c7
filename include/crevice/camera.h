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

/* A plain value; copy it freely. Pixels are those of the G-buffer, guard band
 * included. */
typedef struct crv_camera {
    crv_projection projection;
    /* Perspective: focal length in pixels. Orthographic: pixels per scene unit. > 0. fx
     * and fy differ if pixels are not square. */
    float fx_px, fy_px;
    float cx_px; /* principal point, from the left edge; may lie outside the image */
    float cy_px; /* principal point, from the top edge */
    /* World to view space, row-major: view = M * world. A rotation or, for a left-handed
     * world, a reflection. Read only for normals given in world space. Default: the
     * identity. */
    float world_to_view[9];
} crv_camera;

/* A perspective camera with square pixels and a centred principal point. vfov_rad: the
 * full vertical field of view in radians, above 0 and below pi. Checks nothing;
 * crv_gbuffer_set_camera() refuses a field of view that is out of range. Thread-safe. */
CRV_API crv_camera crv_camera_perspective(int32_t width, int32_t height, float vfov_rad);

/* An orthographic camera with square pixels and a centred view that is view_height scene
 * units high (> 0). Checks nothing, as above. Thread-safe. */
CRV_API crv_camera crv_camera_orthographic(int32_t width, int32_t height,
                                           float view_height);

/* How the 16 numbers of a matrix lie in memory. */
typedef enum crv_matrix_layout {
    /* clip = M * view, stored column after column: OpenGL, GLM, Unity. Memory is the same
     * for clip = view * M (row vectors), stored row after row: DirectXMath, Unreal. */
    CRV_MATRIX_COLUMN_MAJOR = 0,
    /* clip = M * view, stored row after row: mathematical notation, numpy, Blender. */
    CRV_MATRIX_ROW_MAJOR = 1
} crv_matrix_layout;

/*
 * Sets *out to the camera of a projection matrix: perspective or orthographic,
 * off-centre, tiled or jittered, right-handed (looks along -Z) or left-handed (along +Z),
 * with any mapping of z, reversed included. An upright image is assumed: the sign of
 * M(1,1) tells whether clip-space y points up (OpenGL, Direct3D, Metal) or down (Vulkan).
 * world_to_view is set to the identity. width, height: of the image, px, 1 to 32768
 * (CRV_MAX_SIZE).
 *
 * Normals in the view space of a left-handed engine point along +Z away from the camera:
 * negate their z before they are given as CRV_NORMAL_VIEW, or give world-space normals
 * and a world_to_view whose last row is negated.
 *
 * logger: gets the reason for a failure; NULL: nobody. Errors: INVALID_ARGUMENT if out or
 * m is NULL, a size is out of range, or the matrix is no such projection. If the layout
 * seems to be the other one, the logged line says so. Thread-safe.
 */
CRV_API crv_status crv_camera_from_projection(crv_camera *out, const float m[16],
                                              crv_matrix_layout layout, int32_t width,
                                              int32_t height, const crv_logger *logger);

/* Sets world_to_view for a camera at eye that looks at target. up is the direction in
 * world space that points upwards in the image. Errors: INVALID_ARGUMENT if an argument
 * is NULL or not finite, eye equals target, or up is parallel to the view.
 * Thread-safe. */
CRV_API crv_status crv_camera_look_at(crv_camera *camera, const float eye[3],
                                      const float target[3], const float up[3]);

/* The camera of the part of an image whose top left pixel is (x, y): moves the principal
 * point. Negative x and y widen the image: for a guard band of g pixels use
 * crv_camera_crop(c, -g, -g). For NULL it returns a camera that every call refuses.
 * Thread-safe. */
CRV_API crv_camera crv_camera_crop(const crv_camera *camera, int32_t x, int32_t y);

#ifdef __cplusplus
}
#endif
#endif
