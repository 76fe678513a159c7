/* SPDX-License-Identifier: MIT */
/* vulkan_scene.h: spheres as a renderer of the host's would store them, in any formats
 * and encodings, and the scalar code's picture of what is stored. */
#ifndef TESTS_VULKAN_SCENE_H
#define TESTS_VULKAN_SCENE_H

#include "vulkan_engine.h"
#include "vulkan_texels.h"

/* Of such a size that one texel, taken for its neighbour at a silhouette and spread by a
 * filter over a dozen pixels, is no large share. */
enum { SCENE_WIDTH = 240, SCENE_HEIGHT = 180, SCENE_PIXELS = SCENE_WIDTH * SCENE_HEIGHT };

/* Error lines of a log. */
typedef struct scene_lines {
    int errors;
    char last[512];
} scene_lines;

void scene_keep_line(void *user, crv_log_level level, const char *line);

/* A context on the engine's device with that log. */
crv_context *scene_context(const engine *e, scene_lines *log);

/* What the host stores, and what is made of it. */
typedef struct scene_encoding {
    const char *name;
    VkFormat depth_format;
    crv_depth_encoding depth;
    VkFormat normal_format;
    crv_vulkan_normals normals;
    crv_normal_space space;
    VkFormat result_format;
    const char *method, *filter; /* filter NULL: none */
} scene_encoding;

typedef struct scene {
    crv_camera camera;
    crv_gbuffer_desc desc;
    float depth[SCENE_PIXELS], normals[3 * SCENE_PIXELS]; /* as stored, decoded */
    unsigned char depth_bytes[16 * SCENE_PIXELS], normal_bytes[16 * SCENE_PIXELS];
} scene;

/* With a guard band, at an odd origin. */
void scene_make(scene *s, const scene_encoding *e, double scale);
/* Without, of another size up to that of scene_make(). */
void scene_make_sized(scene *s, const scene_encoding *e, double scale, int width,
                      int height);
crv_options scene_options(const scene_encoding *e);
crv_vulkan_pass_desc scene_pass_desc(const scene_encoding *e);

/* The picture, which the caller frees: of a plan on a context, and of the scalar code. */
float *scene_planned(crv_context *context, const scene *s, const scene_encoding *e);
float *scene_scalar(const scene *s, const scene_encoding *e);
/* The same of other options, with bent normals, three floats for each pixel. */
float *scene_scalar_bent(const scene *s, const scene_encoding *e, crv_options options,
                         float *bent);

/* The vector of two octahedral numbers, of any length. */
void scene_unfold(const double e[2], double n[3]);

typedef struct scene_images {
    host_image depth, normals, result;
} scene_images;

scene_images scene_upload(engine *g, const scene *s, const scene_encoding *e);
void scene_free(engine *g, scene_images *i);
crv_vulkan_frame scene_frame(const scene *s, const scene_encoding *e,
                             const scene_images *i);
/* The result's first component, which the caller frees. */
float *scene_download(engine *g, const scene *s, const scene_encoding *e,
                      const scene_images *i);
void scene_assert_agrees(const scene *s, const scene_encoding *e, const float *got,
                         const float *wanted);

/* Whether optimal images of the format have the feature. */
int scene_has_format(const engine *g, VkFormat format, VkFormatFeatureFlags feature);

#endif
