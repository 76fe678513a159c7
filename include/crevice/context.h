/* SPDX-License-Identifier: MIT */
/*
 * context.h: the objects that do the work. A context holds the hooks and the device; a
 * plan holds the memory of one method with one set of options on G-buffers of one size,
 * and runs any number of frames without allocating.
 */
#ifndef CREVICE_CONTEXT_H
#define CREVICE_CONTEXT_H

#include "gbuffer.h"
#include "options.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Instruction sets of the CPU that have kernels. With crv_context_desc.exact all of them
 * compute the same estimate within 1e-3, but for a few pixels in which rounding picks
 * the neighbouring texel. */
typedef enum crv_isa {
    CRV_ISA_SCALAR, /* plain C, the specification */
    CRV_ISA_SSE4,   /* x86-64-v2 */
    CRV_ISA_AVX2,   /* with FMA */
    CRV_ISA_AVX512, /* F, BW, DQ and VL */
    CRV_ISA_NEON,   /* AArch64 */
    CRV_ISA_WASM    /* 128-bit vectors of WebAssembly */
} crv_isa;

/* "scalar", "sse4", "avx2", "avx512", "neon", "wasm"; NULL for no such set.
 * Thread-safe. */
CRV_API const char *crv_isa_name(crv_isa isa);

/* The sets that are built in and that this machine has: a bit 1u << crv_isa for each.
 * CRV_ISA_SCALAR is always among them. Thread-safe. */
CRV_API uint32_t crv_isa_available(void);

/* Where plans run. */
typedef enum crv_device {
    CRV_DEVICE_CPU = 0,
    /* A GPU, or whatever else has a Vulkan 1.3 driver. Height fields and implicit
     * surfaces are for the CPU only. */
    CRV_DEVICE_VULKAN = 1
} crv_device;

/* Fill it with crv_context_desc_init(), then change what differs. */
typedef struct crv_context_desc {
    size_t struct_size;      /* set by crv_context_desc_init() */
    crv_logger logger;       /* default: silent */
    crv_allocator allocator; /* default: the C library's */
    crv_parallel parallel;   /* default: the library's own threads */
    /* The library's own threads: 1 to 1024. 0 (default): OpenMP's choice, at most four
     * for each processor; without OpenMP one for each. */
    int32_t threads;
    /* Bits 1u << crv_isa that may be used. The fastest of them that is available is used,
     * or CRV_ISA_SCALAR. 0 (default): all. */
    uint32_t isa_mask;
    /* CPU only. 0 (default): hbao, gtao, bitmask, alchemy and vo use deinterleaved
     * kernels: up to 4 times as fast, to the same error. 1: reference sampling, exactly
     * as in the scalar code. Choose 1 to compare with papers or between instruction
     * sets. */
    int32_t exact;
    crv_device device;     /* default CRV_DEVICE_CPU */
    int32_t device_index;  /* Vulkan: as crv_vulkan_device_info() counts; default 0 */
    crv_progress progress; /* of runs; default: nobody is told, runs go to their end */
} crv_context_desc;

/* Sets the defaults. Pass sizeof *desc as struct_size (base.h). Errors: INVALID_ARGUMENT.
 * Thread-safe. */
CRV_API crv_status crv_context_desc_init(crv_context_desc *desc, size_t struct_size);

/* Hooks and a device. A context and everything made with it serve one thread at a time.
 * Different contexts are independent: there is no global state. */
typedef struct crv_context crv_context;

/* Makes a context in *out; the caller destroys it. desc NULL: the defaults. Errors:
 * INVALID_ARGUMENT, OUT_OF_MEMORY; UNSUPPORTED if there is no such device, it lacks what
 * is needed, or the library was built without Vulkan; DEVICE if its driver fails.
 * Thread-safe. */
CRV_API crv_status crv_context_create(const crv_context_desc *desc, crv_context **out);

/* Destroy everything made with the context first; else an error is logged, and the
 * context stays. NULL does nothing. */
CRV_API void crv_context_destroy(crv_context *context);

