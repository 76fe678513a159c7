/* SPDX-License-Identifier: MIT */
/* Cameras and depth formats of projection matrices, as engines hand them over. */
#include "core/camera.h"

#include "base/log.h"
#include "crevice/gbuffer.h"

#include <math.h>

/*
 * clip = M view with M(row, column). The rows of x, y and w must be
 *
 *     | a 0 c e |                       | a 0 0 e |
 *     | 0 b d f |       perspective     | 0 b 0 f |      orthographic
 *     | 0 0 s 0 |       (e, f = 0)      | 0 0 0 s |
 *
 * s < 0 looks along -Z (right-handed), s > 0 along +Z (left-handed): then z = d, and x
 * and y are the same.
 */
typedef struct projection {
    double m[4][4];
    bool is_perspective;
    double scale; /* |s| */
    double side;  /* z = side * d; orthographic: unknown, 0 */
} projection;

static bool is_about_one(double value)
{
    return fabs(fabs(value) - 1) < 1e-3;
}

/* Whether the matrix with rows and columns exchanged would be a perspective. */
static bool is_transposed(const projection *p)
{
    return p->m[3][3] == 0 && is_about_one(p->m[2][3]) && !is_about_one(p->m[3][2]);
}

static crv_status refuse(const crv_logger *logger, const char *why)
{
    return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT, "projection: %s", why);
}

static crv_status read_projection(projection *p, const float m[16],
                                  crv_matrix_layout layout, const crv_logger *logger)
{
    if (!m || (layout != CRV_MATRIX_COLUMN_MAJOR && layout != CRV_MATRIX_ROW_MAJOR))
        return refuse(logger, "the matrix is NULL, or its layout is not one of "
                              "crv_matrix_layout");
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 4; column++) {
            const float value =
                m[layout == CRV_MATRIX_ROW_MAJOR ? 4 * row + column : 4 * column + row];
            if (!isfinite(value))
                return refuse(logger, "the matrix has numbers that are not finite");
            p->m[row][column] = (double)value;
        }
    }
    const double s = p->m[3][2], one = p->m[3][3];
    if (is_transposed(p) || (s != 0 && one != 0) || p->m[3][0] != 0 || p->m[3][1] != 0)
        return refuse(logger,
                      "neither perspective nor orthographic in this layout; if rows and "
                      "columns are exchanged, give the other crv_matrix_layout");
    p->is_perspective = one == 0;
    p->scale = p->is_perspective ? fabs(s) : one;
    p->side = p->is_perspective ? (s < 0 ? -1 : 1) : 0;
    if (!(p->scale > 0))
        return refuse(logger, "w is zero or negative for every point");
    if (p->m[0][1] != 0 || p->m[1][0] != 0)
        return refuse(logger,
                      "the image is sheared or turned; give the projection alone, "
                      "without the view matrix");
    if (!(p->m[0][0] > 0) || p->m[1][1] == 0)
        return refuse(logger,
                      "x is mirrored or nothing is seen; the first number must be "
                      "positive");
    return CRV_OK;
}

crv_status crv_camera_from_projection(crv_camera *out, const float m[16],
                                      crv_matrix_layout layout, int32_t width,
                                      int32_t height, const crv_logger *logger)
{
    if (!out || width < 1 || height < 1 || width > CRV_MAX_SIZE || height > CRV_MAX_SIZE)
        return refuse(logger, "out is NULL, or width or height is out of range");
    projection p;
    const crv_status status = read_projection(&p, m, layout, logger);
    if (status)
        return status;
    const double w = p.scale;
    const double up = p.m[1][1] > 0 ? 1 : -1; /* clip-space y points up or down */
    const double shift_x = p.is_perspective ? p.side * p.m[0][2] / w : p.m[0][3] / w;
    const double shift_y = p.is_perspective ? p.side * p.m[1][2] / w : p.m[1][3] / w;
    crv_camera camera = crv_camera_orthographic(width, height, 1);
    camera.projection = p.is_perspective ? CRV_PERSPECTIVE : CRV_ORTHOGRAPHIC;
    camera.fx_px = (float)(p.m[0][0] / w * 0.5 * width);
    camera.fy_px = (float)(p.m[1][1] * up / w * 0.5 * height);
    camera.cx_px = (float)((1 + shift_x) * 0.5 * width);
    camera.cy_px = (float)((1 - shift_y * up) * 0.5 * height);
    const crv_status checked = crv__camera_check(logger, &camera); /* floats overflow */
    if (checked == CRV_OK)
        *out = camera;
    return checked;
}

/* The planar depths at which the buffer holds 0 and 1. Perspective: v = a + b / d;
 * orthographic: v = a + b d. */
static void depths_at_ends(const projection *p, crv_clip_depth range, double at[2])
{
    const double half = range == CRV_CLIP_MINUS_ONE_TO_ONE ? 0.5 : 1;
    const double shift = range == CRV_CLIP_MINUS_ONE_TO_ONE ? 0.5 : 0;
    if (p->is_perspective) {
        const double a = half * p->m[2][2] * p->side / p->scale + shift;
        const double b = half * p->m[2][3] / p->scale;
        for (int end = 0; end < 2; end++) {
            const double inverse = (end - a) / b;
            at[end] = inverse > 1.2e-7 * fabs(1 / b) ? 1 / inverse : (double)INFINITY;
        }
        return;
    }
    const double a = half * p->m[2][3] / p->scale + shift;
    const double b = -half * p->m[2][2] / p->scale; /* right-handed: z = -d */
    at[0] = -a / b;
    at[1] = (1 - a) / b;
    if (at[0] <= 0 && at[1] <= 0) { /* all behind the eye: left-handed */
        at[0] = -at[0];
        at[1] = -at[1];
    }
}

crv_status crv_depth_format_from_projection(crv_depth_format *out, const float m[16],
                                            crv_matrix_layout layout,
                                            crv_clip_depth range,
                                            const crv_logger *logger)
{
    if (!out || (range != CRV_CLIP_ZERO_TO_ONE && range != CRV_CLIP_MINUS_ONE_TO_ONE))
        return refuse(logger, "out is NULL, or the range is not one of crv_clip_depth");
    projection p;
    const crv_status status = read_projection(&p, m, layout, logger);
    if (status)
        return status;
    if (p.m[2][0] != 0 || p.m[2][1] != 0)
        return refuse(logger, "the near plane is oblique, so that depth cannot be told "
                              "from the buffer; give planar depth");
    double at[2];
    depths_at_ends(&p, range, at);
    const bool reversed = at[1] < at[0];
    const float z_near = (float)(reversed ? at[1] : at[0]);
    const float z_far = (float)(reversed ? at[0] : at[1]);
    if (!isfinite(z_near) || (p.is_perspective && !(z_near > 0)) || !(z_far > z_near))
        return refuse(logger, "the row of z maps no near plane before a far one; is the "
                              "range of clip-space z right?");
    *out =
        (crv_depth_format){.encoding = reversed ? CRV_DEPTH_REVERSED : CRV_DEPTH_HARDWARE,
                           .z_near = z_near,
                           .z_far = z_far,
                           .background = INFINITY};
    return CRV_OK;
}
