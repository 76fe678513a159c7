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
/* With a guard band, at an odd origin, as scene_make() has it. */
stage *stage_open_guarded(engine *g, const scene_encoding *e);
void stage_close(stage *t);

crv_vulkan_pass *stage_pass(const stage *t, const crv_options *options, int frames,
                            int width, int height);
/* For the scene as it is, with its usual options. */
crv_vulkan_pass *stage_usual_pass(const stage *t);

/* Records a frame and waits for it; its picture, which the caller frees. */
void stage_draw(const stage *t, crv_vulkan_pass *pass, const crv_vulkan_frame *frame);
float *stage_drawn(const stage *t, crv_vulkan_pass *pass, const crv_vulkan_frame *frame);

size_t stage_pixels(const stage *t);

/* One line was logged, with this part. */
void stage_assert_refused(stage *t, crv_status status, crv_status wanted,
                          const char *part);

#endif
