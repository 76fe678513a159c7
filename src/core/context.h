/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_CONTEXT_H
#define CRV_CORE_CONTEXT_H

#include "base/alloc.h"
#include "base/log.h"
#include "base/parallel.h"
#include "crevice/context.h"

typedef struct crv__backend crv__backend;

struct crv_context {
    crv_logger logger;
    crv_allocator allocator;
    crv_parallel parallel;
    crv_progress progress;
    int32_t threads;
    uint32_t isa_mask; /* never 0 */
    int32_t exact;     /* 0 or 1 */
    const crv__backend *backend;
    const struct crv__conversions *conversions; /* on the host, whatever the backend */
    crv_isa isa;                                /* of the host's kernels */
    const struct crv__kernels *kernels;         /* the host's; NULL: the specification */
    void *device;                               /* the backend's; NULL: none */
    int32_t children; /* G-buffers, plans and passes that have not been destroyed */
};

/* A context that computes on the host and is not yet anybody's: crv_context_create()
 * without the device. */
crv_status crv__context_create_bare(const crv_context_desc *desc, crv_context **out);

static inline void crv__run_parallel(const crv_context *context, uint32_t count,
                                     void (*task)(void *data, uint32_t index), void *data)
{
    crv__parallel_for(&context->parallel, context->threads, NULL, count, task, data);
}

/* The same for a step of a run. False if the host's crv_progress ended it: some tasks are
 * left out. */
static inline bool crv__run_step(const crv_context *context, uint32_t count,
                                 void (*task)(void *data, uint32_t index), void *data)
{
    return crv__parallel_for(&context->parallel, context->threads, &context->progress,
                             count, task, data);
}

/* The same for rows 0 to height - 1 of a picture, with groups of them as tasks, so that
 * fetching one costs little even where a row takes a microsecond. */
void crv__run_rows(const crv_context *context, int32_t height,
                   void (*row)(void *data, uint32_t y), void *data);

#endif
