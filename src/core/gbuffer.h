/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_GBUFFER_H
#define CRV_CORE_GBUFFER_H

#include "core/context.h"
#include "core/conversions.h"
#include "core/field.h"
#include "core/image.h"
#include "crevice/gbuffer.h"
#include "shared/params.h"

struct crv_gbuffer {
    crv_context *context;
    crv_gbuffer_desc desc;
    crv_camera camera;
    int32_t has_camera;
    uint32_t has_depth;    /* bit per layer */
    int32_t has_normals;   /* normal[] holds what the host gave, turned to view space */
    int32_t normals_ready; /* normal[] holds what estimators read */
    crv__plane depth[CRV_MAX_LAYERS];
    crv__plane normal[3];
    int32_t has_field;
    bool depth_doubted;   /* a warning of depth that cannot be right was logged */
    int32_t relief_ready; /* field.relief_normal[] belongs to field and normal[] */
    crv__field field;     /* its planes live as long as the G-buffer */
};

/* format NULL: planar. INVALID_ARGUMENT with a line where it makes no sense. */
crv_status crv__depth_map_init(crv__depth_map *map, const crv_logger *logger,
                               const crv_camera *camera, const crv_depth_format *format);

/* Planar depth of the value v at pixel (x, y) of the buffers; background INFINITY. */
float crv__depth_map_apply(const crv__depth_map *map, int32_t x, int32_t y, float v);

/* Copies the host's description, of this or an earlier size. INVALID_ARGUMENT with a line
 * unless the sizes make sense. */
crv_status crv__gbuffer_desc_take(const crv_logger *logger, const crv_gbuffer_desc *from,
                                  crv_gbuffer_desc *desc);

/* NOT_READY with a line that begins with `what` where the G-buffer has no camera yet. */
crv_status crv__gbuffer_need_camera(const crv_gbuffer *gbuffer, const char *what);

/* NOT_READY with a line where camera or depth are missing; else makes normals[] ready. */
crv_status crv__gbuffer_prepare(crv_gbuffer *gbuffer);

/* The host's pixels (texels.c): floats as such, a row, and a number of it. */
crv_texels crv__texels_of(const crv_const_image *image);
crv__texel_row crv__texels_row(const crv_texels *texels, int32_t y);
float crv__texel_at(const crv__texel_row *row, int32_t x, int32_t channel);

/* INVALID_ARGUMENT with a line that begins with `what` unless the texels have this size
 * and number of channels. */
crv_status crv__texels_check(const crv_logger *logger, const char *what,
                             const crv_texels *texels, int32_t width, int32_t height,
                             int32_t channels);

/* Fills the members of params that describe buffers and camera. */
void crv__camera_params(const crv_gbuffer_desc *desc, const crv_camera *camera,
                        crv__params *params);
void crv__gbuffer_params(const crv_gbuffer *gbuffer, crv__params *params);

/* Makes the relief's normals from the frame's final ones; frees the field's planes
 * (height_field.c). */
void crv__height_field_finish(crv_gbuffer *gbuffer);
void crv__height_field_release(crv_gbuffer *gbuffer);

/* The specification of crv__conversions: depth_row (depth.c), rotated_row and normals_row
 * (normals.c). */
void crv__depth_row(const crv__depth_map *map, const crv__texel_row *from, int32_t y,
                    int32_t count, float *out);
void crv__rotated_row(const float rotation[9], const crv__texel_row *from, int32_t count,
                      float *const out[3]);
void crv__normals_row(const crv__params *params, const crv__plane *depth,
                      const crv__plane *normal, int32_t has_normals, int32_t y);

#endif