/* The instruction set of the context's plans on the CPU, and of its G-buffers on any
 * device. CRV_ISA_SCALAR for NULL. */
CRV_API crv_isa crv_context_isa(const crv_context *context);

/* A device for crv_context_desc. */
typedef struct crv_device_info {
    char name[256];    /* as the driver gives it */
    char driver[256];  /* its name and version as it gives them; Vulkan's version */
    int32_t software;  /* 1: runs on the CPU (lavapipe) */
    char missing[128]; /* why Crevice cannot use it; "": it can */
} crv_device_info;

/* Describes the Vulkan device `index`; the first is 0. logger NULL: silent. Errors:
 * INVALID_ARGUMENT if info is NULL or there are fewer devices (not logged); UNSUPPORTED
 * with a line if there is no Vulkan, at build or at run time; DEVICE if a driver fails;
 * OUT_OF_MEMORY. Thread-safe. */
CRV_API crv_status crv_vulkan_device_info(int32_t index, crv_device_info *info,
                                          const crv_logger *logger);

/* One method, one filter, one set of options, one size. */
typedef struct crv_plan crv_plan;

/*
 * Makes a plan in *out: checks the options, builds sample patterns and takes the memory
 * of all runs. options and desc are copied. The caller destroys the plan, before its
 * context.
 *
 * Memory: 4 bytes for each pixel of the result, 4 more with a filter. Deinterleaved
 * kernels take 4 more for each depth layer, and 0.5 to 16 MiB of tables. Together with
 * the G-buffer that is below 48 bytes a pixel, or 2 MiB of tables above it. Bent normals
 * take 12 bytes more for each pixel of the result, 24 with a filter. A Vulkan device
 * holds images and a staging buffer as well.
 *
 * Errors: INVALID_ARGUMENT, OUT_OF_MEMORY; on a Vulkan device UNSUPPORTED if it cannot
 * compute this, and DEVICE if its driver fails.
 */
CRV_API crv_status crv_plan_create(crv_context *context, const crv_options *options,
                                   const crv_gbuffer_desc *desc, crv_plan **out);

/* NULL does nothing. */
CRV_API void crv_plan_destroy(crv_plan *plan);

/*
 * Gives the plan new options without taking memory, for a slider or an animation. The
 * result has the same bits as that of a new plan. These changes need a new plan:
 *
 *   - another method or noise_size;
 *   - a filter instead of none, or none instead of a filter;
 *   - with a guard band, a filter of another radius;
 *   - bent_normal 1 if it was 0;
 *   - more or odd directions, steps or samples that take more memory than at first, or
 *     thickness_rule width if it was another;
 *   - on a Vulkan device, all that crv_vulkan_pass_set_options() calls fixed.
 *
 * Errors, with the plan unchanged: INVALID_ARGUMENT; UNSUPPORTED, with a line that names
 * the option, if a new plan is needed.
 */
CRV_API crv_status crv_plan_set_options(crv_plan *plan, const crv_options *options);

/*
 * Computes the accessibility of every pixel inside the guard band, filtered if the
 * options say so. 1 is open, 0 fully occluded, background is 1. All values are finite and
 * in [0, 1].
 *
 * gbuffer: made with the same context and an equal desc. result: one channel, width -
 * guard_left - guard_right by height - guard_top - guard_bottom. Returns when it is done.
 * Allocates nothing. The same input gives the same bits for any number of threads.
 *
 * Errors: INVALID_ARGUMENT; NOT_READY if the G-buffer lacks its camera or a depth layer;
 * STOPPED if crv_context_desc.progress ended the run; on a Vulkan device UNSUPPORTED if
 * the G-buffer has a height field or an implicit surface that the options ask for, and
 * DEVICE if its driver fails.
 */
CRV_API crv_status crv_plan_run(crv_plan *plan, crv_gbuffer *gbuffer,
                                const crv_image *result);

/* The images that a run fills. Fill it with crv_result_init(), then set those that are
 * wanted; data NULL: not wanted. Images must not share memory. */
