/* SPDX-License-Identifier: MIT */
/* vulkan_stage.h: a context, a scene and its images on the engine, ready for passes. */
#ifndef TESTS_VULKAN_STAGE_H
#define TESTS_VULKAN_STAGE_H

#include "vulkan_scene.h"

typedef struct stage {
    engine *g;
    scene_lines log;
    crv_context *context;
    scene_encoding e;
    scene *s;
    scene_images in;
} stage;

/* D32 reversed, world-space normals, hbao with bilateral13. */
extern const scene_encoding STAGE_USUAL;

stage *stage_open(engine *g, const scene_encoding *e, int width, int height);
void stage_close(stage *t);

crv_vulkan_pass *stage_pass(const stage *t, const crv_options *options, int frames,
                            int width, int height);

/* Records a frame and waits for it; its picture, which the caller frees. */
void stage_draw(const stage *t, crv_vulkan_pass *pass, const crv_vulkan_frame *frame);
float *stage_drawn(const stage *t, crv_vulkan_pass *pass, const crv_vulkan_frame *frame);

size_t stage_pixels(const stage *t);

/* One line was logged, with this part. */
void stage_assert_refused(stage *t, crv_status status, crv_status wanted,
                          const char *part);

#endif
