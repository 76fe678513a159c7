/* SPDX-License-Identifier: MIT */
#include "pool.h"

#include <stdbool.h>
#include <stdlib.h>

#include "system/monitor.h"

/* As many as are in flight: three planes of both halves on the screen, made and being
 * made. */
enum { KEPT_MAX = 18 };

typedef struct block {
    pool *pool;
    struct block *next; /* while nobody holds it */
    size_t bytes;
    int holders;
} block;

/* Before each plane; a plane begins on a cache line's 64 bytes if malloc's do. */
typedef union header {
    block block;
    char room[64];
} header;

struct pool {
    monitor *monitor;
    block *kept; /* of `bytes` each */
    int kept_count;
    size_t bytes;
    int held; /* planes */
    bool is_closed;
};

static block *block_of(void *plane)
{
    return &((header *)plane - 1)->block;
}

static void drop_kept(pool *p)
{
    while (p->kept) {
        block *b = p->kept;
        p->kept = b->next;
        free(b);
    }
    p->kept_count = 0;
}

pool *pool_open(void)
{
    pool *p = calloc(1, sizeof *p);
    if (p)
        p->monitor = monitor_create();
    if (p && p->monitor)
        return p;
    free(p);
    return NULL;
}

/* With the lock held, which is gone afterwards. */
static void unlock(pool *p)
{
    const bool last = p->is_closed && p->held == 0;
    if (p->is_closed)
        drop_kept(p);
    monitor_leave(p->monitor);
    if (!last)
        return;
    monitor_free(p->monitor);
    free(p);
}

void pool_close(pool *p)
{
    if (!p)
        return;
    monitor_enter(p->monitor);
    p->is_closed = true;
    unlock(p);
}

void *pool_take(pool *p, size_t bytes)
{
    monitor_enter(p->monitor);
    if (bytes != p->bytes) {
        drop_kept(p);
        p->bytes = bytes;
    }
    block *b = p->kept;
    if (b) {
        p->kept = b->next;
        p->kept_count--;
    } else {
        b = malloc(sizeof(header) + bytes);
    }
    if (b) {
        *b = (block){.pool = p, .bytes = bytes, .holders = 1};
        p->held++;
    }
    monitor_leave(p->monitor);
    return b ? (header *)(void *)b + 1 : NULL;
}

void *pool_hold(void *plane)
{
    if (!plane)
        return NULL;
    block *b = block_of(plane);
    monitor_enter(b->pool->monitor);
    b->holders++;
    monitor_leave(b->pool->monitor);
    return plane;
}

void pool_release(void *plane)
{
    if (!plane)
        return;
    block *b = block_of(plane);
    pool *p = b->pool;
    monitor_enter(p->monitor);
    if (--b->holders == 0) {
        p->held--;
        if (b->bytes == p->bytes && p->kept_count < KEPT_MAX && !p->is_closed) {
            b->next = p->kept;
            p->kept = b;
            p->kept_count++;
        } else {
            free(b);
        }
    }
    unlock(p);
}
