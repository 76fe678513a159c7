/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_CONTEXT_H
#define CRV_CORE_CONTEXT_H

#include "base/alloc.h"
#include "base/log.h"
#include "base/parallel.h"
#include "crevice/context.h"

struct crv_context {
    crv_logger logger;
    crv_allocator allocator;
    crv_parallel parallel;
    int32_t threads;
};

static inline void crv__run_parallel(const crv_context *context, uint32_t count,
                                     void (*task)(void *data, uint32_t index), void *data)
{
    crv__parallel_for(&context->parallel, context->threads, count, task, data);
}

#endif
