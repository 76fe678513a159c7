/* SPDX-License-Identifier: MIT */
/*
 * vulkan.h: ambient occlusion inside a Vulkan renderer: your device, your command buffer,
 * your images. crevice.h does not include this file, since it needs Vulkan's headers.
 *
 *   crv_vulkan_host_init(&host, sizeof host);          once: a context on your device
 *   host.instance = ...; host.device = ...;
 *   crv_vulkan_context_create(NULL, &host, &context);
 *
 *   crv_vulkan_pass_desc_init(&desc, sizeof desc);     for each largest size and method
 *   crv_vulkan_pass_create(context, &options, &gbuffer_desc, &desc, &pass);
 *
 *   crv_vulkan_frame_init(&frame, sizeof frame);       each frame
 *   frame.camera = ...; frame.depth[0].view = ...; frame.result_view = ...;
 *   crv_vulkan_pass_record(pass, command_buffer, &frame);
 *
 * A smaller picture needs no new pass: crv_vulkan_frame has a size of its own. For a
 * larger one make a new pass, and destroy the old one when none of its recordings is
 * pending.
 *
 * To run plans on a device that Crevice creates itself, set crv_context_desc.device
 * (context.h): that needs no Vulkan headers. Plans (crv_plan_run()) work on contexts made
 * here as well: they submit to the queue and wait.
 *
 * The device must have been created for Vulkan 1.3 or newer with the features
 * synchronization2 and shaderStorageImageWriteWithoutFormat. Its queue family must have
 * compute. libcrevice does not link the Vulkan loader. If it was built without Vulkan
 * (CREVICE_VULKAN=OFF), it has none of these functions.
 */
#ifndef CREVICE_VULKAN_H
#define CREVICE_VULKAN_H

#include <vulkan/vulkan.h>

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A piece of device memory from the host's own allocator. */
typedef struct crv_vulkan_block {
    VkDeviceMemory memory;
    VkDeviceSize offset;
    void *mapped; /* the piece's first byte if it is host-visible; else NULL */
    void *token;  /* the host's own */
} crv_vulkan_block;

/* Where device memory comes from. Set both functions or neither. Neither: each buffer and
 * image gets a VkDeviceMemory of its own. Called when passes and plans are created and
 * destroyed, never while recording. */
typedef struct crv_vulkan_memory {
    /* Finds memory of a type that is in requirements->memoryTypeBits and has all flags in
     * `needed`. Host-visible memory must be mapped and coherent. */
    VkResult (*allocate)(void *user, const VkMemoryRequirements *requirements,
                         VkMemoryPropertyFlags needed, crv_vulkan_block *out);
    void (*release)(void *user, const crv_vulkan_block *block);
    void *user;
} crv_vulkan_memory;

/* The host's objects. They stay the host's and must outlive the context. Fill it with
 * crv_vulkan_host_init(), then set the handles. */
typedef struct crv_vulkan_host {
    size_t struct_size; /* set by crv_vulkan_host_init() */
    /* NULL: the installed loader's. */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    VkInstance instance; /* created for Vulkan 1.3 or newer */
    VkPhysicalDevice physical_device;
    VkDevice device;
    /* The family of the command buffers that passes are recorded into. It must have
     * compute. */
    uint32_t queue_family;
    /* Only plans need a queue: they submit to it on the thread that runs them. No other
     * thread may use the queue at that time. */
    VkQueue queue;
    /* Whether the device was created with these features: a VkDevice cannot be asked. */
    VkBool32 has_synchronization2, has_storage_image_write_without_format;
    /* Optional: with shaderFloat16 filters can compute in half floats. */
    VkBool32 has_shader_float16;
    /* Optional: the instance was created with VK_EXT_debug_utils. Objects get names and
     * steps get labels, which debuggers and profilers show. */
    VkBool32 has_debug_utils;
    VkPipelineCache pipeline_cache;         /* VK_NULL_HANDLE (default): none */
    const VkAllocationCallbacks *callbacks; /* NULL (default): Vulkan's own */
    crv_vulkan_memory memory;
} crv_vulkan_host;

/* Sets the defaults: no handles, no features. Pass sizeof *host as struct_size (base.h).
 * Errors: INVALID_ARGUMENT. Thread-safe. */
CRV_API crv_status crv_vulkan_host_init(crv_vulkan_host *host, size_t struct_size);

/*
 * A context on the host's device. desc NULL: the defaults; desc->device is not read.
 * Errors: INVALID_ARGUMENT; UNSUPPORTED if the device lacks a feature; DEVICE if its
 * driver fails; OUT_OF_MEMORY. Thread-safe.
 */
CRV_API crv_status crv_vulkan_context_create(const crv_context_desc *desc,
                                             const crv_vulkan_host *host,
                                             crv_context **out);

