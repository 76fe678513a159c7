/* SPDX-License-Identifier: MIT */
#include "core/backend.h"
#include "core/conversions.h"

#include "base/structs.h"

enum { MAX_THREADS = 1024 };

static const crv__struct DESC = {.name = "context desc",
                                 .init = "crv_context_desc_init()",
                                 .first = CRV__SIZE_TO(crv_context_desc, logger),
                                 .size = sizeof(crv_context_desc)};

crv_status crv_context_desc_init(crv_context_desc *desc, size_t struct_size)
{
    const crv_context_desc defaults = {.struct_size = 0};
    return crv__struct_init(&DESC, desc, struct_size, &defaults);
}

/* Where the line goes if the description itself is in doubt: its logger, if it has one
 * that can be trusted. */
static crv_status take_desc(const crv_context_desc *from, crv_context_desc *desc)
{
    *desc = (crv_context_desc){.struct_size = sizeof *desc};
    if (!from)
        return CRV_OK;
    const crv_logger *logger = from->struct_size >= DESC.first ? &from->logger : NULL;
    return crv__struct_take(&DESC, logger, from, desc);
}

enum { ROWS_A_TASK = 8 };

typedef struct rows_job {
    int32_t height;
    void (*row)(void *data, uint32_t y);
    void *data;
} rows_job;

static void run_row_group(void *data, uint32_t index)
{
    const rows_job *job = data;
    const int32_t first = (int32_t)index * ROWS_A_TASK;
    const int32_t end =
        job->height - first < ROWS_A_TASK ? job->height : first + ROWS_A_TASK;
    for (int32_t y = first; y < end; y++)
        job->row(job->data, (uint32_t)y);
}

void crv__run_rows(const crv_context *context, int32_t height,
                   void (*row)(void *data, uint32_t y), void *data)
{
    rows_job job = {height, row, data};
    crv__run_parallel(context, (uint32_t)((height - 1) / ROWS_A_TASK + 1), run_row_group,
                      &job);
}

crv_status crv__context_create_bare(const crv_context_desc *desc, crv_context **out)
{
    crv_context_desc full;
    crv_status status = take_desc(desc, &full);
    if (status)
        return status;
    desc = &full;
    const crv_logger *logger = &desc->logger;
    if (!out)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT, "context: out is NULL");
    if (!desc->allocator.allocate != !desc->allocator.release)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "context: the allocator needs both functions or neither");
    if (desc->threads < 0 || desc->threads > MAX_THREADS)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "context: %d threads; use 1 to %d, or 0 for a sensible number",
                         desc->threads, MAX_THREADS);
    if (desc->exact != 0 && desc->exact != 1)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "context: exact is %d; use 0 or 1", desc->exact);
    crv_allocator allocator =
        desc->allocator.allocate ? desc->allocator : crv__default_allocator();
    crv_context *context = crv__allocate(&allocator, 1, sizeof *context);
    if (!context)
        return crv__fail(logger, CRV_ERROR_OUT_OF_MEMORY, "context: out of memory");
    *context = (crv_context){.logger = desc->logger,
                             .allocator = allocator,
                             .parallel = desc->parallel,
                             .progress = desc->progress,
                             .threads = desc->threads,
                             .isa_mask = desc->isa_mask ? desc->isa_mask : UINT32_MAX,
                             .exact = desc->exact,
                             .backend = crv__backends[0],
                             .conversions = &crv__conversions_specified};
    status = context->backend->open(context, 0);
    if (status)
        crv_context_destroy(context);
    else
        *out = context;
    return status;
}

/* The backend of a device; NULL: there is none. */
static const crv__backend *backend_of(crv_device device)
{
    const crv__backend *const *backend = crv__backends;
    while (*backend && (*backend)->device != device)
        backend++;
    return *backend;
}

crv_status crv_context_create(const crv_context_desc *desc, crv_context **out)
{
    crv_context *context = NULL;
    crv_status status = crv__context_create_bare(desc, out ? &context : NULL);
    if (status)
        return status;
    crv_context_desc full;
    take_desc(desc, &full);
    const crv__backend *backend = backend_of(full.device);
    if (!backend)
        status =
            crv__fail(&full.logger, CRV_ERROR_INVALID_ARGUMENT,
                      "context: device %d is neither CPU nor Vulkan", (int)full.device);
    else if (backend != context->backend)
        status = backend->open(context, full.device_index);
    if (status)
        crv_context_destroy(context);
    else
        *out = context;
    return status;
}

void crv_context_destroy(crv_context *context)
{
    if (!context)
        return;
    if (context->children > 0) {
        crv__log(&context->logger, CRV_LOG_ERROR,
                 "context: not destroyed, since %d of its G-buffers, plans and passes "
                 "are still in use; destroy them first",
                 context->children);
        return;
    }
    if (context->backend->close)
        context->backend->close(context);
    crv_allocator allocator = context->allocator;
    crv__release(&allocator, context, 1, sizeof *context);
}
