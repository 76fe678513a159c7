/* SPDX-License-Identifier: MIT */
/*
 * vulkan.h: ambient occlusion inside a Vulkan renderer: your device, your command buffer,
 * your images. crevice.h does not include this file, since it needs Vulkan's headers.
 *
 *   crv_vulkan_host_init(&host, sizeof host);          once: a context on your device
 *   host.instance = ...; host.device = ...;
 *   crv_vulkan_context_create(NULL, &host, &context);
 *
 *   crv_vulkan_pass_desc_init(&desc, sizeof desc);     for each size and set of options
 *   crv_vulkan_pass_create(context, &options, &gbuffer_desc, &desc, &pass);
 *
 *   crv_vulkan_frame_init(&frame, sizeof frame);       each frame
 *   frame.camera = ...; frame.depth[0].view = ...; frame.result_view = ...;
 *   crv_vulkan_pass_record(pass, command_buffer, &frame);
 *
 * To let Crevice make a device of its own, and to run plans on it, set
 * crv_context_desc.device (context.h): that needs no Vulkan headers. Plans
 * (crv_plan_run()) work on contexts made here as well; they submit to the queue and wait.
 *
 * The device must have been made with Vulkan 1.3 or newer and the features
 * synchronization2 and shaderStorageImageWriteWithoutFormat; its queue family must have
 * compute. libcrevice does not link the Vulkan loader. Where it was built without Vulkan
 * (CREVICE_VULKAN=OFF) it has none of these functions.
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
    void *mapped; /* the piece's first byte, where it is host-visible; else NULL */
    void *token;  /* the host's own */
} crv_vulkan_block;

/* Where device memory comes from. Both functions or neither (then each buffer and image
 * gets a VkDeviceMemory of its own). Called when passes and plans are made and destroyed,
 * never while recording. */
typedef struct crv_vulkan_memory {
    /* Finds memory of one of the types in requirements->memoryTypeBits that has all of
     * `needed`; host-visible memory must be mapped and coherent. */
    VkResult (*allocate)(void *user, const VkMemoryRequirements *requirements,
                         VkMemoryPropertyFlags needed, crv_vulkan_block *out);
    void (*release)(void *user, const crv_vulkan_block *block);
    void *user;
} crv_vulkan_memory;

/* The host's objects; they must outlive the context and stay the host's. Fill it with
 * crv_vulkan_host_init(), then set all handles. */
typedef struct crv_vulkan_host {
    size_t struct_size; /* set by crv_vulkan_host_init() */
    /* NULL: of the loader that is installed. */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    VkInstance instance; /* made for Vulkan 1.3 or newer */
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family; /* of the command buffers that are recorded; has compute */
    /* For plans only: used on the thread that runs a plan, which no other thread may use
     * at the same time. */
    VkQueue queue;
    /* Whether the device was made with these features: a VkDevice cannot be asked. */
    VkBool32 has_synchronization2, has_storage_image_write_without_format;
    /* Not needed: with shaderFloat16 filters can compute in half floats. */
    VkBool32 has_shader_float16;
    const VkAllocationCallbacks *callbacks; /* NULL: Vulkan's own */
    crv_vulkan_memory memory;
} crv_vulkan_host;

/* Sets everything to nothing. Pass sizeof *host as struct_size (base.h). Errors:
 * INVALID_ARGUMENT. Thread-safe. */
CRV_API crv_status crv_vulkan_host_init(crv_vulkan_host *host, size_t struct_size);

/*
 * A context on the host's device. desc NULL: the defaults; its `device` is not read.
 * Errors: INVALID_ARGUMENT; UNSUPPORTED where the device lacks what is needed; DEVICE
 * where its driver fails; OUT_OF_MEMORY. Thread-safe.
 */
CRV_API crv_status crv_vulkan_context_create(const crv_context_desc *desc,
                                             const crv_vulkan_host *host,
                                             crv_context **out);

/* How an image of normals is encoded. They may have any length but zero. */
typedef enum crv_vulkan_normals {
    CRV_VULKAN_NORMALS_NONE = 0,       /* reconstructed from depth */
    CRV_VULKAN_NORMALS_XYZ = 1,        /* as stored */
    CRV_VULKAN_NORMALS_XYZ_HALVED = 2, /* n * 0.5 + 0.5 */
    CRV_VULKAN_NORMALS_OCT = 3,        /* octahedral in x, y (Cigolle et al. 2014) */
    CRV_VULKAN_NORMALS_OCT_HALVED = 4  /* octahedral * 0.5 + 0.5 */
} crv_vulkan_normals;

