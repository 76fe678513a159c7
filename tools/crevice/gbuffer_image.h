/* SPDX-License-Identifier: MIT */
/* gbuffer_image.h: what pictures say of the G-buffer that they were made from. */
#ifndef TOOL_GBUFFER_IMAGE_H
#define TOOL_GBUFFER_IMAGE_H

#include "io.h"
#include "scene.h"

/* Sets the camera metadata; the image's display window is the picture without the guard
 * band. */
void gbuffer_describe_camera(const scene_gbuffer *g, io_image *image);

/* View-space vectors, packed, in world space: a plane for each component. */
void gbuffer_to_world(const scene_gbuffer *g, const float *vectors, size_t count,
                      float *const out[3]);

/* Normals in world space, guard band included, a plane for each component. */
void gbuffer_world_normals(const scene_gbuffer *g, float *const out[3]);

/* Channels Z, layer2.Z or solid2.Z and so on, and N.X N.Y N.Z in world space, with the
 * camera. 0, or -1 after an error line; the caller frees the image. */
int gbuffer_make_image(const scene_gbuffer *g, io_image *image, const crv_logger *log);

#endif