/* How an image of normals is encoded. Normals may have any length but zero. */
typedef enum crv_vulkan_normals {
    CRV_VULKAN_NORMALS_NONE = 0,       /* reconstructed from depth */
    CRV_VULKAN_NORMALS_XYZ = 1,        /* as stored */
    CRV_VULKAN_NORMALS_XYZ_HALVED = 2, /* n * 0.5 + 0.5 */
    CRV_VULKAN_NORMALS_OCT = 3,        /* octahedral in x, y (Cigolle et al. 2014) */
    CRV_VULKAN_NORMALS_OCT_HALVED = 4  /* octahedral * 0.5 + 0.5 */
} crv_vulkan_normals;

/*
 * Formats, without VK_FORMAT_. All others are refused, such as integers and sRGB. Not
 * every device has every format: crv_vulkan_pass_create() asks the device.
 *
 * Depth is the first component, in any encoding of crv_depth_format (hardware, reversed,
 * infinite, planar, ...):
 *   D32_SFLOAT, D32_SFLOAT_S8_UINT, D24_UNORM_S8_UINT, X8_D24_UNORM_PACK32, D16_UNORM,
 *   D16_UNORM_S8_UINT, R32_SFLOAT, R16_UNORM, R32G32_SFLOAT, R32G32B32A32_SFLOAT.
 *   Also R16_SFLOAT, R16G16_SFLOAT and R16G16B16A16_SFLOAT. Their steps are up to 1/1024
 *   of the depth, which is coarse if the radius is a small part of the depth.
 * Normals, by encoding:
 *   XYZ: R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT, R8G8B8A8_SNORM, A8B8G8R8_SNORM_PACK32,
 *     A2B10G10R10_SNORM_PACK32, R16G16B16A16_SNORM.
 *   XYZ_HALVED: R8G8B8A8_UNORM, B8G8R8A8_UNORM, A8B8G8R8_UNORM_PACK32,
 *     A2R10G10B10_UNORM_PACK32, A2B10G10R10_UNORM_PACK32, R16G16B16A16_UNORM,
 *     B10G11R11_UFLOAT_PACK32, R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT.
 *   OCT: those of XYZ, and R16G16_SFLOAT, R32G32_SFLOAT, R8G8_SNORM, R16G16_SNORM.
 *   OCT_HALVED: those of XYZ_HALVED, and R8G8_UNORM, R16G16_UNORM, R16G16_SFLOAT,
 *     R32G32_SFLOAT.
 * Results; every component gets the same value:
 *   R8_UNORM, R16_UNORM, R16_SFLOAT, R32_SFLOAT, R8G8_UNORM, R16G16_UNORM, R16G16_SFLOAT,
 *   R32G32_SFLOAT, R8G8B8A8_UNORM, B8G8R8A8_UNORM, A8B8G8R8_UNORM_PACK32,
 *   A2R10G10B10_UNORM_PACK32, A2B10G10R10_UNORM_PACK32, B10G11R11_UFLOAT_PACK32,
 *   R16G16B16A16_UNORM, R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT.
 * Bent normals: R16G16_SFLOAT and R16G16_SNORM, octahedral in x, y (background: 0, 0);
 *   R16G16B16A16_SFLOAT and R32G32B32A32_SFLOAT, x, y, z and 0 (background: 0, 0, 0).
 */

/* Whether the filters bilateral13 and gauss5 compute in half floats, two pixels at a
 * time. Results differ by at most 2e-3. Depth stays in 32 bits. Without effect unless the
 * device has shaderFloat16 and filter_normal is 10 to 90 or 180 degrees, or with bent
 * normals. */
typedef enum crv_vulkan_half {
    CRV_VULKAN_HALF_AUTO = 0, /* on, except on devices that are CPUs: slower there */
    CRV_VULKAN_HALF_OFF = 1,
    CRV_VULKAN_HALF_ON = 2
} crv_vulkan_half;

/* How depth lies in memory while it is sampled. docs/gpu.md compares the layouts. */
typedef enum crv_vulkan_depth_layout {
    CRV_VULKAN_DEPTH_LINEAR = 0, /* an image */
    /* Deinterleaved by noise-tile phase; same result. Takes 4 more bytes for each pixel
     * and layer. For noise tiles of 2 to 8 px; linear for others. */
    CRV_VULKAN_DEPTH_DEINTERLEAVED = 1,
    /* hbao and alchemy read coarser levels for distant samples: less memory traffic for
     * large radii. Different samples, same expected error. Other methods: linear. */
    CRV_VULKAN_DEPTH_LEVELS = 2
} crv_vulkan_depth_layout;