/*
 * Formats, VK_FORMAT_ left out. All others are refused, those of integers and sRGB among
 * them. Not every device has every one: crv_vulkan_pass_create() asks it.
 *
 * Depth, read as the first component of what is sampled, in any encoding that
 * crv_depth_format has (hardware, reversed, infinite, planar, ...):
 *   D32_SFLOAT, D32_SFLOAT_S8_UINT, D24_UNORM_S8_UINT, X8_D24_UNORM_PACK32, D16_UNORM,
 *   D16_UNORM_S8_UINT, R32_SFLOAT, R16_UNORM, and the first component of R32G32_SFLOAT
 *   and R32G32B32A32_SFLOAT. Also R16_SFLOAT, R16G16_SFLOAT and R16G16B16A16_SFLOAT,
 *   whose steps are up to 1/1024 of the depth: coarse where the radius is a small part of
 *   it.
 * Normals, by encoding:
 *   XYZ: R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT, R8G8B8A8_SNORM, A8B8G8R8_SNORM_PACK32,
 *     A2B10G10R10_SNORM_PACK32, R16G16B16A16_SNORM.
 *   XYZ_HALVED: R8G8B8A8_UNORM, B8G8R8A8_UNORM, A8B8G8R8_UNORM_PACK32,
 *     A2R10G10B10_UNORM_PACK32, A2B10G10R10_UNORM_PACK32, R16G16B16A16_UNORM,
 *     B10G11R11_UFLOAT_PACK32, R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT.
 *   OCT: those of XYZ, and R16G16_SFLOAT, R32G32_SFLOAT, R8G8_SNORM, R16G16_SNORM.
 *   OCT_HALVED: those of XYZ_HALVED, and R8G8_UNORM, R16G16_UNORM, R16G16_SFLOAT,
 *     R32G32_SFLOAT.
 * Results, every component the same:
 *   R8_UNORM, R16_UNORM, R16_SFLOAT, R32_SFLOAT, R8G8_UNORM, R16G16_UNORM, R16G16_SFLOAT,
 *   R32G32_SFLOAT, R8G8B8A8_UNORM, B8G8R8A8_UNORM, A8B8G8R8_UNORM_PACK32,
 *   A2R10G10B10_UNORM_PACK32, A2B10G10R10_UNORM_PACK32, B10G11R11_UFLOAT_PACK32,
 *   R16G16B16A16_UNORM, R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT.
 */

/* Whether the filters bilateral13 and gauss5 compute in half floats, two pixels at a
 * time: within 2e-3 of the other picture. Depth stays in 32 bits. Only where the device
 * has shaderFloat16 and filter_normal is 10 to 90 or 180 degrees. */
typedef enum crv_vulkan_half {
    CRV_VULKAN_HALF_AUTO =
        0, /* but on devices that are CPUs: half floats are slower there */
    CRV_VULKAN_HALF_OFF = 1,
    CRV_VULKAN_HALF_ON = 2
} crv_vulkan_half;

#define CRV_VULKAN_MAX_FRAMES 8

/* What a pass is made for. Fill it with crv_vulkan_pass_desc_init(). */
typedef struct crv_vulkan_pass_desc {
    size_t struct_size; /* set by crv_vulkan_pass_desc_init() */
    /* Frames in flight: so many recordings may be executed or waited for at the same
     * time. 1 to CRV_VULKAN_MAX_FRAMES, default 2. */
    int32_t frames;
    /* One of the formats above each. */
    VkFormat depth_format;         /* default D32_SFLOAT */
    crv_vulkan_normals normals;    /* default NONE */
    crv_normal_space normal_space; /* default CRV_NORMAL_VIEW */
    VkFormat normal_format;        /* where normals is not NONE */
    VkFormat result_format;        /* default R8_UNORM */
    VkBool32 timestamps;           /* crv_vulkan_pass_times() */
    /* Takes depth apart by the phases of the noise tile, so that pixels which march in
     * step read neighbouring texels: the same picture, 8 bytes a pixel more. For tiles of
     * 2 to 8 px; others are computed as usual. Default off: see docs/gpu.md. */
    VkBool32 deinterleave;
    /* > 0: samples of hbao and alchemy that are farther than so many px, 16 say, read
     * coarser levels of depth: less to fetch for large radii. Another draw of the
     * estimate, as near to the truth, but not the picture of the CPU. Default 0: off;
     * not together with deinterleave. */
    int32_t level_px;
    crv_vulkan_half half_filters; /* default AUTO */
} crv_vulkan_pass_desc;

/* Sets the defaults. Pass sizeof *desc as struct_size (base.h). Errors: INVALID_ARGUMENT.
 * Thread-safe. */
CRV_API crv_status crv_vulkan_pass_desc_init(crv_vulkan_pass_desc *desc,
                                             size_t struct_size);

/* Pipelines, images and descriptors of one method, filter and size. */
typedef struct crv_vulkan_pass crv_vulkan_pass;

/*
 * The G-buffer's desc says size, layers and guard band; all three descriptions are
 * copied. For another size or other options make another pass and destroy this one when
 * its last recording has been executed. *out must be destroyed before its context, and
 * serves one thread at a time together with it.
 * Errors: INVALID_ARGUMENT, also where the format of normals cannot hold their encoding;
 * UNSUPPORTED where a format is not listed above or the device lacks it, where it cannot
 * compute this, or the context has no Vulkan device; DEVICE where its driver fails;
 * OUT_OF_MEMORY.
 */
