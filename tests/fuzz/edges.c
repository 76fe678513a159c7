/* SPDX-License-Identifier: MIT */
/* Edges that the import's child reaches, of which its parent would know nothing. */
#define _DEFAULT_SOURCE
#include "fuzz.h"

#include <string.h>
#include <sys/mman.h>

#include "import.h"

/* The edges that libFuzzer counts, in its programs. */
extern uint8_t __start___sancov_cntrs[] __attribute__((weak));
extern uint8_t __stop___sancov_cntrs[] __attribute__((weak));
static uint8_t *child_edges; /* in memory that both processes share */

static size_t edge_count(void)
{
    return (size_t)(__stop___sancov_cntrs - __start___sancov_cntrs);
}

void fuzz_share_edges(void)
{
    if (child_edges || !__start___sancov_cntrs)
        return;
    void *shared = mmap(NULL, edge_count(), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    FUZZ_CHECK(shared != MAP_FAILED, "no shared memory");
    child_edges = shared;
}

static void tell_edges(void)
{
    if (child_edges)
        memcpy(child_edges, __start___sancov_cntrs, edge_count());
}

void fuzz_add_edges(void)
{
    for (size_t i = 0; child_edges && i < edge_count(); i++)
        if (child_edges[i] > __start___sancov_cntrs[i])
            __start___sancov_cntrs[i] = child_edges[i];
    if (child_edges)
        memset(child_edges, 0, edge_count());
}

/* What the linker hands over (--wrap): before its result the child tells its edges, for
 * then it may be killed, or else when it ends. */
bool __real_import_pipe_send(int to, const import *found);
bool __wrap_import_pipe_send(int to, const import *found);
bool __wrap_import_pipe_send(int to, const import *found)
{
    tell_edges();
    return __real_import_pipe_send(to, found);
}

void __real__exit(int code) __attribute__((noreturn));
void __wrap__exit(int code) __attribute__((noreturn));
void __wrap__exit(int code)
{
    tell_edges();
    __real__exit(code);
}
