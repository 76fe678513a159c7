/* SPDX-License-Identifier: MIT */
/*
 * Fields: characteristic functions beside the depth buffer (2010, Figure 2). A field's
 * value is >= 0 outside and on the surface, < 0 inside, and its gradient tells how far
 * the surface is.
 */
#ifndef CRV_CORE_FIELD_H
#define CRV_CORE_FIELD_H

#include "core/frame.h"

typedef struct crv__field {
    crv_implicit_fn implicit; /* NULL: a height field */
    void *user;
    /* The height field: per-pixel texture coordinates (NaN: none there), tangent frame,
     * the shading normal of the relief, and the map. */
    crv__plane uv[2], tangent[3], bitangent[3], relief_normal[3], height;
    float scale; /* scene units for a height of 1 */
    crv_wrap wrap;
} crv__field;

/* Bilinear height in scene units at texture coordinates (u right, v down, texel centres
 * at half-integers over the map's size), and its derivatives by u and v. */
float crv__height_at(const crv__field *field, float u, float v, float *by_u, float *by_v);

/* The point that is shaded, as the field sees it. */
typedef struct crv__local_frame {
    int valid;                /* the pixel has texture coordinates */
    float u, v, height;       /* there */
    crv__vec3 normal;         /* of the macro surface, facing the camera */
    crv__vec3 dual_u, dual_v; /* du = dual_u . offset, dv = dual_v . offset */
} crv__local_frame;

crv__local_frame crv__local_frame_at(const crv__field *field, crv__vec3 facing, int32_t x,
                                     int32_t y);

/* The field's value at p, in scene units (implicit: in its own), and its gradient. P is
 * the shaded point, whose local frame is `local`. A pixel without a frame is outside. */
float crv__field_value(const crv__field *field, const crv__local_frame *local,
                       crv__vec3 P, crv__vec3 p, crv__vec3 *gradient);

#endif
