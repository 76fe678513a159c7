/* SPDX-License-Identifier: MIT */
#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>
#if defined(_WIN32)
#include <malloc.h>
#endif

static void *default_allocate(void *user, size_t size, size_t alignment)
{
    (void)user;
#if defined(_WIN32)
    return _aligned_malloc(size, alignment);
#else
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
#endif
}

static void default_release(void *user, void *memory, size_t size)
{
    (void)user;
    (void)size;
#if defined(_WIN32)
    _aligned_free(memory);
#else
    free(memory);
#endif
}

crv_allocator crv__default_allocator(void)
{
    return (crv_allocator){default_allocate, default_release, NULL};
}

void *crv__allocate(const crv_allocator *allocator, size_t count, size_t size)
{
    if (count == 0 || size == 0 || count > (SIZE_MAX / 2 - CRV__ALIGNMENT) / size)
        return NULL;
    void *memory = allocator->allocate(allocator->user, count * size, CRV__ALIGNMENT);
    if (memory)
        memset(memory, 0, count * size);
    return memory;
}

void crv__release(const crv_allocator *allocator, void *memory, size_t count, size_t size)
{
    if (memory)
        allocator->release(allocator->user, memory, count * size);
}
