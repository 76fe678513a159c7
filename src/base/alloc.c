/* SPDX-License-Identifier: MIT */
#if defined(__linux__)
#define _DEFAULT_SOURCE /* for madvise() */
#endif
#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>
#if defined(_WIN32)
#include <malloc.h>
#elif defined(__linux__)
#include <sys/mman.h>
#endif

#if defined(MADV_HUGEPAGE)
/* Samples of a picture lie in hundreds of its rows, each in pages of its own: with small
 * pages their addresses are looked up anew all the time. The last huge page is left out
 * where it would mostly stand empty. */
enum { HUGE_PAGE = 1 << 21 };

static void *allocate_huge(size_t size)
{
    const size_t up = (size + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
    const size_t whole = up - size <= size / 4 ? up : size / HUGE_PAGE * HUGE_PAGE;
    void *memory = aligned_alloc(HUGE_PAGE, up);
    if (memory) /* advice only: where it is not taken, pages are small */
        (void)madvise(memory, whole, MADV_HUGEPAGE);
    return memory;
}
#endif

static void *default_allocate(void *user, size_t size, size_t alignment)
{
    (void)user;
#if defined(_WIN32)
    return _aligned_malloc(size, alignment);
#else
#if defined(MADV_HUGEPAGE)
    if (size >= HUGE_PAGE && alignment <= HUGE_PAGE)
        return allocate_huge(size);
#endif
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
