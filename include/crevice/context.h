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

/* Instruction sets of the CPU for which there are kernels. With crv_context_desc.exact
 * every one computes the same estimate: within 1e-3 of the scalar code, but for a few
 * pixels where rounding picks the neighbouring texel. */
typedef enum crv_isa {
    CRV_ISA_SCALAR, /* plain C, the specification */
    CRV_ISA_SSE4,   /* x86-64-v2 */
    CRV_ISA_AVX2,   /* with FMA */
    CRV_ISA_AVX512, /* F, BW, DQ and VL */
    CRV_ISA_NEON    /* AArch64 */
} crv_isa;

/* "scalar", "sse4", "avx2", "avx512", "neon"; NULL for no such set. Thread-safe. */
CRV_API const char *crv_isa_name(crv_isa isa);

/* The sets that are built in and that this machine has, a bit 1u << crv_isa each;
 * CRV_ISA_SCALAR is always there. Thread-safe. */
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
    crv_parallel parallel;   /* default: OpenMP, or one thread where built without */
    int32_t threads; /* OpenMP only: 1 to 1024, or 0 (default) for what OpenMP chooses */
    uint32_t isa_mask; /* bits 1u << crv_isa that may be used; the fastest of them that
                          is available is, and CRV_ISA_SCALAR where none is. 0 (default):
                          all */
    /* CPU only. 0 (default): hbao, gtao, bitmask, alchemy and vo use deinterleaved
     * kernels: up to 4 times as fast; samples move by a part of a pixel's footprint, to
     * the same error. 1: samples are exactly where the scalar code has them. */
    int32_t exact;
    crv_device device;    /* default CRV_DEVICE_CPU */
    int32_t device_index; /* Vulkan: as crv_vulkan_device_info() counts; default 0 */
} crv_context_desc;

/* Sets the defaults. Pass sizeof *desc as struct_size (base.h). Errors: INVALID_ARGUMENT.
 * Thread-safe. */
CRV_API crv_status crv_context_desc_init(crv_context_desc *desc, size_t struct_size);

/*
 * Hooks and a device: there is no global state. A context and all that was made with it
 * serve one thread at a time; different contexts are independent.
 */
typedef struct crv_context crv_context;

/* desc NULL: the defaults. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY; UNSUPPORTED where
 * there is no such device, it lacks what is needed, or the library was built without
 * Vulkan; DEVICE where its driver fails. Thread-safe. */
CRV_API crv_status crv_context_create(const crv_context_desc *desc, crv_context **out);

/* Everything made with the context must have been destroyed. NULL does nothing. */
CRV_API void crv_context_destroy(crv_context *context);

/* The instruction set that the context's plans use on the CPU, and its G-buffers on any
 * device; CRV_ISA_SCALAR for NULL. */
CRV_API crv_isa crv_context_isa(const crv_context *context);

/* A device for crv_context_desc. */
typedef struct crv_device_info {
    char name[256];    /* as the driver gives it */
    char driver[256];  /* its name and version as it gives them; Vulkan's version */
    int32_t software;  /* 1: runs on the CPU (lavapipe) */
    char missing[128]; /* why Crevice cannot use it; "": it can */
} crv_device_info;

/* Describes the Vulkan device `index`, from 0 on. logger NULL: silent. Errors:
 * INVALID_ARGUMENT where info is NULL or there are not so many devices (not logged);
 * UNSUPPORTED with a line where there is no Vulkan, at build or at run time; DEVICE where
 * a driver fails; OUT_OF_MEMORY. Thread-safe. */
CRV_API crv_status crv_vulkan_device_info(int32_t index, crv_device_info *info,
                                          const crv_logger *logger);

/* One method, one filter, one set of options, one size. */
typedef struct crv_plan crv_plan;