CRV_API crv_status crv_vulkan_pass_create(crv_context *context,
                                          const crv_options *options,
                                          const crv_gbuffer_desc *gbuffer,
                                          const crv_vulkan_pass_desc *desc,
                                          crv_vulkan_pass **out);

/* None of its recordings may still be executed. NULL does nothing. */
CRV_API void crv_vulkan_pass_destroy(crv_vulkan_pass *pass);

/* An image that is read. */
typedef struct crv_vulkan_input {
    /* 2D, of one aspect, the size of the G-buffer; its image has SAMPLED usage. */
    VkImageView view;
    /*
     * The layout that it is in, and stays in: SHADER_READ_ONLY_OPTIMAL (default), GENERAL
     * or READ_ONLY_OPTIMAL; of depth formats also DEPTH_STENCIL_READ_ONLY_OPTIMAL,
     * DEPTH_READ_ONLY_OPTIMAL or DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL. Others are
     * refused. Whether the image really is in it cannot be asked: only the validation
     * layer follows that, so develop with it.
     */
    VkImageLayout layout;
} crv_vulkan_input;

/* One frame. Fill it with crv_vulkan_frame_init(). */
typedef struct crv_vulkan_frame {
    size_t struct_size; /* set by crv_vulkan_frame_init() */
    int32_t index;      /* which of the frames in flight: 0 to desc.frames - 1 */
    crv_camera camera;  /* of this frame; world_to_view turns world-space normals */
    crv_depth_format depth_encoding;        /* default planar */
    crv_vulkan_input depth[CRV_MAX_LAYERS]; /* as many as the G-buffer has layers */
    crv_vulkan_input normals;               /* where desc.normals is not NONE */
    /* One layer and level, of the size inside the guard band: none of it is checked,
     * since neither image nor view can be asked. */
    VkImage result;
    VkImageView result_view; /* of it, 2D, storage usage */
    /* The layout that the result gets; what it held is discarded. Default
     * SHADER_READ_ONLY_OPTIMAL; UNDEFINED, PREINITIALIZED and those of depth are refused.
     */
    VkImageLayout result_layout;
    /* Who reads it afterwards. Default: sampled in fragment and compute shaders. */
    VkPipelineStageFlags2 result_stages;
    VkAccessFlags2 result_access;
} crv_vulkan_frame;

/* Sets the defaults; camera, views and images are still to be given. Pass sizeof *frame
 * as struct_size (base.h). Errors: INVALID_ARGUMENT. Thread-safe. */
CRV_API crv_status crv_vulkan_frame_init(crv_vulkan_frame *frame, size_t struct_size);

/*
 * Records all passes of a frame into a command buffer that is being recorded, outside of
 * a render pass instance, on the context's queue family. Blocks nothing, allocates
 * nothing, submits nothing.
 *
 * Before: the host makes what wrote depth and normals visible to COMPUTE_SHADER stages
 * with SHADER_SAMPLED_READ access. The recording waits for all earlier commands
 * (ALL_COMMANDS) before it writes the result or its own images. After: the result is in
 * result_layout and visible to result_stages and result_access. The recording binds a
 * compute pipeline, descriptor set 0 and push constants, and leaves them bound.
 *
 * frame->index must not be in use by a recording that has not been executed to its end.
 * Errors: INVALID_ARGUMENT, nothing recorded.
 */
CRV_API crv_status crv_vulkan_pass_record(crv_vulkan_pass *pass, VkCommandBuffer commands,
                                          const crv_vulkan_frame *frame);

/* The time that a step of a recording took on the device. */
typedef struct crv_vulkan_time {
    /* "depth and normals", "depth" (each further layer), "deinterleave", "levels", the
     * method's name, and the filter's, or "filter, first pass" and "filter, second pass";
     * static.
     */
    const char *name;
    double time_ms;
} crv_vulkan_time;

#define CRV_VULKAN_MAX_TIMES 16

/*
 * Times of the last recording of the frame in flight `index`, which must have been
 * submitted.
 * times: room for CRV_VULKAN_MAX_TIMES; *count says how many were written. Does not wait.
 * Errors: INVALID_ARGUMENT; NOT_READY while it is executed (not logged: it is what asking
 * is for), or where nothing was recorded; UNSUPPORTED where desc.timestamps is not set or
 * the queue family has none; DEVICE where the driver fails.
 */
CRV_API crv_status crv_vulkan_pass_times(crv_vulkan_pass *pass, int32_t index,
                                         crv_vulkan_time *times, int32_t *count);

/* Bytes of device memory that the pass holds; 0 for NULL. */
CRV_API uint64_t crv_vulkan_pass_bytes(const crv_vulkan_pass *pass);

#ifdef __cplusplus
}
#endif
#endif
