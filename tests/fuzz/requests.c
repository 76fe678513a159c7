/* SPDX-License-Identifier: MIT */
/* Largest requests for memory, of the code that the linker hands to these (--wrap). */
#include "fuzz.h"

static size_t largest;

size_t fuzz_largest_request(void)
{
    return largest;
}

void fuzz_forget_requests(void)
{
    largest = 0;
}

static void note(size_t count, size_t size)
{
    const size_t bytes = size && count > SIZE_MAX / size ? SIZE_MAX : count * size;
    if (bytes > largest)
        largest = bytes;
}

void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size)
{
    note(1, size);
    return __real_malloc(size);
}

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size)
{
    note(count, size);
    return __real_calloc(count, size);
}

void *__real_realloc(void *memory, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_realloc(void *memory, size_t size)
{
    note(1, size);
    return __real_realloc(memory, size);
}
