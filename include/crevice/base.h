/* SPDX-License-Identifier: MIT */
/*
 * base.h: version, status codes, and the hooks through which the host keeps control:
 * where messages go, where memory comes from, who runs the parallel loops, and how far
 * long runs are.
 *
 * Structs that may grow begin with struct_size. Fill one with its _init function, which
 * takes sizeof of it, and change what differs. New members are added at the end. A
 * library takes every earlier size, with defaults for the members that are missing; so a
 * program goes on working with a newer library. It refuses a larger size with
 * INVALID_ARGUMENT: a program needs a library that is at least as new as its headers. If
 * _init fails for the size, it zeroes the struct but for struct_size, and every call that
 * takes the struct then says why.
 */
#ifndef CREVICE_BASE_H
#define CREVICE_BASE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CRV_VERSION_MAJOR 0
#define CRV_VERSION_MINOR 1
#define CRV_VERSION_PATCH 0

#if defined(CRV_STATIC)
#define CRV_API
#elif defined(_WIN32)
#if defined(CRV_BUILD)
#define CRV_API __declspec(dllexport)
#else
#define CRV_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define CRV_API __attribute__((visibility("default")))
#else
#define CRV_API
#endif

/* The version of the library that is linked, "major.minor.patch". Static storage.
 * Thread-safe. */
CRV_API const char *crv_version(void);

/* What was built into the library that is linked. Its CMake package and pkg-config define
 * CRV_HAS_VULKAN as 1 or 0 for the compiler. */
typedef enum crv_feature {
    CRV_FEATURE_VULKAN = 1, /* Vulkan devices, and the functions of vulkan.h */
    CRV_FEATURE_OPENMP = 2  /* OpenMP runs parallel loops */
} crv_feature;

/* The features, a bit crv_feature each. Thread-safe. */
CRV_API uint32_t crv_features(void);

/* The structs that a binding to another language allocates without the headers. */
typedef enum crv_struct {
    CRV_STRUCT_CAMERA = 0,
    CRV_STRUCT_CONST_IMAGE = 1,
    CRV_STRUCT_CONTEXT_DESC = 2,
    CRV_STRUCT_DEPTH_FORMAT = 3,
    CRV_STRUCT_GBUFFER_DESC = 4,
    CRV_STRUCT_IMAGE = 5,
    CRV_STRUCT_OPTIONS = 6,
    CRV_STRUCT_RESULT = 7
} crv_struct;

/* sizeof of the struct in the library that is linked: what its _init takes. 0 for another
 * number. Thread-safe. */
CRV_API size_t crv_struct_size(crv_struct which);

/* Result of a call. Every function that can fail returns one of these; outputs are
 * untouched unless it is CRV_OK. */
typedef enum crv_status {
    CRV_OK = 0,
    CRV_ERROR_INVALID_ARGUMENT =
        1, /* NULL, a size, a range, a NaN, a stride: the log says which */
    CRV_ERROR_OUT_OF_MEMORY =
        2, /* the allocator returned NULL, or a size does not fit size_t */
    CRV_ERROR_UNSUPPORTED = 3, /* valid, but not by this build, method or device */
    /* called too early: the G-buffer has no camera or no depth, nothing was timed yet */
    CRV_ERROR_NOT_READY = 4,
    CRV_ERROR_DEVICE = 5, /* the device was lost, or a call to its driver failed */
    CRV_ERROR_STOPPED = 6 /* the host's crv_progress ended the run; not logged */
} crv_status;

/* A short English name of a status ("out of memory"). Static storage; never NULL, also
 * for values that are not a crv_status. Thread-safe. */
CRV_API const char *crv_status_string(crv_status status);

typedef enum crv_log_level {
    CRV_LOG_ERROR = 0,   /* a call failed; the line says why and what to do */
    CRV_LOG_WARNING = 1, /* a call did its work but ignored or changed something */
    CRV_LOG_INFO = 2
} crv_log_level;

/* Where messages go. A logger whose fn is NULL is silent, and so is a logger that is NULL
 * itself. */
typedef struct crv_logger {
    /* Receives one line without a newline. `line` is valid during the call only. Called
     * on the thread that called into Crevice. */
    void (*fn)(void *user, crv_log_level level, const char *line);
    void *user; /* handed to fn; not owned */
} crv_logger;

/* Where memory comes from. Both functions or neither (then malloc's aligned cousin is
 * used, and on Linux huge pages are asked for if a block has 2 MiB or more). Called
 * only inside create, set and destroy functions, never inside crv_plan_run(). */
typedef struct crv_allocator {
    /* Returns `size` bytes (> 0) aligned to `alignment` (a power of two), or NULL. */
    void *(*allocate)(void *user, size_t size, size_t alignment);
    /* Takes back what allocate returned, with the same size. Never called with NULL. */
    void (*release)(void *user, void *memory, size_t size);
    void *user; /* handed to both; not owned */
} crv_allocator;

/* Who runs parallel loops. If run is NULL, OpenMP does, or, in a library that was built
 * without it, the library's own threads (WebAssembly: the calling thread). */
typedef struct crv_parallel {
    /* Calls task(data, i) once for every i in [0, count), on any threads in any order,
     * and returns when all are done. Results do not depend on the order. */
    void (*run)(void *user, uint32_t count, void (*task)(void *data, uint32_t index),
                void *data);
    void *user; /* handed to run; not owned */
} crv_parallel;

/* How far a run is, and whether it goes on. */
typedef struct crv_progress {
    /* Called on the thread that runs the plan, between pieces of the run. On the CPU a
     * piece is a tile of 4000 px or less; not called if a crv_parallel runs the loops: it
     * sees the pieces itself. On a Vulkan device a piece is a submission to its queue.
     * `done` of `total` pieces of a step are done, done < total. A run on the CPU has up
     * to three steps: width map, method, filter. On Vulkan it is one. Return 0 to go on.
     * All else ends the run with CRV_ERROR_STOPPED and the result untouched; the plan may
     * run again. */
    int32_t (*fn)(void *user, int32_t done, int32_t total);
    void *user; /* handed to fn; not owned */
} crv_progress;

#ifdef __cplusplus
}
#endif
#endif