typedef struct crv_result {
    size_t struct_size;      /* set by crv_result_init() */
    crv_image accessibility; /* as crv_plan_run() has it */
    /* Three channels of the same size: the bent normal (crv_weighting), view space like
     * all normals, unit length. Background and surfaces without a normal: (0, 0, 0). */
    crv_image bent_normal;
} crv_result;

/* No image is wanted. Pass sizeof *result as struct_size (base.h). Errors:
 * INVALID_ARGUMENT. Thread-safe. */
CRV_API crv_status crv_result_init(crv_result *result, size_t struct_size);

/*
 * crv_plan_run() for any of the images, at least one. Filters smooth how bent normals
 * deviate from normals, with the weights of accessibility, which has the same bits with
 * and without bent normals. Intensity and contrast do not change these.
 *
 * Errors: as crv_plan_run(); INVALID_ARGUMENT if bent normals are wanted of a plan whose
 * method gives none, or whose option bent_normal is 0.
 */
CRV_API crv_status crv_plan_run_result(crv_plan *plan, crv_gbuffer *gbuffer,
                                       const crv_result *result);

/* Applies the plan's filter to an accessibility image of the result's size, for example
 * one that was computed elsewhere; copies it if the plan has no filter. Values that are
 * not finite count as 1. input and result may be the same image. Allocates nothing.
 * Errors: as crv_plan_run(). */
CRV_API crv_status crv_plan_filter(crv_plan *plan, crv_gbuffer *gbuffer,
                                   const crv_const_image *input, const crv_image *result);

/* The time that a step took on the device. */
typedef struct crv_device_time {
    const char *name; /* "upload", "deinterleave", "levels", "width", the method's or
                         filter's name, "download"; static */
    double time_ms;
} crv_device_time;

#define CRV_MAX_DEVICE_TIMES 16

/*
 * The steps of the plan's last run by the device's own clock. times: room for
 * CRV_MAX_DEVICE_TIMES; *count: the number written. Errors: INVALID_ARGUMENT;
 * NOT_READY before the first run that ended well; UNSUPPORTED on the CPU, or if the
 * device has no timestamps; DEVICE if its driver fails.
 */
CRV_API crv_status crv_plan_device_times(const crv_plan *plan, crv_device_time *times,
                                         int32_t *count);

/* The most subpixel samples that crv_multisample_gather() takes. */
#define CRV_MAX_SUBSAMPLES 16

/*
 * Accessibility of each subpixel sample, for compositing before samples are resolved
 * (McGuire et al. 2011). A plan computes one value for each pixel, at the depth in the
 * G-buffer. Here every sample gathers from its pixel and the four beside it. The weight
 * of each falls with the difference in depth, so that a sample of the floor at a column's
 * edge takes the accessibility of the floor. If all of them differ by depth_range or
 * more, the least different counts alone. Background samples, and samples that have no
 * surface around, get 1.
 *
 * gbuffer: the frame, with camera and depth layer 0.
 * accessibility: one channel, the size inside the guard band, as crv_plan_run() wrote it.
 *     Values that are not finite count as 1.
 * sample_depth: the same size; 2 to CRV_MAX_SUBSAMPLES channels, one for each sample.
 * format: of sample_depth; NULL: planar. Radial depth is taken along the ray of the
 *     pixel's centre.
 * depth_range: difference in depth from which a neighbour does not count, > 0, scene
 *     units. A good choice is filter_depth * radius of the options.
 * result: as many channels as sample_depth. It may be sample_depth itself, but may not
 *     share memory with accessibility.
 *
 * Allocates nothing. The same bits for any number of threads. Errors: INVALID_ARGUMENT;
 * NOT_READY if the G-buffer lacks its camera or layer 0.
 */
CRV_API crv_status crv_multisample_gather(crv_gbuffer *gbuffer,
                                          const crv_const_image *accessibility,
                                          const crv_const_image *sample_depth,
                                          const crv_depth_format *format,
                                          float depth_range, const crv_image *result);

#ifdef __cplusplus
}
#endif
#endif
