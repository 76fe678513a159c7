/* SPDX-License-Identifier: MIT */
/* vulkan_engine.h: what a renderer around the Vulkan backend has, for its tests. */
#ifndef TESTS_VULKAN_ENGINE_H
#define TESTS_VULKAN_ENGINE_H

#include "../examples/vulkan_host_setup.h"
#include "crevice/vulkan.h"

enum { ENGINE_COMMANDS = 8 };

typedef struct engine {
    host h;
    host_frame frames[ENGINE_COMMANDS];
} engine;

/* As host_open(): -1 if there is no device, or no validation layer. */
int engine_open(engine *e, int validate);
void engine_close(engine *e);

/* All set but the memory callbacks. */
crv_vulkan_host engine_host(const engine *e);

/* Begins one of the command buffers; submits it without waiting; waits for all. */
VkCommandBuffer engine_begin(engine *e, int which);
void engine_submit(engine *e, int which);
void engine_wait(engine *e);

/* An image that shaders sample, with these bytes, in the layout SHADER_READ_ONLY. */
host_image engine_upload(engine *e, VkFormat format, int width, int height,
                         const void *bytes, size_t size);

/* An image for a result; and its bytes, which the caller frees, once it is in
 * TRANSFER_SRC_OPTIMAL. */
host_image engine_result(engine *e, VkFormat format, int width, int height);
void *engine_download(engine *e, const host_image *image, int width, int height,
                      size_t size);

/* An image for a result whose texels hold a number, in TRANSFER_SRC_OPTIMAL. */
host_image engine_filled(engine *e, VkFormat format, int width, int height, float value);

/* An array of two layers for results; and the bytes of a layer, as above. */
typedef struct engine_array {
    host_image image;
    VkImageView layer[2];
} engine_array;
engine_array engine_array_make(engine *e, VkFormat format, int width, int height);
void engine_array_free(engine *e, engine_array *array);
void *engine_download_layer(engine *e, const host_image *image, int layer, int width,
                            int height, size_t size);

/* The engine of a test program. engine_tests_begin() opens it under the validation
 * layer and returns 0, or the exit code of a program that is skipped. The setup hands it
 * to the tests. engine_tests_end() closes it and returns the exit code: not 0 if a test
 * failed or the layer complained. */
extern engine the_engine;
int engine_tests_begin(void);
int engine_tests_setup(void **state);
int engine_tests_end(int failed);

/* A test, the last of each program. */
void the_validation_layer_is_silent(void **state);

#endif
