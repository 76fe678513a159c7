/* SPDX-License-Identifier: MIT */
#include "memory.h"

#include <stdlib.h>

void *memory_aligned(size_t size, size_t alignment)
{
    const size_t whole = (size + alignment - 1) / alignment * alignment;
    return whole < size ? NULL : aligned_alloc(alignment, whole);
}

void memory_release(void *memory)
{
    free(memory);
}
