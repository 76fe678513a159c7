/* SPDX-License-Identifier: MIT */
/*
 * pool.h: planes of pixels that many hold. The memory of a plane that nobody holds any
 * more is used for the next one: writing to pages that are new to the process takes
 * longer than all that is computed of a picture.
 */
#ifndef VIEW_POOL_H
#define VIEW_POOL_H

#include <stddef.h>

typedef struct pool pool;

/* NULL: no memory. */
pool *pool_open(void);
/* Planes that are still held stay valid. NULL does nothing. */
void pool_close(pool *p);

/* A plane with undefined contents, held once; NULL: no memory. Any thread may call these
 * three. */
void *pool_take(pool *p, size_t bytes);
/* One more holder; returns the plane. NULL is fine for both. */
void *pool_hold(void *plane);
void pool_release(void *plane);

#endif