/*
 * Checks the options, builds sample patterns and takes the memory that a run needs: 4
 * bytes for each pixel of the result, as much again for the filter, and as much again for
 * each depth layer with 0.5 to 16 MiB of tables where sampling points may move (see
 * crv_context_desc.exact); with the G-buffer's own, less than 48 bytes a pixel, 2 MiB of
 * tables apart. On a Vulkan device images and a staging buffer come on top, in its
 * memory. Options and desc are copied. *out must be destroyed before its context.
 * Errors: INVALID_ARGUMENT, OUT_OF_MEMORY; on a Vulkan device UNSUPPORTED where it cannot
 * compute this, and DEVICE where its driver fails.
 */
CRV_API crv_status crv_plan_create(crv_context *context, const crv_options *options,
                                   const crv_gbuffer_desc *desc, crv_plan **out);

/* NULL does nothing. */
CRV_API void crv_plan_destroy(crv_plan *plan);

/*
 * Gives the plan new options, as if it had been made with them, without taking memory:
 * what a slider or an animation changes. The result has the same bits as that of a new
 * plan. A new plan is needed for another method; for a filter where there was none, none
 * where there was one, or, with a guard band, one of another radius; for another
 * noise_size; and for directions, steps and samples that take more memory than at first,
 * as a larger or an odd number may; on a Vulkan device for all that
 * crv_vulkan_pass_set_options() calls fixed. Then the plan stays as it is, and the line
 * in the log names the option. Errors: INVALID_ARGUMENT; UNSUPPORTED if it takes a new
 * plan.
 */
CRV_API crv_status crv_plan_set_options(crv_plan *plan, const crv_options *options);

/*
 * Computes the accessibility of every pixel inside the guard band, filtered if the
 * options say so: 1 is open, 0 fully occluded, background is 1; always finite and in [0,
 * 1]. result: one channel, width - guard_left - guard_right by height - guard_top -
 * guard_bottom. Returns when it is done. Allocates nothing; the same input gives the same
 * bits for any number of threads. A plan may run on any G-buffer made with an equal desc
 * and the same context.
 * Errors: INVALID_ARGUMENT; NOT_READY where the G-buffer lacks its camera or a depth
 * layer; on a Vulkan device UNSUPPORTED where the G-buffer has a height field or implicit
 * surfaces that the options ask for, and DEVICE where its driver fails.
 */
CRV_API crv_status crv_plan_run(crv_plan *plan, crv_gbuffer *gbuffer,
                                const crv_image *result);

/*
 * Applies the plan's filter to an accessibility image of the result's size, such as one
 * that was computed elsewhere; copies it where the plan has no filter. Values that are
 * not finite are taken as 1. input and result may be the same image. Allocates nothing.
 * Errors: as crv_plan_run().
 */
CRV_API crv_status crv_plan_filter(crv_plan *plan, crv_gbuffer *gbuffer,
                                   const crv_const_image *input, const crv_image *result);

/* The time that a step took on the device. */
typedef struct crv_device_time {
    const char *name; /* "upload", "deinterleave", "levels", the method's or filter's
                         name, "download"; static */
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
 * Accessibility for a frame with several depth samples in each pixel, for compositing
 * before they are resolved (McGuire et al. 2011). A plan gives a pixel one value, that of
 * the one depth in its G-buffer; here every sample gathers from its pixel and the four
 * beside it, weighted by how near their depth is to the sample's own: a sample of the
 * floor at a column's edge takes the floor's accessibility. Where none is near, the
 * nearest in depth counts alone. Background samples, and samples without a surface
 * around, get 1.
 *
 * gbuffer: the frame, with camera and depth layer 0. accessibility: one channel, as
 * crv_plan_run() wrote it; values that are not finite are taken as 1. sample_depth: 2 to
 * CRV_MAX_SUBSAMPLES channels, one for each sample, of the same size, which is that
 * inside the guard band. format: what these depths are, NULL planar; radial ones are
 * taken along the pixel's centre. depth_range: depth difference at which a neighbour
 * stops counting, > 0, scene units; filter_depth times the radius of the options fits.
 * result: as many channels as sample_depth; may not share memory with accessibility, but
 * may be sample_depth itself. Allocates nothing; the same bits for any number of threads.
 * Errors: INVALID_ARGUMENT; NOT_READY where the G-buffer lacks its camera or layer 0.
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