/*
 * Depth layout and half floats of the plans that are created from now on
 * (crv_plan_create()). Passes have both in their desc. Defaults: LINEAR, HALF_OFF. LEVELS
 * begin at 16 px. Errors: INVALID_ARGUMENT; UNSUPPORTED if the context has no Vulkan
 * device.
 */
CRV_API crv_status crv_vulkan_context_set_plans(crv_context *context,
                                                crv_vulkan_depth_layout depth_layout,
                                                crv_vulkan_half half_filters);

#define CRV_VULKAN_MAX_FRAMES 32

/* What a pass is created for. Fill it with crv_vulkan_pass_desc_init(). */
typedef struct crv_vulkan_pass_desc {
    size_t struct_size; /* set by crv_vulkan_pass_desc_init() */
    /* Recordings in flight: frames in flight times views in each. Each takes a few
     * kilobytes; all share the images between the steps. 1 to CRV_VULKAN_MAX_FRAMES,
     * default 2. */
    int32_t frames;
    /* Each is one of the formats above. */
    VkFormat depth_format;                /* default D32_SFLOAT */
    crv_vulkan_normals normals;           /* default NONE */
    crv_normal_space normal_space;        /* default CRV_NORMAL_VIEW */
    VkFormat normal_format;               /* not read if normals is NONE */
    VkFormat result_format;               /* default R8_UNORM */
    VkBool32 timestamps;                  /* crv_vulkan_pass_times(); default off */
    crv_vulkan_depth_layout depth_layout; /* default LINEAR */
    /* LEVELS only: distance in px from which samples read the first coarser level; twice
     * as far the second, and so on. 1 or more, default 16; below that errors grow. */
    int32_t level_px;
    crv_vulkan_half half_filters; /* default AUTO */
    /* Of the bent normal (crv_weighting, options.h), which is computed if this is a
     * format. Methods whose crv_method.bent_normal is 1; the option of that name is not
     * read. Default UNDEFINED: none. */
    VkFormat bent_normal_format;
} crv_vulkan_pass_desc;

/* Sets the defaults. Pass sizeof *desc as struct_size (base.h). Errors: INVALID_ARGUMENT.
 * Thread-safe. */
CRV_API crv_status crv_vulkan_pass_desc_init(crv_vulkan_pass_desc *desc,
                                             size_t struct_size);

/* Pipelines, images and descriptors of one method, filter and size. */
typedef struct crv_vulkan_pass crv_vulkan_pass;

/*
 * Makes a pass in *out. The G-buffer's desc gives the largest size, the layers and the
 * guard band. options and both descs are copied. The caller destroys the pass, before its
 * context. A context and all its passes together serve one thread at a time.
 * Errors: INVALID_ARGUMENT, also if the format of normals cannot hold their encoding;
 * UNSUPPORTED if a format is not listed above, the device lacks it or cannot compute
 * this, or the context has no Vulkan device; DEVICE if its driver fails; OUT_OF_MEMORY.
 */
CRV_API crv_status crv_vulkan_pass_create(crv_context *context,
                                          const crv_options *options,
                                          const crv_gbuffer_desc *gbuffer,
                                          const crv_vulkan_pass_desc *desc,
                                          crv_vulkan_pass **out);

/* Destroys a pass. None of its recordings may be pending. NULL does nothing. */
CRV_API void crv_vulkan_pass_destroy(crv_vulkan_pass *pass);

/*
 * New option values for all later recordings. Costs nothing and takes no memory, so it
 * may be called each frame. These are fixed when the pass is created: method, filter,
 * falloff, directions, steps, spacing, normal_rays, samples, attenuation, noise_size and
 * filter_slope, whether bias_deg is 0, and whether filter_normal allows half floats. So
 * is thickness_rule, but only if it was not width at first and shall be; and, of plans,
 * bent_normal.
 * Errors, with nothing changed: INVALID_ARGUMENT; UNSUPPORTED, with a line that names the
 * option, if it is fixed.
 */
CRV_API crv_status crv_vulkan_pass_set_options(crv_vulkan_pass *pass,
                                               const crv_options *options);

/* An image that is read. */
typedef struct crv_vulkan_input {
    /* VK_IMAGE_VIEW_TYPE_2D, of one aspect, level and layer; of a multiview array image
     * the layer of this eye. At least input_x + width by input_y + height of the frame.
     * The image has SAMPLED usage. */
    VkImageView view;
    /*
     * The layout that the image is in, and stays in: SHADER_READ_ONLY_OPTIMAL (default),
     * GENERAL or READ_ONLY_OPTIMAL; of depth formats also
     * DEPTH_STENCIL_READ_ONLY_OPTIMAL, DEPTH_READ_ONLY_OPTIMAL or
     * DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL. Others are refused. Crevice cannot
     * check that the image is in that layout: develop with the validation layer.
     */
    VkImageLayout layout;
} crv_vulkan_input;

