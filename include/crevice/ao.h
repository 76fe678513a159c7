/* SPDX-License-Identifier: MIT */
/*
 * ao.h: the short way, one call from depth to accessibility. For one picture; a host that
 * computes many keeps a context, a G-buffer and a plan (context.h), which costs less.
 */
#ifndef CREVICE_AO_H
#define CREVICE_AO_H

#include "gbuffer.h"
#include "options.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Computes the accessibility of every pixel on the CPU: 1 is open, 0 fully occluded,
 * background is 1.
 *
 * depth: one channel, planar, scene units; for other encodings see crv_depth_convert().
 * normals: three channels, view space, of the same size; NULL: reconstructed from depth.
 * camera: camera.h; not NULL. options: NULL for the defaults of bitmask, whose radius of
 * 1 scene unit seldom fits: choose about a tenth of the largest thing in view. result:
 * one channel, of the same size. logger: gets the reason for a failure, and warnings;
 * NULL: nobody.
 *
 * Takes and gives back about 48 bytes a pixel. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY.
 * Thread-safe.
 */
CRV_API crv_status crv_ao(const crv_const_image *depth, const crv_const_image *normals,
                          const crv_camera *camera, const crv_options *options,
                          const crv_image *result, const crv_logger *logger);

/*
 * Width of the guard band, in px on each side, with which the border of the result is as
 * good as its middle. A guard band is a margin of the G-buffer that occludes but gets no
 * result (crv_gbuffer_desc). nearest_depth: the least planar depth in view, scene units,
 * > 0; not read for an orthographic camera. The width is that of the radius, projected at
 * nearest_depth, and of the filter; options->max_radius_px limits the first if the method
 * reads it. At most CRV_MAX_SIZE. 0 if an argument is NULL or not valid. Thread-safe.
 */
CRV_API int32_t crv_guard_px(const crv_options *options, const crv_camera *camera,
                             float nearest_depth);

#ifdef __cplusplus
}
#endif
#endif
