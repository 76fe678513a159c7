/* SPDX-License-Identifier: MIT */
/* aligned.h: aligned memory of the C library, for allocators of tests. */
#ifndef TESTS_ALIGNED_H
#define TESTS_ALIGNED_H

#include <stdlib.h>
#if defined(_WIN32)
#include <malloc.h>
#endif

/* The caller frees it with give_aligned(). */
static inline void *take_aligned(size_t alignment, size_t size)
{
#if defined(_WIN32)
    return _aligned_malloc(size, alignment);
#else
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
#endif
}

static inline void give_aligned(void *block)
{
#if defined(_WIN32)
    _aligned_free(block);
#else
    free(block);
#endif
}

#endif