/* One frame. Fill it with crv_vulkan_frame_init(). */
typedef struct crv_vulkan_frame {
    size_t struct_size; /* set by crv_vulkan_frame_init() */
    int32_t index;      /* which of the recordings in flight: 0 to desc.frames - 1 */
    /* Size of this frame, px, guard band included, at most the size of the pass: for
     * dynamic resolution. 0 (default): the size of the pass. */
    int32_t width, height;
    /* The camera of an image of this frame's size. world_to_view is read for world-space
     * normals. */
    crv_camera camera;
    /* For tiles of a larger picture: added to the origin of the G-buffer's desc, px.
     * Default 0, 0. */
    int32_t origin_x, origin_y;
    /* Different noise for each frame, same expected error: count up if temporal
     * antialiasing accumulates frames. 0 (default): the pattern that plans have. */
    uint32_t noise_index;
    crv_depth_format depth_encoding;        /* default planar */
    crv_vulkan_input depth[CRV_MAX_LAYERS]; /* as many as the G-buffer has layers */
    crv_vulkan_input normals;               /* not read if desc.normals is NONE */
    /* Texel of depth and normals at which the frame begins. Default 0, 0. */
    int32_t input_x, input_y;

    /* At least result_x, result_y plus the frame's size inside the guard band. Not
     * checked: Vulkan does not tell the size of an image or view. */
    VkImage result;
    VkImageView result_view; /* VK_IMAGE_VIEW_TYPE_2D, of one level and layer; STORAGE */
    /* Level and layer of the image that the view shows. Default 0, 0. */
    uint32_t result_level, result_layer;
    /* Texel of the view at which the result begins. Default 0, 0. */
    int32_t result_x, result_y;
    /* The layout in which the result is before. UNDEFINED (default): its contents are
     * discarded, also outside the rectangle that is written. */
    VkImageLayout result_layout_before;
    /* The last use of the result. Default: ALL_COMMANDS and MEMORY_WRITE. */
    VkPipelineStageFlags2 result_stages_before;
    VkAccessFlags2 result_access_before;
    /* The layout that the result gets. Default SHADER_READ_ONLY_OPTIMAL. UNDEFINED,
     * PREINITIALIZED and layouts of depth are refused. */
    VkImageLayout result_layout;
    /* The next use of the result. Default: sampled in fragment and compute shaders. */
    VkPipelineStageFlags2 result_stages;
    VkAccessFlags2 result_access;

    /* The bent normal, view space, if the pass has a format for it. All that is said of
     * the result holds for it: level, layer, texel, layouts, stages. */
    VkImage bent_normal;
    VkImageView bent_normal_view;
} crv_vulkan_frame;

/* Sets the defaults. Camera, views and images are left to set. Pass sizeof *frame as
 * struct_size (base.h). Errors: INVALID_ARGUMENT. Thread-safe. */
CRV_API crv_status crv_vulkan_frame_init(crv_vulkan_frame *frame, size_t struct_size);

/*
 * Records a frame into a command buffer of the context's queue family, outside of a
 * render pass instance. Does not wait, allocate or submit.
 *
 * Before: the host makes depth and normals visible to COMPUTE_SHADER stages with
 * SHADER_SAMPLED_READ access. After: the result is in result_layout and visible to
 * result_stages and result_access. The recording binds a compute pipeline, descriptor set
 * 0 and push constants, and leaves them bound.
 *
 * Recordings of one pass share its images, and each waits for the one before. Submit them
 * to one queue, or order them by semaphores. Several may be in one command buffer (views
 * of a headset, split screen). frame->index must not be that of a recording that is still
 * pending. Errors: INVALID_ARGUMENT, with nothing recorded.
 */
CRV_API crv_status crv_vulkan_pass_record(crv_vulkan_pass *pass, VkCommandBuffer commands,
                                          const crv_vulkan_frame *frame);

/*
 * Times of the steps of the last recording with this index, which must have been
 * submitted: "depth and normals", "depth" (each further layer), "deinterleave", "levels",
 * "width" (bitmask), the method's name, the filter's name (each pass).
 * times: room for CRV_MAX_DEVICE_TIMES; *count: the number written. Does not wait.
 * Errors: INVALID_ARGUMENT; NOT_READY, not logged, while the recording is executed, or if
 * nothing was recorded; UNSUPPORTED if desc.timestamps is not set or the queue family has
 * no timestamps; DEVICE if the driver fails.
 */
CRV_API crv_status crv_vulkan_pass_times(const crv_vulkan_pass *pass, int32_t index,
                                         crv_device_time *times, int32_t *count);

/* Bytes of device memory that the pass holds; 0 for NULL. */
CRV_API uint64_t crv_vulkan_pass_bytes(const crv_vulkan_pass *pass);

#ifdef __cplusplus
}
#endif
#endif
