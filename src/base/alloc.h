/* SPDX-License-Identifier: MIT */
#ifndef CRV_BASE_ALLOC_H
#define CRV_BASE_ALLOC_H

#include "crevice/base.h"

/* Every block is aligned for the widest vector and a cache line. */
#define CRV__ALIGNMENT 64

/* The C library's allocator behind the hook's interface. */
crv_allocator crv__default_allocator(void);

/* count * size bytes, zeroed; NULL where the product overflows or memory is out. */
void *crv__allocate(const crv_allocator *allocator, size_t count, size_t size);

/* memory NULL does nothing; count and size as at crv__allocate(). */
void crv__release(const crv_allocator *allocator, void *memory, size_t count,
                  size_t size);

#endif
