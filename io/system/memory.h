/* SPDX-License-Identifier: MIT */
/* memory.h: memory that begins at a multiple of `alignment`, a power of two. */
#ifndef CREVICE_SYSTEM_MEMORY_H
#define CREVICE_SYSTEM_MEMORY_H

#include <stddef.h>

/* NULL: there is none. Release it with memory_release(), which takes NULL, too. */
void *memory_aligned(size_t size, size_t alignment);
void memory_release(void *memory);

#endif
