/* SPDX-License-Identifier: MIT */
/*
 * vulkan_host_setup.h: what every Vulkan program begins with: a device, images, buffers,
 * pipelines. Nothing here knows of Crevice. What goes wrong ends the program with a line.
 */
#ifndef EXAMPLES_VULKAN_HOST_SETUP_H
#define EXAMPLES_VULKAN_HOST_SETUP_H

#include <stddef.h>
#include <vulkan/vulkan.h>

typedef struct host {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    VkDevice device;
    uint32_t family; /* graphics and compute */
    VkQueue queue;
    VkBool32 has_float16; /* shaderFloat16 is on */
    int complaints;       /* lines of the validation layer */
} host;

/* validate: with the validation layer, its lines to stderr. 0; or -1 if there is no
 * Vulkan 1.3 device, or no validation layer. host must not move afterwards. */
int host_open(host *h, int validate);
void host_close(host *h);

/* Ends the program if the result is an error. */
void host_check(VkResult result, const char *what);

typedef struct host_image {
    VkImage image;
    VkImageView view;
    VkDeviceMemory memory;
} host_image;

host_image host_image_make(const host *h, VkFormat format, int width, int height,
                           VkImageUsageFlags usage);
/* An array; the view is of its first layer. */
host_image host_image_make_layers(const host *h, VkFormat format, int width, int height,
                                  int layers, VkImageUsageFlags usage);
void host_image_free(const host *h, host_image *image);

typedef struct host_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *bytes;
} host_buffer;

/* Mapped and coherent. */
host_buffer host_buffer_make(const host *h, size_t size, VkBufferUsageFlags usage);
void host_buffer_free(const host *h, host_buffer *buffer);

/* What a frame in flight has of its own. The fence is signalled at first. */
typedef struct host_frame {
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence done;
} host_frame;

host_frame host_frame_make(const host *h);
void host_frame_free(const host *h, host_frame *frame);
/* Begins its commands anew, once it is done; submits them. */
void host_frame_begin(const host *h, host_frame *frame);
void host_frame_submit(const host *h, host_frame *frame);

/* Images that fragment shaders sample in SHADER_READ_ONLY_OPTIMAL, from binding 0 on, and
 * push constants of vertex and fragment shaders. */
typedef struct host_layout {
    VkDescriptorSetLayout sets;
    VkPipelineLayout pipelines;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkSampler sampler;
} host_layout;

enum { HOST_MOST_IMAGES = 4 };
enum { HOST_PUSH_STAGES = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT };

host_layout host_layout_make(const host *h, const VkImageView *views, uint32_t count,
                             uint32_t push_bytes);
void host_layout_free(const host *h, host_layout *layout);

typedef struct host_shader {
    const uint32_t *words;
    size_t size_bytes;
} host_shader;

/* Triangles by dynamic rendering, without vertex buffers. depth_format UNDEFINED: no
 * depth; else the nearest, reversed, stays. */
VkPipeline host_pipeline_make(const host *h, VkPipelineLayout layout, host_shader vertex,
                              host_shader fragment, VkFormat colour_format,
                              VkFormat depth_format);

/* Begins to draw into images of this size, cleared to 0. depth NULL: none. */
void host_rendering_begin(VkCommandBuffer commands, VkImageView colour, VkImageView depth,
                          int width, int height);

/* A barrier for one image: from what was done to it, to what will be. */
typedef struct host_use {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
    VkImageLayout layout;
} host_use;
void host_barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                  host_use before, host_use after);

/* Copies a layer of a colour image in TRANSFER_SRC_OPTIMAL, for the host to read. */
void host_readback(VkCommandBuffer commands, VkImage image, int layer, int width,
                   int height, const host_buffer *to);

/* Writes 4 bytes a pixel as a PPM. 0; or 1 after a line to stderr. */
int host_write_ppm(const char *path, const host_buffer *rgba, int width, int height);

#endif
